//! The other programs of the group, which run in here where they have no file of their own. An installed
//! `whichone` is so a whole group; in a build folder each service has its program.

use std::ffi::CString;
use std::path::Path;
use std::process::ExitCode;

use command_line::output::print_error;
use messages::{SUPERVISOR, Service};
use service::exit::{Exit, Failure};
use service::launch::PREFIX;

/// A program of the group.
type Program = fn() -> ExitCode;

/// The bridge to ROS 1, a program for the service of the robot.
const ROS1: &str = "ros1";

/// Runs the program under whose name this one was started; `None` if that is its own.
pub(crate) fn run() -> Option<ExitCode> {
    let started_as = std::env::args_os().next()?;
    let started_as = Path::new(&started_as).file_name()?.to_str()?.to_owned();
    let name = started_as.strip_prefix(PREFIX)?;
    if Service::from_name(name).is_none() && ![SUPERVISOR, ROS1].contains(&name) {
        return None;
    }
    let Some(program) = program(name) else {
        print_error(&absent(name));
        return Some(Exit::Config.code());
    };
    if let Ok(name) = CString::new(started_as) {
        // As lists of processes show it; the name of the file without.
        let _ = rustix::thread::set_name(&name);
    }
    Some(program())
}

fn program(name: &str) -> Option<Program> {
    Some(match name {
        SUPERVISOR => supervisor::cli::run,
        ROS1 => ros1::run,
        _ => match Service::from_name(name)? {
            Service::Speech => speech::run,
            Service::Grounding => grounding::run,
            Service::Policy => policy::run,
            Service::Arm => arm::run,
            Service::Console => console::run,
            Service::Recorder => recorder::run,
            Service::Robot => baxter::run,
            #[cfg(feature = "dds")]
            Service::Ros2 => ros2::node::run,
            #[cfg(feature = "zenoh")]
            Service::Link => link::cli::run,
            #[cfg(not(all(feature = "dds", feature = "zenoh")))]
            _ => return None,
        },
    })
}

/// An optional program is absent.
fn absent(name: &str) -> Failure {
    let feature = if name == Service::Ros2.name() { "dds" } else { "zenoh" };
    let what = format!("{PREFIX}{name}: no such program, and this `whichone` was built without it");
    let help = format!(
        "`cargo build --release -p {name} --features {name}/{feature}` in a checkout, or \
         `cargo install --path services/whichone --features {feature}`"
    );
    Failure::new(Exit::Config, format!("{what}; help: {help}"))
}
