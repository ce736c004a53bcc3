//! `export mcap`: recordings, journals or flights as one MCAP file.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::UNIX_EPOCH;

use command_line::Outcome;
use command_line::output::{Output, note};
use command_line::program::{command, failed};
use messages::Service;
use recording::LeftOut;
use recording::journals::{Entry, Origin, Writer};
use recording::list::entries;
use recording::recover::merge;
use scene::count;
use serde_json::json;
use service::exit::{Exit, Failure};
use service::flight::{self, Direction, Head, Line};
use service::group::{GroupError, GroupPaths};
use service::journal_record::JournalLine;

use super::journals;
use crate::args::McapArgs;
use crate::replay::service_of;

/// Writes the file.
pub(super) fn export(
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    args: &McapArgs,
    out: &mut Output<'_>,
) -> Outcome {
    let McapArgs { source, out: to } = args;
    let source = &match source {
        Some(source) => source.clone(),
        None => paths()?.recordings(),
    };
    fs::metadata(source).map_err(|error| Failure::file(source, &error))?;
    safe_files::check_new_output(to).map_err(|error| Failure::file(to, &error))?;
    let (journals, flights) = (journals::of(source), flights_in(source)?);
    let (messages, noun) = if !flights.is_empty() {
        (steps(&flights, to)?, "step")
    } else if journals.is_empty() {
        return recordings(source, to, out);
    } else {
        (records(&journals, to)?, "record")
    };
    match out.is_json() {
        true => out.json(&json!({ "file": to, "messages": messages }))?,
        false => {
            out.line(format_args!("{}: {}", to.display(), count(messages, noun)))?;
        }
    }
    Ok(Exit::Ok)
}

fn recordings(source: &Path, to: &Path, out: &mut Output<'_>) -> Outcome {
    let files: Vec<PathBuf> = match source.is_dir() {
        true => entries(source).into_iter().map(|entry| entry.path).collect(),
        false => vec![source.to_owned()],
    };
    if files.is_empty() {
        let what = format!("{}: no recordings, journals or flights in it", source.display());
        let help = "help: `whichone record list` prints the folder of a group's recordings";
        return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
    }
    let (messages, left_out) = merge(&files, to)?;
    let LeftOut { parts, messages: lost, endless } = left_out;
    match out.is_json() {
        true => {
            let left_out =
                json!({ "parts": parts, "messages": lost, "files_without_end": endless });
            out.json(&json!({ "file": to, "messages": messages, "left_out": left_out }))?;
        }
        false => out.line(format_args!("{}: {}", to.display(), count(messages, "message")))?,
    }
    if left_out.is_nothing() {
        return Ok(Exit::Ok);
    }
    note(format_args!("left out, as it cannot be read: {left_out}"));
    Ok(Exit::NotReached)
}

fn records(journals: &[(Service, PathBuf)], to: &Path) -> Result<u64, Failure> {
    let mut records = Vec::new();
    for (service, file) in journals {
        records.extend(records_of(*service, file)?);
    }
    records.sort_by_key(|entry| entry.at_ns);
    let mut writer = Writer::create(to)?;
    records.iter().try_for_each(|entry| writer.add(entry))?;
    writer.finish()?;
    Ok(records.len() as u64)
}

/// The flights of a folder, or the one that is named.
fn flights_in(source: &Path) -> Result<Vec<PathBuf>, Failure> {
    let is_flight = |path: &PathBuf| path.extension().is_some_and(|it| it == flight::EXTENSION);
    Ok(flight::list(source)?.into_iter().filter(is_flight).collect())
}

/// Writes the steps of flights, one flight after another: each service's inputs and statements.
fn steps(flights: &[PathBuf], to: &Path) -> Result<u64, Failure> {
    // Before the copy is begun, which would stay.
    let known = flights.iter().map(|file| Ok((file, flight::head(file)?, service_of(file)?)));
    let known: Vec<_> = known.collect::<Result<_, Failure>>()?;
    let mut writer = Writer::create(to)?;
    let mut steps = 0;
    for (file, head, service) in known {
        let mut program: Command = command(service.name(), "flight");
        program.arg(file).stdout(Stdio::piped()).stderr(Stdio::inherit());
        let mut child = program.spawn().map_err(|error| failed(&program, &error))?;
        let Some(lines) = child.stdout.take() else { continue };
        for line in BufReader::new(lines).lines() {
            let line = line.map_err(|error| Failure::file(file, &error))?;
            let step = serde_json::from_str(&line).map_err(|error| {
                let (file, name) = (file.display(), service.name());
                let what = format!("{file}: unexpected output of {name}: {error}");
                Failure::new(Exit::Invariant, what)
            })?;
            writer.add(&entry(&head, step))?;
            steps += 1;
        }
        let status = child.wait().map_err(|error| failed(&program, &error))?;
        if !status.success() {
            return Err(Failure::new(Exit::of_process(status.code()), String::new()));
        }
    }
    writer.finish()?;
    Ok(steps)
}

/// A step of a flight at its wall time.
fn entry(head: &Head, step: Line) -> Entry {
    let origin = match step.direction {
        Direction::In => Origin::FlightIn,
        Direction::Out => Origin::FlightOut,
    };
    Entry {
        origin,
        service: head.service.clone(),
        seq: step.pass,
        at_ns: head.started_wall_ns + step.at_ns.saturating_sub(head.started.ns()),
        text: None,
        record: step.value,
    }
}

/// The records of a journal. If their wall time is unknown, the last record gets the file's time of
/// change, from which the others' follow.
fn records_of(service: Service, file: &Path) -> Result<Vec<Entry>, Failure> {
    let lines = journals::lines(service, file)?;
    let changed = fs::metadata(file).and_then(|found| found.modified());
    let changed = changed.map_err(|error| Failure::file(file, &error))?;
    let changed_ns = changed.duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos() as u64;
    let offset_ns = changed_ns.saturating_sub(lines.last().map_or(0, |line| line.at_ns));
    let entry = |line: JournalLine| {
        let known_ns = line.unix_ms.map(|ms| ms * 1_000_000);
        Some(Entry {
            origin: Origin::Journal,
            service: service.name().to_owned(),
            seq: line.seq,
            at_ns: known_ns.unwrap_or(line.at_ns + offset_ns),
            text: Some(line.text),
            record: serde_json::to_value(line.record).ok()?,
        })
    };
    Ok(lines.into_iter().filter_map(entry).collect())
}
