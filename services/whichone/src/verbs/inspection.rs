//! Inspection of a journal or the machine by the services' own programs: `journal`, and a part of
//! `doctor`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::launch;

use super::paths as locations;
use crate::Outcome;
use crate::cli::JournalArgs;
use crate::output::Output;

/// Prints a service's records, or verifies them.
pub(super) fn journal(paths: &GroupPaths, args: &JournalArgs, out: &mut Output<'_>) -> Outcome {
    let file = paths.journal_file(&args.service);
    if !file.is_file() {
        let what = format!("group {} has no journal of {} yet", paths.name(), args.service);
        let help = "help: start the group with `whichone up`";
        return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
    }
    let mut command = command(&args.service, "journal");
    command.arg(&file).args(out.is_json().then_some("--json"));
    // A listing does without settings, with fewer words.
    let settings = match locations::settings_in_force(paths, &args.config) {
        Err(error) if args.verify => return Err(error),
        settings => settings.ok(),
    };
    let settings = settings.map(|it| Settings::write(&it)).transpose()?;
    command.args(args.verify.then_some("--verify"));
    if let Some(settings) = &settings {
        command.arg("--settings").arg(settings.folder());
    }
    let status = command.status().map_err(|error| failed(&command, &error))?;
    Ok(Exit::of_process(status.code()))
}

/// A snapshot of settings in a temporary folder.
#[derive(Debug)]
pub(super) struct Settings(PathBuf);

impl Settings {
    /// Writes the snapshot.
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
