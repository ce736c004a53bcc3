//! The list of optional parts: a line for each.
//!
//! Programs that load configurations call [`register`] before. Everything else about a part is in its crate.

#[cfg(test)]
mod tests;

use std::process::ExitCode;

/// The program of a part, or the feature that a build needs for it.
pub type Program = Result<fn() -> ExitCode, &'static str>;

macro_rules! parts {
    (programs: $($program:ident)*; others: $($other:ident)*) => {
        static PARTS: &[&config::Part] = &[$(&$other::PART,)* $(&$program::PART,)*];
        static PROGRAMS: &[(&str, Program)] = &[$((stringify!($program), $program::PROGRAM),)*];
    };
}

use ros2::trajectory;

parts! {
    programs:
        ros2
        trajectory
        link
        recorder
        baxter
        ros1;
    others:
        user_study
        model_reader
}

/// Makes the parts, and the drivers of arms, known to every configuration that this program loads.
pub fn register() {
    config::register(PARTS, drivers::known());
}

/// Optional features that are compiled in, of these parts.
pub fn features() -> Vec<&'static str> {
    let has = |name: &str| matches!(program(name), Some(Ok(_)));
    let all = [("dds", has("ros2")), ("zenoh", has("link")), ("tls", model_reader::TLS)];
    all.into_iter().filter(|(_, is_in)| *is_in).map(|(name, _)| name).collect()
}

/// The error for a program that this build is without.
pub fn how_to_get(part: &str, feature: &str) -> String {
    format!(
        "whichone-{part}: no such program, and this `whichone` was built without it; \
         help: `cargo build --release --features {feature}` in a checkout, or \
         `cargo install --path services/whichone --features {feature}`"
    )
}

/// The program of the part with this name.
pub fn program(name: &str) -> Option<Program> {
    PROGRAMS.iter().find(|(part, _)| *part == name).map(|(_, program)| *program)
}
