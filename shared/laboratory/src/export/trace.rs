//! `export trace`: dialogues as a trace in the JSON format of Chromium, which Perfetto opens.
//!
//! Each journaled service is a process. Arrows lead from an utterance to the decision about it, and on
//! to the line or the pick that follows.

use std::collections::BTreeMap;
use std::path::Path;

use command_line::Outcome;
use command_line::output::Output;
use messages::Service;
use safe_files::Readers;
use scene::count;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::group::{GroupError, GroupPaths};
use service::journal_record::{
    ArmCause, ArmRecord, JournalLine, JournalRecord, PolicyCause, PolicyRecord, SpeechRecord,
};

use super::journals;
use crate::args::TraceArgs;

/// Farthest distance between readings of the wall clock that belong together, nanoseconds. One that
/// was set, or another start of the machine, begins a new time.
const SAME_CLOCK_NS: i64 = 1_000_000_000;

/// Writes the file.
pub(super) fn export(
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    args: &TraceArgs,
    out: &mut Output<'_>,
) -> Outcome {
    let TraceArgs { source, out: to } = args;
    let source = &match source {
        Some(source) => source.clone(),
        None => paths()?.journal(),
    };
    if !source.is_dir() {
        safe_files::open_regular(source).map_err(|error| Failure::file(source, &error))?;
    }
    safe_files::check_new_output(to).map_err(|error| Failure::file(to, &error))?;
    let found = journals::of(source);
    if found.is_empty() {
        let what = format!("{}: no journals in it", source.display());
        let help = "help: name the folder `journal` of a group";
        return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
    }
    let mut records = Vec::new();
    for (service, file) in &found {
        records.extend(journals::lines(*service, file)?);
    }
    let events = Trace::of(&records).events;
    write(to, &events)?;
    match out.is_json() {
        true => out.json(&json!({ "file": to, "events": events.len() }))?,
        false => {
            let events = count(events.len() as u64, "event");
            out.line(format_args!("{}: {events}; open it at ui.perfetto.dev", to.display()))?;
        }
    }
    Ok(Exit::Ok)
}

fn write(to: &Path, events: &[Json]) -> Result<(), Failure> {
    let text = json!({ "displayTimeUnit": "ms", "traceEvents": events }).to_string();
    safe_files::write_new_output(to, text.as_bytes(), Readers::Owner)
        .map_err(|error| Failure::file(to, &error))
}

/// A lane of a process: its number and its name.
type Track = (Service, u32, &'static str);

const HEARD: Track = (Service::Speech, 1, "heard");
const SAID: Track = (Service::Speech, 2, "said");
const DECIDED: Track = (Service::Policy, 1, "understood and decided");
const MOVED: Track = (Service::Arm, 1, "moved");

/// What an act of the robot is known by: a line, or a pick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Act {
    Line(u64, u32),
    Pick(u64, u32),
}

/// The events of a trace.
#[derive(Debug, Default)]
struct Trace {
    events: Vec<Json>,
    /// The steps of each utterance: where arrows begin and end, microseconds.
    steps: BTreeMap<u64, Vec<(f64, Track)>>,
    /// The utterances that led to acts.
    causes: BTreeMap<Act, u64>,
    /// What the arm does, and since when, microseconds.
    moving: Option<(f64, String)>,
}

impl Trace {
    fn of(records: &[JournalLine]) -> Self {
        let mut trace = Self::default();
        for (service, name) in
            [HEARD, DECIDED, MOVED].map(|(service, ..)| (service, service.name()))
        {
            let name = json!({ "name": name });
            let pid = pid(service);
            trace
                .events
                .push(json!({ "ph": "M", "pid": pid, "name": "process_name", "args": name }));
        }
        for (service, tid, name) in [HEARD, SAID, DECIDED, MOVED] {
            let (pid, name) = (pid(service), json!({ "name": name }));
            trace.events.push(
                json!({ "ph": "M", "pid": pid, "tid": tid, "name": "thread_name", "args": name }),
            );
        }
        let clock = Clock::of(records);
        // Decisions first: they tell which utterance led to a line or a pick.
        let order = |line: &&JournalLine| match &line.record {
            JournalRecord::Policy(_) => 0,
            JournalRecord::Speech(_) | JournalRecord::Arm(_) => 1,
        };
        let mut records: Vec<&JournalLine> = records.iter().collect();
        records.sort_by_key(order);
        for line in records {
            let at = |ns: u64| clock.us(line, ns);
            match &line.record {
                JournalRecord::Policy(record) => trace.decision(line, record, at),
                JournalRecord::Speech(record) => trace.speech(record, at),
                JournalRecord::Arm(record) => trace.arm(line, record, at),
            }
        }
        if let Some((since, name)) = trace.moving.take() {
            trace.instant(MOVED, &name, since);
        }
        trace.arrows();
        trace
    }

