//! The services' own programs, run to inspect a journal or the machine.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use service::exit::{Exit, Failure};
use service::launch;

/// A snapshot of settings in a temporary folder.
#[derive(Debug)]
pub(super) struct Settings(PathBuf);

impl Settings {
    /// Writes the snapshot.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn write(settings: &config::Settings) -> Result<Self, Failure> {
        let folder = env::temp_dir().join(format!("whichone-settings-{}", std::process::id()));
        let written = fs::create_dir_all(&folder).and_then(|()| settings.write_snapshot(&folder));
        written.map_err(|error| Failure::file(&folder, &error))?;
        Ok(Self(folder))
    }

    /// The folder that holds the snapshot.
    pub(super) fn folder(&self) -> &Path {
        &self.0
    }
}

impl Drop for Settings {
    fn drop(&mut self) {
        // A leftover in the folder for temporary files does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The command line of a service's program with an inspection verb.
pub(super) fn command(service: &str, verb: &str) -> Command {
    let mut command = Command::new(launch::program_of(service));
    command.arg(verb);
    command
}

/// The error of a program that could not be run.
pub(super) fn failed(command: &Command, error: &io::Error) -> Failure {
    let program = Path::new(command.get_program()).display();
    Failure::new(Exit::NotReached, format!("cannot run {program}: {error}"))
}
