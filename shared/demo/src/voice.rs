//! Presentations of the robot's lines. A line is shown at once and counts as said after the time that it takes to read.

use std::collections::VecDeque;

use scene::Question;
use vocabulary::Presentation;
use vocabulary::ids::PromptId;
use vocabulary::time::{Span, Time};

/// Presentations of questions that are remembered.
const ASKED_MAX: usize = 16;
/// Questions that an utterance may answer.
const ANSWERABLE_MAX: usize = 4;
/// Time to read a line: at least, and for each character, seconds.
const LEAST_S: f64 = 0.6;
const CHARACTER_S: f64 = 0.03;

/// The lines as they are presented.
#[derive(Clone, Debug, Default)]
pub(crate) struct Voice {
    /// Presentations of questions that have ended, oldest first.
    asked: VecDeque<Presentation>,
    /// The latest presentation that was complete.
    last: Option<Presentation>,
    /// The presentation that goes on, and when it ends.
    playing: Option<(Presentation, Time)>,
    /// The latest presentation that was broken off, until another one begins.
    interrupted: Option<Presentation>,
}

impl Voice {
    /// Presents a line unless it is the latest one; an empty one ends what goes on. Returns whether it has begun.
    pub(crate) fn say(&mut self, line: Presentation, text: &str, now: Time) -> bool {
        if text.is_empty() {
            self.interrupt(now);
            return false;
        }
        let is_known = |it: &Presentation| (it.prompt, it.number) == (line.prompt, line.number);
        let playing = self.playing.as_ref().map(|(it, _)| it);
        if [self.last.as_ref(), playing].into_iter().flatten().any(is_known) {
            return false;
        }
        self.interrupt(now);
        self.interrupted = None;
        let seconds = LEAST_S + CHARACTER_S * text.chars().count() as f64;
        let began = Presentation { began: now, ..line };
        self.playing = Some((began, now + Span::from_s(seconds)));
        true
    }

    /// Breaks off the present line; it can still be answered.
    pub(crate) fn interrupt(&mut self, now: Time) {
        let Some((put, _)) = self.playing.take() else { return };
        let put = Presentation { ended: (now > put.began).then_some(now), ..put };
        self.interrupted = Some(put);
        self.remember(put);
    }

    /// Ends a line whose time is over.
    pub(crate) fn advance(&mut self, now: Time) {
        let Some((put, ends)) = self.playing.take_if(|(_, ends)| *ends <= now) else { return };
        let put = Presentation { ended: Some(ends), complete: true, ..put };
        (self.last, self.interrupted) = (Some(put), None);
        self.remember(put);
    }

    /// Returns whether a line is being presented.
    pub(crate) fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Returns the present or latest presentation.
    pub(crate) fn presented(&self) -> Presentation {
        let playing = self.playing.map(|(it, _)| it);
        playing.or(self.interrupted).or(self.last).unwrap_or_default()
    }

    /// Returns the questions that may be answered by words whose user was shown the prompt `seen` before, newest
    /// first: that prompt alone if it is a question, otherwise those before it; all where `seen` is 0.
    pub(crate) fn answerable(&self, seen: PromptId) -> Vec<Presentation> {
        let playing = self.playing.map(|(it, _)| it).filter(|it| it.question != Question::None);
        let mut asked: Vec<_> =
            playing.into_iter().chain(self.asked.iter().rev().copied()).collect();
        if asked.iter().any(|it| it.prompt == seen) {
            asked.retain(|it| it.prompt == seen);
        } else if seen != PromptId(0) {
            asked.retain(|it| it.prompt < seen);
        }
        asked.truncate(ANSWERABLE_MAX);
        asked
    }

    fn remember(&mut self, put: Presentation) {
        if put.question == Question::None {
            return;
        }
        if self.asked.len() >= ASKED_MAX {
            self.asked.pop_front();
        }
        self.asked.push_back(put);
    }
}