    fn speech(&mut self, record: &SpeechRecord, at: impl Fn(u64) -> f64) {
        match record {
            SpeechRecord::Accepted(said) => {
                let (from, to) = (at(said.onset_ns), at(said.end_ns));
                let args = json!({ "text": said.text, "source": said.source, "from": said.from,
                    "confidence": said.confidence, "key": said.key });
                self.span(HEARD, &format!("utterance {}", said.utterance), (from, to), &args);
                self.step(said.utterance, from, HEARD);
            }
            SpeechRecord::Presented(line) => {
                let from = at(line.began_ns);
                let args = json!({ "presentation": line.presentation, "complete": line.complete });
                let to = line.ended_ns.map_or(from, &at);
                self.span(SAID, &format!("line {}", line.prompt), (from, to), &args);
                self.follow(Act::Line(line.prompt, line.presentation), from, SAID);
            }
            SpeechRecord::StopOrdered { given_ns } => {
                self.instant(HEARD, "stop ordered", at(*given_ns));
            }
            SpeechRecord::StopSettled { .. } => {}
        }
    }

    fn decision(&mut self, line: &JournalLine, record: &PolicyRecord, at: impl Fn(u64) -> f64) {
        let name = line.text.split(" (").next().unwrap_or_default();
        let decision = &record.decision;
        let PolicyCause::Utterance { utterance, accepted_ns, .. } = record.cause else {
            return self.instant(DECIDED, name, at(line.at_ns));
        };
        let from = at(accepted_ns);
        let args = json!({ "text": decision.text, "value_s": decision.value_s,
            "belief": record.belief, "interaction": record.interaction });
        self.span(DECIDED, name, (from, at(line.at_ns)), &args);
        self.step(utterance, from, DECIDED);
        let pick = decision.pick.as_ref().map(|it| Act::Pick(it.interaction, it.attempt));
        let acts = [Some(Act::Line(decision.prompt, decision.presentation)), pick];
        for act in acts.into_iter().flatten() {
            self.causes.entry(act).or_insert(utterance);
        }
    }

    fn arm(&mut self, line: &JournalLine, record: &ArmRecord, at: impl Fn(u64) -> f64) {
        let now = at(line.at_ns);
        match record.cause {
            // A motion goes on.
            ArmCause::Moved => return,
            ArmCause::Motion { .. } => self.instant(MOVED, &line.text, now),
            _ => {}
        }
        if let Some((since, name)) = self.moving.take() {
            self.span(MOVED, &name, (since, now), &json!({}));
        }
        let goes_on =
            !matches!(record.cause, ArmCause::Rested | ArmCause::Shutdown | ArmCause::Snapshot);
        self.moving = goes_on.then(|| (now, line.text.clone()));
        if let (ArmCause::Ordered, Some(pick)) = (record.cause, &record.pick) {
            self.follow(Act::Pick(pick.interaction, pick.attempt), now, MOVED);
        }
    }

    fn span(&mut self, track: Track, name: &str, (from, to): (f64, f64), args: &Json) {
        let (pid, tid, us) = (pid(track.0), track.1, (to - from).max(0.0));
        self.events.push(json!({ "ph": "X", "pid": pid, "tid": tid, "ts": from, "dur": us,
            "name": name, "cat": track.2, "args": args }));
    }

    fn instant(&mut self, track: Track, name: &str, at: f64) {
        let (pid, tid) = (pid(track.0), track.1);
        self.events.push(json!({ "ph": "i", "s": "t", "pid": pid, "tid": tid, "ts": at,
            "name": name, "cat": track.2 }));
    }

    fn step(&mut self, utterance: u64, at: f64, track: Track) {
        self.steps.entry(utterance).or_default().push((at, track));
    }

    /// Continues the arrows of the utterance that led to an act, once.
    fn follow(&mut self, act: Act, at: f64, track: Track) {
        if let Some(utterance) = self.causes.remove(&act) {
            self.step(utterance, at, track);
        }
    }

