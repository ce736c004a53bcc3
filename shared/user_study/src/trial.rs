//! One interaction of a participant, folded from its lines.

use crate::Verdict;
use crate::event::{Asked, Drawn, Ending, Event, Fault, Heard, Source};
use crate::plan::Step;

/// End of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The interaction came to an end.
    Verdict(Ending),
    /// The trial was spoilt.
    Fault(Fault, String),
}

/// One interaction.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Step of the plan.
    pub step: Step,
    /// The desired object, and the scene.
    pub drawn: Drawn,
    /// Time of the draw, milliseconds since 1970; the next two are those of start and end.
    pub drawn_at: u64,
    /// See [`Trial::drawn_at`].
    pub started_at: Option<u64>,
    /// See [`Trial::drawn_at`].
    pub ended_at: Option<u64>,
    /// The robot's latest interaction before the trial.
    pub after: u64,
    /// Utterances.
    pub said: Vec<Heard>,
    /// Questions, each as it was presented last.
    pub asked: Vec<Asked>,
    /// Time of the robot's decision which object to fetch, monotonic milliseconds.
    pub decided_ms: Option<f64>,
    /// End of the trial.
    pub end: Option<End>,
    /// Interruptions of page or console.
    pub resumed: u32,
}

impl Trial {
    /// Makes a trial from a draw.
    pub fn new(step: Step, drawn: Drawn, at: u64) -> Self {
        Self {
            step,
            drawn,
            drawn_at: at,
            started_at: None,
            ended_at: None,
            after: 0,
            said: Vec::new(),
            asked: Vec::new(),
            decided_ms: None,
            end: None,
            resumed: 0,
        }
    }

    /// Applies an event of the trial; anything else changes nothing.
    pub fn apply(&mut self, at: u64, event: &Event) {
        match event {
            Event::Started { after } => (self.started_at, self.after) = (Some(at), *after),
            Event::Heard(heard) if self.said.iter().all(|said| said.seq != heard.seq) => {
                self.said.push(heard.clone());
            }
            Event::Asked(asked) => self.ask(asked),
            Event::Decided { decided_ms } => self.decided_ms = Some(*decided_ms),
            Event::Ended(ending) => {
                self.ended_at = Some(at);
                self.end = Some(End::Verdict(ending.clone()));
            }
            Event::Faulted { fault, why } => {
                self.ended_at = Some(at);
                self.end = Some(End::Fault(*fault, why.clone()));
            }
            Event::Resumed { .. } => self.resumed += 1,
            _ => {}
        }
    }

    fn ask(&mut self, asked: &Asked) {
        match self.asked.iter_mut().find(|known| known.prompt == asked.prompt) {
            Some(known) => known.presentation = known.presentation.max(asked.presentation),
            None => self.asked.push(asked.clone()),
        }
    }

    /// Returns whether it counts: it has ended, and is not practice.
    pub fn counts(&self) -> bool {
        !self.step.practice && self.verdict().is_some()
    }

    /// Returns how it ended, if it ended without a fault.
    pub fn ending(&self) -> Option<&Ending> {
        match &self.end {
            Some(End::Verdict(ending)) => Some(ending),
            _ => None,
        }
    }

    /// Returns the verdict, if it ended without a fault.
    pub fn verdict(&self) -> Option<Verdict> {
        self.ending().map(|ending| ending.verdict)
    }

    /// Seconds from the first sound or key of the first utterance to the end: the hand-over, if
    /// there was one. `None` without an utterance.
    ///
    /// The robot measures from the acceptance of that utterance; the time before is added. So the
    /// duration is exact even if the console was down when the interaction ended.
    pub fn seconds(&self) -> Option<f64> {
        let ending = self.ending()?;
        match (ending.seconds, self.said.first()) {
            (Some(seconds), Some(said)) => {
                Some(seconds + (said.accepted_ms - said.onset_ms).max(0.0) / 1e3)
            }
            (Some(seconds), None) => Some(seconds),
            (None, Some(said)) => Some((ending.ended_ms - said.onset_ms).max(0.0) / 1e3),
            (None, None) => None,
        }
    }

    /// Seconds from the first sound or key to the decision which object to fetch.
    pub fn talk_seconds(&self) -> Option<f64> {
        let (said, decided_ms) = (self.said.first()?, self.decided_ms?);
        Some((decided_ms - said.onset_ms).max(0.0) / 1e3)
    }

    /// Questions asked, repetitions not counted.
    pub fn questions(&self) -> u32 {
        self.ending().map_or(self.asked.len() as u32, |ending| ending.questions)
    }

    /// Returns the number of utterances: the robot's count, or the console's if that is larger.
    pub fn utterances(&self) -> u32 {
        self.ending().map_or(0, |ending| ending.utterances).max(self.said.len() as u32)
    }

    /// Returns the number of repeated questions.
    pub fn repeats(&self) -> u32 {
        self.asked.iter().map(|question| question.presentation.saturating_sub(1)).sum()
    }

    /// Returns the number of utterances by a source.
    pub fn said_by(&self, source: Source) -> usize {
        self.said.iter().filter(|said| said.source == source).count()
    }
}
