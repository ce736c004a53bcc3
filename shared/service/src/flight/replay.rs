//! Replays a flight with this build's reducer, and compares the statements.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use config::Settings;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::difference::first_difference;
use super::reader::{self, Flight, Step};
use super::{Beginning, Entry, Head};
use crate::bounded::push_bounded;
use crate::exit::{Exit, Failure};
use crate::lifecycle::Environment;
use crate::service_loop::{Program, Record};
use crate::{Effects, Event, Node, Time};

/// Events before a difference that a report shows.
const BEFORE_MAX: usize = 20;
/// The option with which settings are changed.
const WHAT_IF: &str = "--what-if";
/// Settings whose files are in the flight.
const FIXED: [&str; 2] = ["group.scene", "arm.robot"];

type In<P> = <<P as Program>::Node as Node>::In<'static>;
type Fx<P> = Effects<<<P as Program>::Node as Node>::Out, Record<P>>;

/// Result of a replay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The file.
    pub file: PathBuf,
    /// The service.
    pub service: String,
    /// Version of the program that recorded it.
    pub recorded_by: String,
    /// Version of the program that replayed it.
    pub replayed_by: String,
    /// Passes with events that were compared.
    pub passes: u64,
    /// Events that the reducer was given.
    pub events: u64,
    /// Time from the start to the last event, seconds.
    pub seconds: f64,
    /// Whether the file ends in the middle of a frame, as that of a killed machine may.
    pub torn: bool,
    /// Offset of a damaged frame, bytes; nothing after it was replayed.
    pub damaged_at: Option<u64>,
    /// The first difference, at which a replay without changed settings ends.
    pub difference: Option<Difference>,
    /// Decisions that differ with changed settings.
    pub decisions: Vec<Changed>,
    /// Passes in which anything else differs with changed settings.
    pub other_passes: u64,
    /// The difference in the first of them.
    pub other_difference: Option<Difference>,
}

/// Difference of records or outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Number of the pass, from 1.
    pub pass: u64,
    /// Time of its last event, nanoseconds of the monotonic clock.
    pub at_ns: u64,
    /// Time from the start of the service, seconds.
    pub after_s: f64,
    /// Field, e.g. `outputs[0].Act.prompt`; `panic` if the reducer panics.
    pub path: String,
    /// The recorded value.
    pub recorded: Value,
    /// Value recomputed by this build.
    pub recomputed: Value,
    /// The last events up to there, oldest first: `at_ns` and `event`.
    pub before: Vec<Value>,
}

/// A decision, as replays with other settings compare them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Interaction of the decision, 0 outside of one.
    pub interaction: u64,
    /// The decision in words: equal decisions have equal words.
    pub what: String,
    /// Expected value of the decision, if known.
    pub value: Option<f64>,
}

/// A decision that differs under other settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Changed {
    /// Number of the pass, from 1.
    pub pass: u64,
    /// Time of its last event, nanoseconds of the monotonic clock.
    pub at_ns: u64,
    /// Time from the start of the service, seconds.
    pub after_s: f64,
    /// The recorded decision.
    pub recorded: Option<Decision>,
    /// The one under the other settings.
    pub recomputed: Option<Decision>,
}

/// Replays the flight in `file`: exactly, up to the first difference; or, with `changes` to the
/// settings (`("dialogue.planner", "entropy")`), open loop to its end: the recorded inputs stay.
///
/// # Errors
/// The file cannot be read or is of another build; a setting is unknown or cannot change.
pub fn replay<P: Program>(file: &Path, changes: &[(String, String)]) -> Result<Report, Failure> {
    let (flight, head, beginning) = reader::open::<P>(file)?;
    if let Some((key, _)) = changes.iter().find(|(key, _)| FIXED.contains(&key.as_str())) {
        let what =
            format!("{WHAT_IF}: {key}: a flight is about the scene and the robot that it holds");
        return Err(Failure::new(Exit::Usage, format!("{what}; help: change another setting")));
    }
    let label = file.display().to_string();
    let with = |changes: &[_]| Settings::from_snapshot(&label, &head.settings, (WHAT_IF, changes));
    let (recorded, settings) = (with(&[])?, with(changes)?);
    let environment = Environment { arguments: head.arguments.clone(), ..Environment::nowhere() };
    let config = P::config(&environment, &settings)?;
    let node = match beginning {
        Beginning::Journal(records) => P::Node::recover(config, records)?,
        Beginning::Checkpoint(checkpoint) => {
            let mut node = P::Node::resume(config, &checkpoint)?;
            if !changes.is_empty() {
                // As after a restart with them, the node takes over the other settings.
                node.on(Event::Started, head.started, &mut Effects::default());
            }
            node
        }
    };
    let run = Run::<P> {
        report: report(file, &head),
        started: head.started,
        settings: [recorded, settings],
        is_what_if: !changes.is_empty(),
        node,
        effects: Effects::default(),
        now: head.started,
        before: VecDeque::new(),
    };
    run.finish(flight)
}