    /// Joins the steps of each utterance.
    fn arrows(&mut self) {
        for (utterance, mut steps) in std::mem::take(&mut self.steps) {
            steps.sort_by(|a, b| a.0.total_cmp(&b.0));
            let last = steps.len() - 1;
            for (n, (at, (service, tid, _))) in steps.into_iter().enumerate() {
                let kind = match n {
                    _ if last == 0 => continue,
                    0 => "s",
                    n if n == last => "f",
                    _ => "t",
                };
                self.events.push(json!({ "ph": kind, "bp": "e", "id": utterance, "ts": at,
                    "pid": pid(service), "tid": tid, "name": "utterance", "cat": "utterance" }));
            }
        }
    }
}

fn pid(service: Service) -> usize {
    let place = Service::JOURNALED.iter().position(|it| *it == service);
    1 + place.unwrap_or(Service::JOURNALED.len())
}

/// How far the wall clock was ahead of the monotonic one. Records state wall time in whole
/// milliseconds, so the greatest difference of those that belong together is the nearest.
#[derive(Debug)]
struct Clock {
    /// Least and greatest difference of each time, nanoseconds, ascending.
    times: Vec<(i64, i64)>,
}

impl Clock {
    fn of(records: &[JournalLine]) -> Self {
        let mut ahead: Vec<i64> = records.iter().filter_map(ahead_ns).collect();
        ahead.sort_unstable();
        let mut times: Vec<(i64, i64)> = Vec::new();
        for ns in ahead {
            match times.last_mut() {
                Some((_, last)) if ns - *last < SAME_CLOCK_NS => *last = ns,
                _ => times.push((ns, ns)),
            }
        }
        Self { times }
    }

    /// Microseconds since 1970 of a monotonic time in a record; since the start of the machine if
    /// that is unknown.
    fn us(&self, line: &JournalLine, ns: u64) -> f64 {
        let time = ahead_ns(line).and_then(|ahead| self.times.iter().find(|it| ahead <= it.1));
        (ns as i64 + time.map_or(0, |it| it.1)) as f64 / 1e3
    }
}

fn ahead_ns(line: &JournalLine) -> Option<i64> {
    Some(line.unix_ms? as i64 * 1_000_000 - line.at_ns as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One record of each kind.
    fn records() -> Vec<JournalLine> {
        let files = [
            include_str!("../../../../tests/golden/journal_speech.jsonl"),
            include_str!("../../../../tests/golden/journal_policy.jsonl"),
            include_str!("../../../../tests/golden/journal_arm.jsonl"),
        ];
        let lines = files.iter().flat_map(|file| file.lines());
        lines.map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    #[test]
    fn every_kind_of_record_has_its_track() {
        let trace = Trace::of(&records());
        let of = |kind: &str| trace.events.iter().filter(|it| it["ph"] == kind).count();
        assert_eq!(of("M"), 7);
        for track in [HEARD, SAID, DECIDED, MOVED] {
            let is_on = |event: &Json| event["pid"] == pid(track.0) && event["tid"] == track.1;
            let found = trace.events.iter().filter(|it| it["ph"] == "X" && is_on(it)).count();
            assert!(found > 0, "{track:?}");
        }
        for event in &trace.events {
            let us = event.get("dur").map_or(0.0, |it| it.as_f64().unwrap());
            assert!(us >= 0.0, "{event}");
        }
    }

    #[test]
    fn times_agree_to_the_nanosecond_until_the_clock_is_set() {
        let mut lines = records();
        lines.truncate(3);
        for (n, line) in lines.iter_mut().enumerate() {
            line.at_ns = 1_999_999 * (n as u64 + 1);
            line.unix_ms = Some(1_000_000 + (line.at_ns + 500_000) / 1_000_000);
        }
        lines[2].unix_ms = Some(5_000_000);
        let clock = Clock::of(&lines);
        let us = |n: usize| clock.us(&lines[n], lines[n].at_ns);
        assert!((us(1) - us(0) - 1_999.999).abs() < 1e-3, "{} {}", us(0), us(1));
        assert!(us(2) - us(1) > 1e9, "{}", us(2));
        lines[0].unix_ms = None;
        assert!((clock.us(&lines[0], 3_000) - 3.0).abs() < 1e-9);
    }
}
