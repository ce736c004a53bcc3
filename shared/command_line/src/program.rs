//! Runs of a service's program by a verb, for information that only the service has.

use std::io;
use std::path::Path;
use std::process::Command;

use service::exit::{Exit, Failure};
use service::launch;

/// The command line of a service's program with an inspection verb.
pub fn command(service: &str, verb: &str) -> Command {
    let mut command = launch::command(launch::program_of(service));
    command.arg(verb);
    command
}

/// The error of a program that could not be run.
pub fn failed(command: &Command, error: &io::Error) -> Failure {
    let program = Path::new(command.get_program()).display();
    Failure::new(Exit::NotReached, format!("cannot run {program}: {error}"))
}
