//! Events of a participant: the lines of the journal.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};

use crate::Protocol;
use crate::Verdict;
use crate::plan::Step;

/// Version of the lines' form.
pub const VERSION: u32 = 1;

/// Ending of the files' names, after the participant's code and a dot.
pub const FILE_ENDING: &str = "jsonl";

/// A line of a participant's journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Time, milliseconds since 1970 by the computer's clock.
    pub at: u64,
    /// Event.
    #[serde(flatten)]
    pub event: Event,
}

/// Events. Times in `_ms` are milliseconds of the machine's monotonic clock: only their
/// differences mean something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// A participant came. Always the first line.
    Begun(Box<Begun>),
    /// Agreed to take part.
    Consented,
    /// Has read the instructions.
    Instructed,
    /// The next desired object was drawn.
    Drawn(Drawn),
    /// The policy service was switched to that planner.
    Switched {
        /// Name of the planner.
        planner: String,
    },
    /// The policy service was given its configured planner back.
    Restored,
    /// The participant began the interaction that was drawn last.
    Started {
        /// The robot's latest interaction before the trial.
        after: u64,
    },
    /// The participant said something.
    Heard(Heard),
    /// The robot asked something, or asked it again.
    Asked(Asked),
    /// The robot decided which object to fetch.
    Decided {
        /// When.
        decided_ms: f64,
    },
    /// The interaction ended, and counts unless it is practice.
    Ended(Ending),
    /// The interaction was spoilt by something technical; it does not count, and is repeated.
    Faulted {
        /// Cause.
        fault: Fault,
        /// Reason in a sentence.
        why: String,
    },
    /// Has come to the questionnaire.
    Questioned,
    /// Has answered the questionnaire: answers by the items' ids, without those left open.
    Answered {
        /// The answers.
        answers: Map<String, Json>,
    },
    /// Has done everything.
    Finished,
    /// The participant continued after the page or the console was gone.
    Resumed {
        /// The page that asked to resume.
        session: String,
    },
    /// Left before the end; the data so far count.
    Left,
    /// Withdrew; the data do not count.
    Withdrawn,
    /// Withdrew and had the data deleted: everything before is gone.
    Deleted,
}

/// The first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Begun {
    /// [`VERSION`].
    pub version: u32,
    /// The participant's name in the data.
    pub participant: String,
    /// The page that the participant uses; not exported.
    pub session: String,
    /// Seed of all randomness of this participant.
    pub seed: u64,
    /// Planned interactions, in order.
    pub plan: Vec<Step>,
    /// The protocol in force.
    pub protocol: Protocol,
    /// The group that the robot belongs to.
    pub group: String,
    /// The console's version.
    pub software: String,
}

/// A desired object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Drawn {
    /// Place in the plan, from 0; the same again after a fault.
    pub step: usize,
    /// The object's name.
    pub object: String,
    /// Name of the object for people.
    pub label: String,
    /// The scene's name.
    pub scene: String,
    /// The scene's key, 16 hexadecimal digits.
    pub scene_key: String,
    /// The names of all objects there were to draw from.
    pub among: Vec<String>,
}

/// Something that the participant said.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// The utterance's number.
    pub seq: u64,
    /// Way in which it was said.
    pub source: Source,
    /// Onset.
    pub onset_ms: f64,
    /// Acceptance of the whole.
    pub accepted_ms: f64,
    /// The words, if the study keeps them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub words: Option<String>,
}

/// A question that the robot asked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asked {
    /// The question's number.
    pub prompt: u64,
    /// Number of the presentation, from 1.
    pub presentation: u32,
    /// Words of the prompt, if they are kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub words: Option<String>,
}

/// How an interaction ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ending {
    /// Verdict.
    pub verdict: Verdict,
    /// The robot's number of the interaction, 0 without an utterance.
    pub interaction: u64,
    /// The object that was handed over or tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub object: Option<String>,
    /// Questions asked, repetitions not counted, by the robot's count.
    pub questions: u32,
    /// Utterances, by the robot's count.
    pub utterances: u32,
    /// Time from the first utterance's acceptance to the end, by the robot's clock, seconds; `None`
    /// if the robot did not end it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Time at which the end was detected.
    pub ended_ms: f64,
}

/// Way in which something was said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Typed.
    Typed,
    /// Spoken.
    Voice,
}

/// Fault that spoils an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// A service was away for too long.
    Service,
    /// The scene was changed.
    Scene,
    /// The policy could not be switched, or decides by another planner.
    Planner,
    /// The robot was restarted, or the console was away and missed the end.
    Missed,
    /// The experimenter said so.
    Experimenter,
}

/// A journal with an invalid format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}; restore the file from a copy, or move it out of the folder")]
pub struct FormatError {
    /// Line, from 1.
    pub line: usize,
    /// Reason.
    pub what: String,
}

impl Entry {
    /// Returns the event's line, with a line end.
    ///
    /// # Panics
    /// Never: an entry is an object with text keys and finite numbers.
    pub fn to_line(&self) -> String {
        serde_json::to_string(self).expect("an entry is JSON") + "\n"
    }
}

/// Reads a journal. A last line without its end is a write that was cut short, and was never
/// acknowledged: it is left out.
///
/// # Errors
/// The first invalid line.
pub fn parse(text: &str) -> Result<Vec<Entry>, FormatError> {
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let lines = whole.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(n, line)| entry(line).map_err(|what| FormatError { line: n + 1, what })).collect()
}

fn entry(line: &str) -> Result<Entry, String> {
    let entry: Entry = serde_json::from_str(line).map_err(|error| error.to_string())?;
    match &entry.event {
        Event::Begun(begun) if begun.version > VERSION => {
            Err(format!("version {} is newer than this program's {VERSION}", begun.version))
        }
        _ => Ok(entry),
    }
}