fn report(file: &Path, head: &Head) -> Report {
    Report {
        file: file.to_owned(),
        service: head.service.clone(),
        recorded_by: head.version.clone(),
        replayed_by: build_info::full_version(),
        passes: 0,
        events: 0,
        seconds: 0.0,
        torn: false,
        damaged_at: None,
        difference: None,
        decisions: Vec::new(),
        other_passes: 0,
        other_difference: None,
    }
}

/// A replay under way.
struct Run<P: Program> {
    report: Report,
    started: Time,
    /// The recorded ones and those of the replay.
    settings: [Settings; 2],
    is_what_if: bool,
    node: P::Node,
    effects: Fx<P>,
    now: Time,
    /// The last events, as they are in the file.
    before: VecDeque<Vec<u8>>,
}

impl<P: Program> Run<P> {
    fn finish(mut self, mut flight: Flight) -> Result<Report, Failure> {
        while self.report.difference.is_none()
            && let Some(step) = reader::step::<P>(&mut flight)?
        {
            match step {
                Step::Event(at, event, bytes) => self.event(at, event, bytes),
                Step::Durable => self.node.on_durable(),
                Step::Stated(recorded, bytes) => self.compare(&recorded, &bytes)?,
            }
        }
        (self.report.torn, self.report.damaged_at) = (flight.is_torn, flight.damaged_at);
        self.report.seconds = self.now.since(self.started).s();
        Ok(self.report)
    }

    fn event(&mut self, at: Time, event: Event<In<P>>, bytes: Vec<u8>) {
        (self.now, self.report.events) = (at, self.report.events + 1);
        push_bounded(&mut self.before, BEFORE_MAX, bytes);
        let Self { node, effects, .. } = self;
        // A flight may hold the event at which its service panicked.
        let result = catch_unwind(AssertUnwindSafe(|| node.on(event, at, effects)));
        if let Err(panic) = result {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or(panic.downcast_ref::<&str>().copied()).unwrap_or_default();
            let found = ("panic".to_owned(), Value::Null, json!(text));
            self.report.difference = Some(self.difference(found));
        }
    }

    /// Compares the recorded statements of a pass with this build's.
    fn compare(&mut self, recorded: &Fx<P>, bytes: &[u8]) -> Result<(), Failure> {
        self.report.passes += 1;
        let own = reader::encoded(&self.effects).map_err(|error| not_encoded(&error))?;
        if own != bytes && !self.is_what_if {
            self.report.difference = Some(self.difference_to(recorded)?);
        } else if own != bytes && !self.compare_decisions(recorded) {
            self.report.other_passes += 1;
            if self.report.other_difference.is_none() {
                self.report.other_difference = Some(self.difference_to(recorded)?);
            }
        }
        self.effects.carried_out();
        Ok(())
    }

    /// Returns the first difference between this pass's recorded statements and this build's.
    fn difference_to(&self, recorded: &Fx<P>) -> Result<Difference, Failure> {
        let [a, b] = [recorded, &self.effects].map(serde_json::to_value);
        let (a, b) = (a.map_err(|e| not_encoded(&e))?, b.map_err(|e| not_encoded(&e))?);
        // Values that JSON does not have, as infinities, are the same there.
        Ok(self.difference(first_difference(&a, &b).unwrap_or((String::new(), a, b))))
    }

    /// Notes the decisions of this pass that differ. Returns whether there are any.
    fn compare_decisions(&mut self, recorded: &Fx<P>) -> bool {
        let decisions = |settings: &Settings, effects: &Fx<P>| -> Vec<Decision> {
            effects.records().iter().filter_map(|record| P::decision(settings, record)).collect()
        };
        let mut recorded = decisions(&self.settings[0], recorded).into_iter();
        let mut recomputed = decisions(&self.settings[1], &self.effects).into_iter();
        let mut differs = false;
        loop {
            let (a, b) = (recorded.next(), recomputed.next());
            if a.is_none() && b.is_none() {
                break;
            }
            if a.as_ref().map(|it| &it.what) != b.as_ref().map(|it| &it.what) {
                differs = true;
                let (pass, at_ns) = (self.report.passes, self.now.ns());
                let after_s = self.now.since(self.started).s();
                self.report.decisions.push(Changed {
                    pass,
                    at_ns,
                    after_s,
                    recorded: a,
                    recomputed: b,
                });
            }
        }
        differs
    }

    /// Returns a difference in this pass: its field, the recorded value and this build's.
    fn difference(&self, (path, recorded, recomputed): (String, Value, Value)) -> Difference {
        let event = |bytes: &Vec<u8>| {
            let entry = postcard::from_bytes::<Entry<Event<In<P>>, ()>>(bytes).ok();
            match entry {
                Some(Entry::Event(at, event)) => json!({ "at_ns": at.ns(), "event": event }),
                _ => Value::Null,
            }
        };
        Difference {
            pass: self.report.passes,
            at_ns: self.now.ns(),
            after_s: self.now.since(self.started).s(),
            path,
            recorded,
            recomputed,
            before: self.before.iter().map(event).collect(),
        }
    }
}

fn not_encoded(error: &dyn std::error::Error) -> Failure {
    Failure::new(Exit::Invariant, format!("effects cannot be encoded: {error}"))
}
