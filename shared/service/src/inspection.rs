//! Inspection of a service by its own program: `whichone journal`, `whichone doctor` and `whichone
//! replay` run `whichone-SERVICE journal …` and so on, so that only the service itself knows its
//! records, its reducer and its devices.

use std::collections::BTreeSet;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use config::Settings;
use journal::{Ending, JournalOpenError, Reading};
use scene::count;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::exit::{Exit, Failure};
use crate::flight;
use crate::journal_clock::WallTimes;
use crate::journal_record::JournalLine;
use crate::json_schema::with_schema;
use crate::printable::{one_line, printable_json};
use crate::service_loop::{Program, Record};
use crate::{Time, wall_time};

/// One file of a journal.
#[derive(Debug)]
pub struct Part<R> {
    file: PathBuf,
    reading: Reading<R>,
}

/// Statements of one journal about the others.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SharedFacts {
    /// Highest utterance accepted (speech) or applied (policy).
    pub utterance: u64,
    /// Picks with their objects: interaction, attempt, object; ordered (policy) or taken on (arm).
    pub picks: BTreeSet<(u64, u32, u16)>,
    /// Interactions above this have all their picks listed.
    pub since: u64,
    /// The latest interaction, if it ended with a delivery by the arm (policy); else 0.
    #[serde(default)]
    pub delivered: u64,
    /// Whether the motion stop is latched (arm); `None` if unknown.
    #[serde(default)]
    pub stopped: Option<bool>,
}

/// Result of a verification.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Verdict {
    /// Whether every invariant holds.
    pub ok: bool,
    /// The first broken one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub broken: Option<String>,
    /// Number of records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub records: Option<u64>,
    /// The verified facts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facts: Option<Vec<String>>,
    /// For the other journals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shared: Option<SharedFacts>,
}

/// One aspect of the machine that `whichone doctor` has examined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// The aspect, e.g. `microphone`.
    pub what: String,
    /// Condition of the journal.
    pub state: Condition,
    /// Details, with help if something is missing.
    pub note: String,
}

/// Condition of an examined aspect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Condition {
    /// Works.
    Good,
    /// Some function is unavailable.
    Poor,
    /// No group can run.
    Bad,
}

impl Finding {
    /// A working aspect.
    pub fn good(what: &str, note: impl Into<String>) -> Self {
        Self { what: what.to_owned(), state: Condition::Good, note: note.into() }
    }

    /// An aspect without which some function is unavailable.
    pub fn poor(what: &str, note: impl Into<String>) -> Self {
        Self { state: Condition::Poor, ..Self::good(what, note) }
    }

    /// An aspect without which no group can run.
    pub fn bad(what: &str, note: impl Into<String>) -> Self {
        Self { state: Condition::Bad, ..Self::good(what, note) }
    }
}

impl<R> Part<R> {
    /// The file's records with their numbers.
    pub fn numbered(&self) -> impl Iterator<Item = (u64, &R)> {
        (self.reading.first_seq..).zip(&self.reading.records)
    }

    /// The file's records.
    pub fn records(&self) -> &[R] {
        &self.reading.records
    }

    /// Number of the file's first record; above 1 after a rotation.
    pub fn first_seq(&self) -> u64 {
        self.reading.first_seq
    }

    /// Reports record `seq`, which breaks an invariant.
    pub fn broken(&self, seq: u64, what: impl std::fmt::Display) -> Failure {
        let file = self.file.display();
        Failure::new(Exit::Invariant, format!("{file}: record {seq}: {what}"))
    }
}

impl<R: DeserializeOwned> Part<R> {
    /// Reads one file of a journal.
    ///
    /// # Errors
    /// The file cannot be read, or is not a journal of these records.
    pub fn read(file: &Path) -> Result<Self, Failure> {
        let reading = journal::read(file).map_err(|error| {
            let is_foreign = matches!(
                error,
                JournalOpenError::Foreign(_) | JournalOpenError::Undecodable { .. }
            );
            let exit = if is_foreign { Exit::Config } else { Exit::Storage };
            Failure::new(exit, format!("{}: {error}", file.display()))
        })?;
        Ok(Self { file: file.to_owned(), reading })
    }
}

/// A time of the machine's monotonic clock, seconds, as a column of a listing.
pub fn at(time: Time) -> String {
    format!("{:>12.3} s", time.ns() as f64 / 1e9)
}

