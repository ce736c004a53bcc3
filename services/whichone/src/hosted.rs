//! The other programs of the group, which run in here unless they have a newer file of their own: an installed
//! `whichone` is a whole group.

use std::ffi::CString;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Command, ExitCode};

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
    let program = match program(name) {
        Some(Ok(program)) => program,
        other => {
            let missing = || Some(parts::how_to_get(name, other?.err()?));
            let error = become_file(&started_as).or_else(missing)?;
            print_error(&Failure::new(Exit::Config, error));
            return Some(Exit::Config.code());
        }
    };
    if let Ok(name) = CString::new(started_as) {
        // As lists of processes show it; the name of the file without.
        let _ = rustix::thread::set_name(&name);
    }
    Some(program())
}

/// Becomes the program that this build is without, if it has a file. Returns only if that fails, with the error.
fn become_file(program: &str) -> Option<String> {
    let own = std::env::current_exe().ok()?;
    let file = own.with_file_name(program).canonicalize().ok()?;
    // A link to this file, as packages have them, would start it for ever.
    let start = || Command::new(&file).args(std::env::args_os().skip(1)).exec();
    let error = (file != own).then(start)?;
    Some(format!("{}: {error}", file.display()))
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
