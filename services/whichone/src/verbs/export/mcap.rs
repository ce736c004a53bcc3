//! `export mcap`: recordings or journals as one MCAP file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::UNIX_EPOCH;

use messages::Service;
use recording::journals::{self, Entry};
use recording::list::entries;
use recording::recover::merge;
use serde_json::json;
use service::exit::{Exit, Failure};
use service::journal_record::JournalLine;

use super::super::inspection::{command, failed};
use super::super::record::failure;
use crate::Outcome;
use crate::cli::McapArgs;
use crate::output::{Output, note};

/// End of the name of a journal.
const JOURNAL: &str = "journal";
/// Folder of kept settings beside the journals.
const SETTINGS: &str = "settings";

/// Writes the file.
pub(super) fn export(args: &McapArgs, out: &mut Output<'_>) -> Outcome {
    let McapArgs { source, out: to } = args;
    fs::metadata(source).map_err(|error| Failure::file(source, &error))?;
    let journals = journals_in(source);
    let messages = if journals.is_empty() {
        recordings(source, to)?
    } else {
        let mut records = Vec::new();
        for (service, file) in &journals {
            records.extend(records_of(*service, file)?);
        }
        records.sort_by_key(|entry| entry.at_ns);
        journals::write(&records, to).map_err(failure)?;
        records.len() as u64
    };
    match out.is_json() {
        true => out.json(&json!({ "file": to, "messages": messages }))?,
        false => {
            let noun = if journals.is_empty() { "message" } else { "record" };
            out.line(format_args!("{}: {}", to.display(), scene::count(messages, noun)))?;
        }
    }
    Ok(Exit::Ok)
}

fn recordings(source: &Path, to: &Path) -> Result<u64, Failure> {
    let files: Vec<PathBuf> = match source.is_dir() {
        true => entries(source).into_iter().map(|entry| entry.path).collect(),
        false => vec![source.to_owned()],
    };
    if files.is_empty() {
        let what = format!("{}: neither recordings nor journals in it", source.display());
        let help = "help: `whichone record list` prints the folder of a group's recordings";
        return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
    }
    let (messages, was_torn) = merge(&files, to).map_err(failure)?;
    if was_torn {
        note("the end of a recording is damaged; everything before it is exported");
    }
    Ok(messages)
}

/// The journals of a folder, or the one that is named.
fn journals_in(source: &Path) -> Vec<(Service, PathBuf)> {
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

/// The records of a journal. Where their wall time is not known, the last record was written when the file
/// last changed, which gives that of the others.
fn records_of(service: Service, file: &Path) -> Result<Vec<Entry>, Failure> {
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
    let changed = fs::metadata(file).and_then(|found| found.modified());
    let changed = changed.map_err(|error| Failure::file(file, &error))?;
    let changed_ns = changed.duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos() as u64;
    let offset_ns = changed_ns.saturating_sub(lines.last().map_or(0, |line| line.at_ns));
    let entry = |line: JournalLine| {
        let known_ns = line.unix_ms.map(|ms| ms * 1_000_000);
        Some(Entry {
            service: service.name().to_owned(),
            seq: line.seq,
            at_ns: known_ns.unwrap_or(line.at_ns + offset_ns),
            text: line.text,
            record: serde_json::to_value(line.record).ok()?,
        })
    };
    Ok(lines.into_iter().filter_map(entry).collect())
}
