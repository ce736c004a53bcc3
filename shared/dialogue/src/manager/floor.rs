//! The floor: whose turn it is to speak, and transitions caused by time alone.

use vocabulary::ids::PromptId;
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Presentation};

use super::{Manager, State};

/// Longest time for which a sound being heard defers a decision or a repetition: noise must not
/// silence the robot.
pub const HEARING_MAX: Span = Span::from_ms(10_000);

/// State of both voices, the user's and the robot's.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Floor {
    /// Start of the user's speech; `None` while no speech is heard.
    pub speaking_since: Option<Time>,
    /// Utterances being recognised, or recognised and not yet applied.
    pub pending: u32,
    /// The latest presentation of a prompt.
    pub presented: Presentation,
    /// Time since the prompt's end in which an answer could be heard: an outage is not silence.
    pub listened: Span,
}

impl Floor {
    fn is_speaking(&self, now: Time) -> bool {
        self.speaking_since.is_some_and(|since| now < since + HEARING_MAX)
    }

    fn is_taken(&self, now: Time) -> bool {
        self.is_speaking(now) || self.pending > 0
    }
}

impl Manager {
    /// Returns whether more is coming than the utterance at hand: the user is speaking, or more
    /// speech is being recognised.
    pub fn more_is_coming(&self, floor: &Floor, now: Time) -> bool {
        self.setup.turns.defers && (floor.is_speaking(now) || floor.pending > 1)
    }

    /// Returns whether [`Quiet`](super::Cause::Quiet) is due: a deferred decision can be made.
    pub fn quiet_is_due(&self, state: &State, floor: &Floor, now: Time) -> bool {
        let deferred = state.open.as_ref().and_then(|open| open.deferred.as_ref());
        let deferred = deferred.filter(|_| state.to_put_back().is_none());
        deferred.is_some_and(|it| !floor.is_taken(now) || now >= it.since + HEARING_MAX)
    }

    /// Returns whether [`Silence`](super::Cause::Silence) is due: the standing question was said to
    /// its end, and could be answered for the response window since.
    pub fn silence_is_due(&self, state: &State, floor: &Floor, now: Time) -> bool {
        let (act, put) = (&state.act, &floor.presented);
        let asked = act.kind == ActKind::Ask && act.prompt != PromptId(0);
        let said = put.complete && (put.prompt, put.number) == (act.prompt, act.presentation);
        let window = Span::from_s(self.response_window_s(state));
        asked
            && said
            && !(self.setup.turns.defers && floor.is_taken(now))
            && floor.listened >= window
            && now >= act.decided + window
    }

    /// Returns the response window: the one configured, or, once the user has answered a few times,
    /// the one in which this user does. Seconds.
    ///
    /// A question met with silence is repeated after the adapted window, but from then on users get
    /// at least the configured time: the user, or the client, may be away for a moment.
    pub fn response_window_s(&self, state: &State) -> f64 {
        /// Answers after which a user's reaction time counts as known.
        const ACQUAINTED: u32 = 5;
        /// Range of the adapted window, as shares of the one configured.
        const RANGE: (f64, f64) = (0.25, 2.0);
        let configured = self.setup.turns.response_window_s;
        // A user who was seen to type may type the next answer, too.
        let known = state.timing.typed.or(state.timing.spoken);
        let is_silent = state.open.as_ref().is_some_and(|open| open.silences > 0);
        let least = if is_silent { 1.0 } else { RANGE.0 };
        known.filter(|reaction| reaction.seen() >= ACQUAINTED).map_or(configured, |reaction| {
            reaction.patience_s().clamp(configured * least, configured * RANGE.1)
        })
    }
}