/// Executes the inspection that the arguments name; `None` if they name none.
pub(crate) fn run<P: Program>(arguments: &[String]) -> Option<Exit> {
    let inspect = match arguments.first()?.as_str() {
        "journal" => show::<P>,
        "doctor" => examine::<P>,
        "flight" => list_flight::<P>,
        "replay" => replay::<P>,
        _ => return None,
    };
    let mut out = BufWriter::new(io::stdout().lock());
    let request = Request::parse(&arguments[1..]);
    let ended = P::prepare(&request.arguments)
        .and_then(|()| inspect(&request, &mut out))
        .and_then(|()| out.flush().map_err(Failure::output));
    Some(match ended {
        Ok(()) => Exit::Ok,
        Err(failure) => {
            if !failure.message.is_empty() {
                let _ = writeln!(io::stderr(), "error: {failure}");
            }
            failure.exit
        }
    })
}

/// Arguments of an inspection.
#[derive(Debug, Default, PartialEq, Eq)]
struct Request {
    file: PathBuf,
    /// Folders of settings that were in force, newest first.
    settings: Vec<PathBuf>,
    verify: bool,
    /// Print the journal's statements about the others, unverified.
    facts: bool,
    json: bool,
    /// First record to be printed, from an older file if need be.
    since: Option<u64>,
    /// Settings that a replay changes.
    changes: Vec<(String, String)>,
    /// Arguments of the service, after `--`.
    arguments: Vec<String>,
}

impl Request {
    fn parse(arguments: &[String]) -> Self {
        let mut request = Self::default();
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--verify" => request.verify = true,
                "--facts" => request.facts = true,
                "--json" => request.json = true,
                "--since" => request.since = words.next().and_then(|word| word.parse().ok()),
                "--what-if" => {
                    let change = words.next().and_then(|word| word.split_once('='));
                    request.changes.extend(change.map(|(k, v)| (k.to_owned(), v.to_owned())));
                }
                "--" => request.arguments = words.by_ref().cloned().collect(),
                "--settings" => request.settings.extend(words.next().map(PathBuf::from)),
                file => request.file = file.into(),
            }
        }
        request
    }

    /// Returns the settings; of several, those of another version are left out.
    fn settings(&self) -> Result<Vec<Settings>, Failure> {
        let loaded = self.settings.iter().map(|folder| Settings::load_snapshot(folder));
        let (fit, wrong): (Vec<_>, Vec<_>) = loaded.partition(Result::is_ok);
        let fit: Vec<_> = fit.into_iter().flatten().collect();
        match wrong.into_iter().find_map(Result::err) {
            Some(error) if fit.is_empty() => Err(error.into()),
            _ => Ok(fit),
        }
    }
}

fn examine<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    let settings = request.settings()?;
    let findings = settings.first().map(P::doctor).unwrap_or_default();
    findings.iter().try_for_each(|finding| json_line(out, finding))
}

/// Prints every step of a flight.
fn list_flight<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    if let Some(note) = flight::lines::<P>(&request.file, |step| json_line(out, &step))? {
        let _ = writeln!(io::stderr(), "{}: {note}", request.file.display());
    }
    Ok(())
}

/// Replays a flight and prints the report.
fn replay<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    let report = flight::replay::<P>(&request.file, &request.changes)?;
    json_line(out, &report)?;
    match report.difference {
        None => Ok(()),
        Some(_) => Err(Failure::new(Exit::Invariant, "")),
    }
}

fn show<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    if request.facts {
        let shared = Some(P::shared_facts(&parts::<P>(request)?));
        return json_line(out, &Verdict { ok: true, shared, ..Verdict::default() });
    }
    match request.verify {
        true => verify::<P>(request, out),
        false => print::<P>(request, out),
    }
}

/// Reads the journal with its older parts, oldest first.
fn parts<P: Program>(request: &Request) -> Result<Vec<Part<Record<P>>>, Failure> {
    older(request).chain([request.file.clone()]).map(|file| Part::read(&file)).collect()
}

/// Older files of the journal, oldest first.
fn older(request: &Request) -> impl Iterator<Item = PathBuf> {
    let older = (1..=journal::KEPT).rev().map(|n| safe_files::suffixed(&request.file, n));
    older.filter(|file| file.is_file())
}

/// Reads an older file to be listed; one that cannot be read is named and left out.
fn readable<P: Program>(file: &Path) -> Option<Part<Record<P>>> {
    let read = Part::read(file);
    read.inspect_err(|error| drop(writeln!(io::stderr(), "left out: {error}"))).ok()
}

