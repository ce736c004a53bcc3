//! The transcript: the latest lines, each under a number of its own, in the form of the console's.

use scene::Scene;
use scene::view::Labels;
use serde::Serialize;
use vocabulary::time::Time;
use vocabulary::{Ended, Outcome};

use crate::sections::ms;

/// Most lines that are kept.
const LINES_MAX: usize = 200;

/// A line; keys that do not apply are left out.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Line {
    id: u64,
    at_ms: f64,
    unix_ms: u64,
    who: Speaker,
    text: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outcome: Option<Outcome>,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<Note>,
    /// The prompt, and which presentation of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    said: Option<(u64, u32)>,
}

#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum Speaker {
    Person,
    Robot,
    System,
}

/// What a note is about: the page puts it into words.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum Note {
    Ended { object: Option<String>, questions: u32, seconds: f64 },
    Stopped,
    Released,
}

/// The latest lines.
#[derive(Clone, Debug)]
pub(crate) struct Transcript {
    lines: Vec<Line>,
    next: u64,
    unix_ms: u64,
}

impl Transcript {
    /// An empty transcript; `unix_ms` is the time of day at time 0.
    pub(crate) fn new(unix_ms: u64) -> Self {
        Self { lines: Vec::new(), next: 1, unix_ms }
    }

    /// Returns the lines, oldest first.
    pub(crate) fn lines(&self) -> &[Line] {
        &self.lines
    }

    pub(crate) fn person(&mut self, text: &str, at: Time) {
        let line = self.blank(Speaker::Person, text, at);
        self.push(Line { source: Some("typed"), ..line });
    }

    pub(crate) fn robot(&mut self, said: (u64, u32), text: &str, at: Time) {
        let line = self.blank(Speaker::Robot, text, at);
        self.push(Line { said: Some(said), ..line });
    }

    pub(crate) fn motion_stop(&mut self, is_latched: bool, at: Time) {
        let note = if is_latched { Note::Stopped } else { Note::Released };
        let line = self.blank(Speaker::System, "", at);
        self.push(Line { note: Some(note), ..line });
    }

    pub(crate) fn ended(&mut self, scene: &Scene, labels: &Labels, over: &Ended, at: Time) {
        let label = |name: &str| {
            let object = scene.object_named(name);
            object.map_or(name, |object| labels.unique(scene, object, name)).to_owned()
        };
        let note = Note::Ended {
            object: over.name.as_deref().map(label),
            questions: over.questions,
            seconds: over.seconds,
        };
        let line = self.blank(Speaker::System, "", at);
        self.push(Line { outcome: Some(over.outcome), note: Some(note), ..line });
    }

    fn blank(&self, who: Speaker, text: &str, at: Time) -> Line {
        Line {
            id: self.next,
            at_ms: ms(at),
            unix_ms: self.unix_ms + at.ns() / 1_000_000,
            who,
            text: text.to_owned(),
            source: None,
            outcome: None,
            note: None,
            said: None,
        }
    }

    fn push(&mut self, line: Line) {
        if self.lines.len() >= LINES_MAX {
            self.lines.remove(0);
        }
        self.next = line.id + 1;
        self.lines.push(line);
    }
}
