//! Inspection of a journal or the machine by the services' own programs: `journal`, and a part of
//! `doctor`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use command_line::Outcome;
use command_line::output::Output;
use command_line::program::failed;
use messages::Service;
use safe_files::TemporaryFolder;
use serde_json::json;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::inspection::Verdict;
use service::journal_set::{self, JournalSet};
use service::{kept_settings, launch};

use crate::cli::{JournalAction, JournalArgs};

/// Lists, verifies or sets aside journals.
pub(super) fn journal(paths: &GroupPaths, args: &JournalArgs, out: &mut Output<'_>) -> Outcome {
    match (&args.action, &args.service) {
        (Some(JournalAction::SetAside { services }), _) => set_aside(paths, services, out),
        (None, None) if args.verify => verify_all(paths, out),
        (None, service) => {
            let service = service.unwrap_or(Service::Policy);
            let file = paths.journal_file(service.name());
            if !file.is_file() {
                let what = format!("group {} has no journal of {}", paths.name(), service.name());
                let help = "help: start the group with `whichone up`";
                return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
            }
            let mut command = journal_command(paths, service);
            command.args(args.verify.then_some("--verify"));
            command.args(out.is_json().then_some("--json"));
            if let Some(since) = args.since {
                command.args(["--since", &since.to_string()]);
            }
            let status = command.status().map_err(|error| failed(&command, &error))?;
            Ok(Exit::of_process(status.code()))
        }
    }
}

fn set_aside(paths: &GroupPaths, services: &[Service], out: &mut Output<'_>) -> Outcome {
    let folder = journal_set::set_aside(paths, services)?;
    if out.is_json() {
        out.json(&json!({ "folder": folder }))?;
        return Ok(Exit::Ok);
    }
    match folder {
        Some(folder) => out.line(format_args!("moved to {}", folder.display()))?,
        None => out.line("there was no file to move")?,
    }
    out.line("at the next start what was in progress ends, and nothing said before counts again")?;
    if services.contains(&Service::Arm) {
        out.line(
            "the arm starts with its motion stop latched: look, then `whichone resume-motion`",
        )?;
    }
    Ok(Exit::Ok)
}

/// Verifies every journal, and that they agree with one another.
fn verify_all(paths: &GroupPaths, out: &mut Output<'_>) -> Outcome {
    let unreadable = |error: std::io::Error| Failure::new(Exit::Storage, error.to_string());
    let Some(set) = JournalSet::load(paths).map_err(unreadable)? else {
        let what = format!("group {} has no journals yet", paths.name());
        return Err(Failure::new(Exit::NotReached, format!("{what}; help: `whichone up`")));
    };
    let unusable = set.check(paths);
    if let Some(first) = unusable.first() {
        let lines: Vec<_> = unusable.iter().map(ToString::to_string).collect();
        return Err(Failure::new(first.exit(), lines.join("\n")));
    }
    let mut verdicts = BTreeMap::new();
    // A running group writes on: a receiver's journal is read before its sender's.
    for service in [Service::Arm, Service::Policy, Service::Speech] {
        if !paths.journal_file(service.name()).is_file() {
            continue;
        }
        match verify(paths, service)? {
            Ok(verdict) => verdicts.insert(service.name(), verdict),
            Err(exit) => return Ok(exit),
        };
    }
    let facts =
        |service: Service| verdicts.get(service.name()).and_then(|it: &Verdict| it.shared.clone());
    let shared = Service::JOURNALED.map(|service| facts(service).unwrap_or_default());
    let together = journal_set::agree(&set, shared)?;
    for service in Service::JOURNALED {
        let Some(Verdict { records, facts, .. }) = verdicts.get(service.name()) else { continue };
        let (records, facts) = (records.unwrap_or(0), facts.clone().unwrap_or_default());
        if out.is_json() {
            let service = service.name();
            out.json(
                &json!({ "service": service, "ok": true, "records": records, "facts": facts }),
            )?;
            continue;
        }
        out.line(format_args!("{}: {} verified", service.name(), scene::count(records, "record")))?;
        facts.iter().try_for_each(|fact| out.line(format_args!("  {fact}")))?;
    }
    match out.is_json() {
        true => out.json(&json!({ "together": together, "ok": true }))?,
        false => out.line(format_args!("together: {together}"))?,
    }
    Ok(Exit::Ok)
}

/// Has a service's program verify its journal; its own words on standard error where it is broken.
fn verify(paths: &GroupPaths, service: Service) -> Result<Result<Verdict, Exit>, Failure> {
    let mut command = journal_command(paths, service);
    command.args(["--verify", "--json"]).stderr(Stdio::inherit());
    let output = command.output().map_err(|error| failed(&command, &error))?;
    let verdict = serde_json::from_slice::<Verdict>(&output.stdout).ok();
    Ok(verdict.filter(|it| it.ok).ok_or(Exit::of_process(output.status.code())))
}

/// The command line of a service's program for its journal, with the settings in force and those of
/// earlier runs.
fn journal_command(paths: &GroupPaths, service: Service) -> Command {
    let configured = configured(paths, service).unwrap_or_default();
    let (mut command, arguments) = match configured.split_first() {
        Some((program, arguments)) => (launch::command(found(program)), arguments),
        None => (launch::command(launch::program_of(service.name())), &[][..]),
    };
    command.arg("journal").arg(paths.journal_file(service.name()));
    let running = Some(paths.run()).filter(|run| run.join(config::SNAPSHOT_FILE).is_file());
    for folder in running.into_iter().chain(kept_settings::folders(paths)) {
        command.arg("--settings").arg(folder);
    }
    if !arguments.is_empty() {
        command.arg("--").args(arguments);
    }
    command
}

/// The path of a program: one of this installation goes by its name.
fn found(program: &str) -> PathBuf {
    program.strip_prefix(launch::PREFIX).map_or_else(|| program.into(), launch::program_of)
}

/// Returns the command that the group has configured in the place of the shipped program: only it knows, say, its own
/// planner.
fn configured(paths: &GroupPaths, service: Service) -> Option<Vec<String>> {
    let folders = std::iter::once(paths.run()).chain(kept_settings::folders(paths));
    let mut settings = folders.map(|folder| config::Settings::load_snapshot(&folder));
    let settings = settings.find_map(Result::ok)?;
    let mut services = settings.group.services.into_iter();
    services.find(|it| it.name == service.name())?.command
}

/// Writes a snapshot of settings into a temporary folder.
pub(super) fn snapshot(settings: &config::Settings) -> Result<TemporaryFolder, Failure> {
    let written = TemporaryFolder::new()
        .and_then(|folder| settings.write_snapshot(folder.path()).map(|()| folder));
    written.map_err(|error| {
        Failure::new(Exit::Storage, format!("temporary folder for the settings: {error}"))
    })
}
