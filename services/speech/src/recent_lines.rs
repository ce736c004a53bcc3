//! Lines that the robot said a moment ago, which its microphones may hear.

use std::collections::VecDeque;

use service::bounded::push_bounded;
use service::{Span, Time};

/// Time after its end in which a line may sound again: by another device, or a network's delay.
const ECHO_WITHIN: Span = Span::from_ms(15_000);
/// Greatest delay of the report that a line sounds.
const REPORTED_WITHIN: Span = Span::from_ms(500);
const LINES_MAX: usize = 8;

/// The latest lines, oldest first.
#[derive(Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct RecentLines(VecDeque<Line>);

#[derive(serde::Serialize, serde::Deserialize)]
struct Line {
    text: String,
    /// Start of the sound; `None` before.
    began: Option<Time>,
    /// End of the sound; `None` before.
    ended: Option<Time>,
}

impl RecentLines {
    /// Adds a line that is to be spoken.
    pub(crate) fn add(&mut self, text: &str) {
        let line = Line { text: text.to_owned(), began: None, ended: None };
        push_bounded(&mut self.0, LINES_MAX, line);
    }

    /// The latest line sounds from now on.
    pub(crate) fn begin(&mut self, now: Time) {
        if let Some(line) = self.0.back_mut() {
            line.began = line.began.or(Some(now));
        }
    }

    /// Ends the latest line. One that has not sounded echoes nowhere.
    pub(crate) fn end(&mut self, now: Time) {
        self.0.retain(|line| line.began.is_some());
        self.0.iter_mut().for_each(|line| line.ended = line.ended.or(Some(now)));
    }

    /// Returns whether a sound that began at `onset` is one of the lines in its own words.
    pub(crate) fn is_echo(&self, heard: &str, onset: Time) -> bool {
        let is_recent = |line: &&Line| {
            line.began.is_some_and(|began| began <= onset + REPORTED_WITHIN)
                && line.ended.is_none_or(|ended| onset <= ended + ECHO_WITHIN)
        };
        self.0.iter().filter(is_recent).any(|line| language::is_echo(heard, &line.text))
    }
}
