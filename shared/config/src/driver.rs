//! Drivers of the arm by name, as far as a configuration is checked by them.

use std::sync::OnceLock;

use diagnostics::Fields;

use crate::part::Registered;

/// A driver of the arm. Only the programs that move an arm know its functions.
#[derive(Debug)]
pub struct Driver {
    /// Name of the driver in `arm.driver`.
    pub name: &'static str,
    /// Whether the driver moves a robot in real time.
    pub in_real_time: bool,
    /// The feature of `whichone` that this build lacks for it, if it lacks one.
    pub needs: Option<&'static str>,
    /// Sections of the driver's configuration.
    pub sections: &'static [Registered],
}

/// The driver of the arm's own model, which every arm has.
pub static KINEMATIC: Driver =
    Driver { name: "kinematic", in_real_time: false, needs: None, sections: &[] };

impl Driver {
    /// The reason why the driver cannot be used at this time scale, with help; `None` if it can.
    pub fn pace_problem(&self, time_scale: f64) -> Option<(String, &'static str)> {
        let what = format!("is {time_scale}, but a robot moves in real time");
        let help = "write `time_scale = 1.0`, or use driver = \"kinematic\"";
        (self.in_real_time && time_scale != 1.0).then_some((what, help))
    }
}

static DRIVERS: OnceLock<Vec<&'static Driver>> = OnceLock::new();

/// Names the drivers, besides the built-in one, that configurations may choose.
pub(crate) fn register(drivers: impl IntoIterator<Item = &'static Driver>) {
    DRIVERS.get_or_init(|| std::iter::once(&KINEMATIC).chain(drivers).collect());
}

/// The sections of the registered drivers.
pub(crate) fn sections() -> impl Iterator<Item = &'static Registered> {
    DRIVERS.get().into_iter().flatten().flat_map(|driver| driver.sections)
}

/// Reads `driver`, and returns it with its name if it is a registered one. Any name is right in a
/// program that has registered none, which reads checked snapshots, and for an arm with a program
/// of its own (`is_own`), which may have drivers of its own, with tables of their own.
pub(crate) fn read(f: &mut Fields<'_>, is_own: bool) -> (String, Option<&'static Driver>) {
    let known = DRIVERS.get().map_or(&[][..], Vec::as_slice);
    let names: Vec<&str> = known.iter().map(|driver| driver.name).collect();
    let name = f.text("driver");
    f.note_choices("driver", names.iter().copied());
    let found = known.iter().copied().find(|driver| driver.name == name);
    match found {
        _ if f.is_wrong("driver") => {}
        Some(Driver { needs: Some(feature), .. }) if !is_own => {
            let what = format!("this build has no driver `{name}`");
            let help = format!(
                "`cargo install --path services/whichone --features {feature}` in a checkout"
            );
            f.problem("driver", what, help);
        }
        None if is_own => {
            let own: Vec<&str> = f.names().into_iter().filter(|key| *key == name).collect();
            f.allow(&own);
        }
        None if !known.is_empty() => f.not_one_of("driver", &name, &names),
        _ => {}
    }
    (name, found)
}
