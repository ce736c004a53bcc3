//! `journal`: what the services have recorded, and whether it holds together.

use std::path::{Path, PathBuf};

use journal::{Ending, JournalOpenError, Reading};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use service::exit::Exit;
use service::group::GroupPaths;

use super::{paths, words};
use crate::cli::JournalArgs;
use crate::error::{CliError, Outcome};
use crate::output::{Output, note};

mod arm;
mod policy;
mod speech;

/// A broken promise: which file, which record, and what is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: record {seq}: {what}", .file.display())]
struct Broken {
    file: PathBuf,
    seq: u64,
    what: String,
}

/// One file of a journal.
struct Part<R> {
    file: PathBuf,
    reading: Reading<R>,
}

impl<R> Part<R> {
    /// The records with their numbers.
    fn numbered(&self) -> impl Iterator<Item = (u64, &R)> {
        (self.reading.first_seq..).zip(&self.reading.records)
    }

    fn broken(&self, seq: u64, what: impl Into<String>) -> Broken {
        Broken { file: self.file.clone(), seq, what: what.into() }
    }
}

/// Prints a service's records, or checks them.
pub(super) fn journal(paths: &GroupPaths, args: &JournalArgs, out: &mut Output<'_>) -> Outcome {
    let path = paths.journal_file(&args.service);
    if !path.is_file() {
        let what = format!("group {} has no journal of {} yet", paths.name(), args.service);
        let cure = "start it first: whichone up";
        return Err(CliError::new(Exit::NotReached, format!("{what}; {cure}")));
    }
    match (args.service.as_str(), args.verify) {
        ("speech", false) => print(&path, out, speech::line),
        ("policy", false) => print(&path, out, policy::line),
        (_, false) => print(&path, out, arm::line),
        ("speech", true) => verify(&path, out, speech::verify),
        ("policy", true) => {
            let settings = paths::settings_in_force(paths, &args.config)?;
            let latest = policy::settings_key(&read(&path)?);
            let mut mind = ::policy::shell::mind_of_key(&settings, latest)?;
            verify(&path, out, |parts| policy::verify(&mut mind, parts))
        }
        (_, true) => verify(&path, out, arm::verify),
    }
}

fn print<R: Serialize + DeserializeOwned>(
    path: &Path,
    out: &mut Output<'_>,
    line: impl Fn(&R) -> String,
) -> Outcome {
    let part = read::<R>(path)?;
    for (seq, record) in part.numbered() {
        if out.is_json() {
            out.queue_json(&json!({ "seq": seq, "record": record }))?;
        } else {
            out.queue_line(format_args!("{seq:>6}  {}", line(record)))?;
        }
    }
    out.flush()?;
    tell_ending(&part)
}

/// A write that a kill has cut short was never acknowledged; anything else that is damaged was.
fn tell_ending<R>(part: &Part<R>) -> Outcome {
    match part.reading.ending {
        Ending::Whole => Ok(Exit::Ok),
        Ending::Torn { bytes, .. } => {
            note(format_args!("{bytes} bytes of an unfinished write follow; they do not count"));
            Ok(Exit::Ok)
        }
        Ending::Corrupt { at, seq, .. } => {
            let what = format!("{} is damaged at byte {at}", part.file.display());
            let cure = "begin anew with: whichone up --fresh";
            Err(CliError::new(Exit::Invariant, format!("{what}, before record {seq}; {cure}")))
        }
    }
}

/// Checks the journal with the older parts of it that were kept, oldest first.
fn verify<R: DeserializeOwned>(
    path: &Path,
    out: &mut Output<'_>,
    check: impl FnOnce(&[Part<R>]) -> Result<Vec<String>, Broken>,
) -> Outcome {
    let older = (1..=journal::KEPT).rev().map(|n| numbered_file(path, n));
    let files: Vec<PathBuf> = older.filter(|file| file.is_file()).chain([path.into()]).collect();
    let parts: Vec<Part<R>> = files.iter().map(|file| read(file)).collect::<Result<_, _>>()?;
    for part in &parts {
        tell_ending(part)?;
    }
    let records: u64 = parts.iter().map(|part| part.reading.records.len() as u64).sum();
    let facts = match check(&parts) {
        Ok(facts) => facts,
        Err(broken) => {
            if out.is_json() {
                out.json(&json!({ "ok": false, "broken": broken.to_string() }))?;
            }
            return Err(CliError::new(Exit::Invariant, broken.to_string()));
        }
    };
    if out.is_json() {
        out.json(&json!({ "ok": true, "records": records, "facts": facts }))?;
    } else {
        let records = words::count(records, "record");
        out.line(format_args!("{}: {records} hold together", path.display()))?;
        facts.iter().try_for_each(|fact| out.line(format_args!("  {fact}")))?;
    }
    Ok(Exit::Ok)
}

fn read<R: DeserializeOwned>(path: &Path) -> Result<Part<R>, CliError> {
    let reading = journal::read(path).map_err(|error| {
        let exit = match error {
            JournalOpenError::Io { .. } => Exit::Storage,
            JournalOpenError::Corrupt { .. } => Exit::Invariant,
            _ => Exit::Config,
        };
        CliError::new(exit, format!("{}: {error}", path.display()))
    })?;
    Ok(Part { file: path.to_owned(), reading })
}

fn numbered_file(path: &Path, number: usize) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{number}"));
    name.into()
}

/// Seconds of the machine's monotonic clock.
fn at(time: service::Time) -> String {
    format!("{:>12.3} s", time.ns() as f64 / 1e9)
}
