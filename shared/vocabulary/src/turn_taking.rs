//! Settings of turn-taking.

use crate::Attribution;
use crate::reaction::{Reaction, TYPED};

/// How the robot takes turns with the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnTaking {
    /// Seconds of silence after a question before it is repeated.
    pub response_window_s: f64,
    /// Repetitions into silence before the interaction is abandoned.
    pub repeats_max: u32,
    /// Questions of one interaction, repetitions included, after which the robot picks the most
    /// probable object instead of asking.
    pub questions_max: u32,
    /// Seconds after a hand-over in which the object can be refused.
    pub refusal_s: f64,
    /// How an utterance is attributed to a question.
    pub attribution: Attribution,
    /// Whether decisions and repetitions are deferred while the user is speaking or an utterance is
    /// still being processed.
    pub defers: bool,
    /// Whether a question that got no answer is repeated; else another one is asked instead.
    pub repeats_same: bool,
    /// Reaction time of spoken answers, before anything is known of the user.
    pub spoken: Reaction,
    /// Reaction time of typed answers.
    pub typed: Reaction,
}

impl Default for TurnTaking {
    /// The shipped configuration.
    fn default() -> Self {
        Self {
            response_window_s: 15.0,
            repeats_max: 2,
            questions_max: 20,
            refusal_s: 60.0,
            attribution: Attribution::Mixture,
            defers: true,
            repeats_same: true,
            spoken: Reaction::default(),
            typed: Reaction::new(TYPED.0, TYPED.1),
        }
    }
}
