//! Journals of a group, as programs read them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use command_line::program::{command, failed};
use messages::Service;
use service::exit::{Exit, Failure};
use service::journal_record::JournalLine;

/// End of the name of a journal.
const JOURNAL: &str = "journal";
/// Folder of kept settings next to the journals.
const SETTINGS: &str = "settings";

/// The journals of a folder, or the one that is named.
pub(super) fn of(source: &Path) -> Vec<(Service, PathBuf)> {
    let of = |service: Service| {
        let file = match source.is_dir() {
            true => source.join(format!("{}.{JOURNAL}", service.name())),
            false => source.to_owned(),
        };
        let is_own = file.file_stem().is_some_and(|stem| stem == service.name());
        let is_journal = file.extension().is_some_and(|it| it == JOURNAL) && file.is_file();
        (is_own && is_journal).then_some((service, file))
    };
    Service::JOURNALED.into_iter().filter_map(of).collect()
}

/// The records of a journal, as its service reads them.
pub(super) fn lines(service: Service, file: &Path) -> Result<Vec<JournalLine>, Failure> {
    let mut program: Command = command(service.name(), "journal");
    program.arg(file).arg("--json").stderr(Stdio::inherit());
    let settings = file.with_file_name(SETTINGS);
    for folder in fs::read_dir(settings).into_iter().flatten().flatten() {
        program.arg("--settings").arg(folder.path());
    }
    let output = program.output().map_err(|error| failed(&program, &error))?;
    let lines = String::from_utf8_lossy(&output.stdout);
    let lines = lines.lines().map(serde_json::from_str::<JournalLine>);
    let lines: Vec<JournalLine> = lines.collect::<Result<_, _>>().map_err(|error| {
        let what = format!("{}: unexpected output of {}: {error}", file.display(), service.name());
        Failure::new(Exit::Invariant, what)
    })?;
    if !output.status.success() && lines.is_empty() {
        return Err(Failure::new(Exit::of_process(output.status.code()), String::new()));
    }
    Ok(lines)
}