/// Prints the newest file, or the records from a number on.
fn print<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    let mut shown = vec![Part::<Record<P>>::read(&request.file)?];
    if request.since.is_some_and(|since| since < shown[0].first_seq()) {
        shown.splice(0..0, older(request).filter_map(|file| readable::<P>(&file)));
    }
    let settings = request.settings().unwrap_or_default();
    let times = WallTimes::of(&request.file);
    let since = request.since.unwrap_or(0);
    let mut last = None;
    for (seq, record) in shown.iter().flat_map(Part::numbered) {
        let (recorded, text) = (P::recorded_at(record), P::describe(&settings, record));
        let unix_ms = times.unix_ms(seq, recorded);
        last = Some((seq, recorded, unix_ms));
        if seq < since {
            continue;
        }
        if !request.json {
            line(out, format_args!("{seq:>6}  {}  {text}", when(recorded, unix_ms)))?;
        } else if let Some(record) = P::explain(&settings, record) {
            json_line(out, &JournalLine { seq, at_ns: recorded.ns(), unix_ms, text, record })?;
        }
    }
    out.flush().map_err(Failure::output)?;
    if last.is_none_or(|(seq, ..)| seq < since) {
        let _ = writeln!(io::stderr(), "{}", nothing_since(since, last));
    }
    shown.last().map_or(Ok(()), check_ending)
}

/// Returns a record's time as a column: by the wall clock too, if known.
fn when(recorded: Time, unix_ms: Option<u64>) -> String {
    let wall = unix_ms.map(|ms| format!("  {}", wall_time::text(ms.saturating_mul(1_000_000))));
    at(recorded) + &wall.unwrap_or_default()
}

/// Why no record is listed, with the last one: its number, and when it was written.
fn nothing_since(since: u64, last: Option<(u64, Time, Option<u64>)>) -> String {
    match last {
        None => "the journal has no records yet".to_owned(),
        Some((seq, recorded, unix_ms)) => {
            let when = when(recorded, unix_ms);
            format!("no record from {since} on; the last one is {seq}, written at {}", when.trim())
        }
    }
}

/// Checks a journal's end: an interrupted write was never acknowledged; other damage is an error.
fn check_ending<R>(part: &Part<R>) -> Result<(), Failure> {
    match part.reading.ending {
        Ending::Whole => Ok(()),
        Ending::Torn { bytes, .. } => {
            let bytes = count(bytes, "byte");
            let _ = writeln!(io::stderr(), "ignored {bytes} of an unfinished write");
            Ok(())
        }
        Ending::Corrupt { at, seq, .. } => {
            let what = format!("record {seq}: damaged at byte {at}");
            let help = "help: `whichone journal set-aside SERVICE` keeps the file";
            let file = part.file.display();
            Err(Failure::new(Exit::Storage, format!("{file}: {what}; {help}")))
        }
    }
}

/// Checks the journal with its older parts.
fn verify<P: Program>(request: &Request, out: &mut impl Write) -> Result<(), Failure> {
    let parts = parts::<P>(request)?;
    parts.iter().try_for_each(check_ending)?;
    let records: u64 = parts.iter().map(|part| part.records().len() as u64).sum();
    match P::verify(&request.settings()?, &parts) {
        Ok(facts) if request.json => {
            let (records, facts) = (Some(records), Some(facts));
            let shared = Some(P::shared_facts(&parts));
            json_line(out, &Verdict { ok: true, records, facts, shared, ..Verdict::default() })
        }
        Ok(facts) => {
            let records = count(records, "record");
            line(out, format_args!("{}: {records} verified", request.file.display()))?;
            facts.iter().try_for_each(|fact| line(out, format_args!("  {fact}")))
        }
        Err(failure) => {
            if request.json && failure.exit == Exit::Invariant {
                let broken = Some(failure.message.clone());
                json_line(out, &Verdict { broken, ..Verdict::default() })?;
            }
            Err(failure)
        }
    }
}

/// Prints a value as one line.
fn json_line(out: &mut impl Write, value: &impl Serialize) -> Result<(), Failure> {
    let json = serde_json::to_string(value).map_err(|error| Failure::output(error.into()))?;
    line(out, printable_json(&with_schema(&json)))
}

fn line(out: &mut impl Write, text: impl std::fmt::Display) -> Result<(), Failure> {
    writeln!(out, "{}", one_line(&text.to_string())).map_err(Failure::output)
}
