//! The other programs of the group, which run in here where they have no file of their own: one file is a whole group.
//! Only the gateway is a program of its own, and the link where `whichone` is built without it.

use std::ffi::CString;
use std::path::Path;
use std::process::ExitCode;

use command_line::output::print_error;
use messages::{SUPERVISOR, Service};
use service::exit::{Exit, Failure};
use service::launch::PREFIX;

/// A program of the group.
type Program = fn() -> ExitCode;

/// Runs the program under whose name this one was started; `None` if that is its own.
pub(crate) fn run() -> Option<ExitCode> {
    let started_as = std::env::args_os().next()?;
    let started_as = Path::new(&started_as).file_name()?.to_str()?.to_owned();
    let name = started_as.strip_prefix(PREFIX)?;
    let program = match program(name)? {
        Ok(program) => program,
        Err(feature) => {
            print_error(&Failure::new(Exit::Config, parts::how_to_get(name, feature)));
            return Some(Exit::Config.code());
        }
    };
    if let Ok(name) = CString::new(started_as) {
        // As lists of processes show it; the name of the file without.
        let _ = rustix::thread::set_name(&name);
    }
    Some(program())
}

/// Optional features that are compiled in, by the names that `cargo install --features` takes.
pub(crate) fn features() -> Vec<&'static str> {
    let whisper = speech::WHISPER.then_some("whisper");
    parts::features().into_iter().chain(whisper).collect()
}

/// The program with this name, or the feature that a build needs for it; `None` if there is none.
fn program(name: &str) -> Option<Result<Program, &'static str>> {
    parts::program(name).or_else(|| core_program(name).map(Ok))
}

fn core_program(name: &str) -> Option<Program> {
    if name == SUPERVISOR {
        return Some(supervisor::cli::run);
    }
    match Service::from_name(name)? {
        Service::Speech => Some(speech::run),
        Service::Grounding => Some(grounding::run),
        Service::Policy => Some(policy::run),
        Service::Arm => Some(arm::run::<drivers::Shipped>),
        Service::Console => Some(console::run),
        // Optional parts.
        Service::Robot | Service::Recorder | Service::Other(_) => None,
    }
}
