//! `journal`: the records of a service, listed or verified by the service's own program.

use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::{paths as locations, service_program};
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
    let mut command = service_program::command(&args.service, "journal");
    command.arg(&file).args(out.is_json().then_some("--json"));
    // A listing does without settings, with fewer words.
    let settings = match locations::settings_in_force(paths, &args.config) {
        Err(error) if args.verify => return Err(error),
        settings => settings.ok(),
    };
    let settings = settings.map(|it| service_program::Settings::write(&it)).transpose()?;
    command.args(args.verify.then_some("--verify"));
    if let Some(settings) = &settings {
        command.arg("--settings").arg(settings.folder());
    }
    let status = command.status().map_err(|error| service_program::failed(&command, &error))?;
    Ok(Exit::of_process(status.code()))
}
