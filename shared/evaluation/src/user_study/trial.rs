//! One interaction of a participant, folded from its lines.

use crate::Verdict;
use crate::user_study::event::{Drawn, Event, Fault, Source};
use crate::user_study::plan::Step;

/// End of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The interaction came to an end.
    Verdict {
        /// Verdict.
        verdict: Verdict,
        /// The robot's number of it.
        interaction: u64,
        /// The object that was handed over or tried.
        object: Option<String>,
        /// Questions, repetitions not counted.
        questions: u32,
        /// Utterances, by the robot's count.
        utterances: u32,
        /// Seconds from the first acceptance to the end, by the robot's clock.
        seconds: Option<f64>,
        /// Monotonic milliseconds.
        ended_ms: f64,
    },
    /// It was spoilt.
    Fault(Fault, String),
}

/// An utterance of the interaction.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// Its number.
    pub seq: u64,
    /// By which way.
    pub source: Source,
    /// Monotonic milliseconds of its first sound or key.
    pub onset_ms: f64,
    /// … and of its acceptance.
    pub accepted_ms: f64,
    /// Its words, where they are kept.
    pub words: Option<String>,
}

/// A question of the interaction.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Its number.
    pub prompt: u64,
    /// Number of presentations.
    pub presentations: u32,
    /// Its words, where they are kept.
    pub words: Option<String>,
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
    /// The robot's latest interaction before it.
    pub after: u64,
    /// Utterances.
    pub said: Vec<Said>,
    /// Questions.
    pub asked: Vec<Question>,
    /// Time of the robot's decision which object to fetch, monotonic milliseconds.
    pub decided_ms: Option<f64>,
    /// Its end.
    pub end: Option<End>,
    /// Interruptions of page or console.
    pub resumed: u32,
}

impl Trial {
    /// An interaction that was drawn.
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

    /// Takes in what happened in it; anything else changes nothing.
    pub fn apply(&mut self, at: u64, event: &Event) {
        match event {
            Event::Started { after } => (self.started_at, self.after) = (Some(at), *after),
            Event::Heard { seq, source, onset_ms, accepted_ms, words }
                if self.said.iter().all(|said| said.seq != *seq) =>
            {
                let (onset_ms, accepted_ms) = (*onset_ms, *accepted_ms);
                let words = words.clone();
                self.said.push(Said { seq: *seq, source: *source, onset_ms, accepted_ms, words });
            }
            Event::Asked { prompt, presentation, words } => self.ask(*prompt, *presentation, words),
            Event::Decided { decided_ms } => self.decided_ms = Some(*decided_ms),
            Event::Ended {
                verdict,
                interaction,
                object,
                questions,
                utterances,
                seconds,
                ended_ms,
            } => {
                self.ended_at = Some(at);
                self.end = Some(End::Verdict {
                    verdict: *verdict,
                    interaction: *interaction,
                    object: object.clone(),
                    questions: *questions,
                    utterances: *utterances,
                    seconds: *seconds,
                    ended_ms: *ended_ms,
                });
            }
            Event::Faulted { fault, why } => {
                self.ended_at = Some(at);
                self.end = Some(End::Fault(*fault, why.clone()));
            }
            Event::Resumed { .. } => self.resumed += 1,
            _ => {}
        }
    }

    fn ask(&mut self, prompt: u64, presentation: u32, words: &Option<String>) {
        match self.asked.iter_mut().find(|question| question.prompt == prompt) {
            Some(question) => {
                question.presentations = question.presentations.max(presentation);
            }
            None => self.asked.push(Question {
                prompt,
                presentations: presentation,
                words: words.clone(),
            }),
        }
    }

    /// Returns whether it counts: it has ended, and is not practice.
    pub fn counts(&self) -> bool {
        !self.step.practice && self.verdict().is_some()
    }

    /// Returns the verdict, if it ended without a fault.
    pub fn verdict(&self) -> Option<Verdict> {
        match &self.end {
            Some(End::Verdict { verdict, .. }) => Some(*verdict),
            _ => None,
        }
    }

    /// Seconds from the first sound or key of the first utterance to the end: the hand-over, where
    /// there was one. None where nothing was said.
    ///
    /// The robot measures from the acceptance of that utterance; the time before is added. So the
    /// duration is exact even if the console was down when the interaction ended.
    pub fn seconds(&self) -> Option<f64> {
        let Some(End::Verdict { seconds, ended_ms, .. }) = &self.end else { return None };
        let first = self.said.first();
        match (seconds, first) {
            (Some(seconds), Some(said)) => {
                Some(seconds + (said.accepted_ms - said.onset_ms).max(0.0) / 1e3)
            }
            (Some(seconds), None) => Some(*seconds),
            (None, Some(said)) => Some((ended_ms - said.onset_ms).max(0.0) / 1e3),
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
        match &self.end {
            Some(End::Verdict { questions, .. }) => *questions,
            _ => u32::try_from(self.asked.len()).unwrap_or(u32::MAX),
        }
    }

    /// Returns the number of utterances: the robot's count, or the console's where that is larger.
    pub fn utterances(&self) -> u32 {
        let heard = u32::try_from(self.said.len()).unwrap_or(u32::MAX);
        match &self.end {
            Some(End::Verdict { utterances, .. }) => heard.max(*utterances),
            _ => heard,
        }
    }

    /// Returns the number of repeated questions.
    pub fn repeats(&self) -> u32 {
        self.asked.iter().map(|question| question.presentations.saturating_sub(1)).sum()
    }

    /// Utterances that came by that way.
    pub fn said_by(&self, source: Source) -> usize {
        self.said.iter().filter(|said| said.source == source).count()
    }
}
