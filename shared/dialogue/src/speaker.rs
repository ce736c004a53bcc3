//! The person who speaks in an interaction, and the observation model of that person.

use serde::{Deserialize, Serialize};
use vocabulary::{Params, PersonId, Reliability};

use crate::Model;
use scene::AttributeId;

/// Kind of a person's statements; each has errors of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Answers with yes or no, and denials.
    YesNo,
    /// Answers to open questions.
    Open,
    /// Answers to choices.
    Choice,
    /// Words that are certain: typed, or recognised beyond doubt ([`crate::CERTAIN_DOUBT`]).
    Words,
    /// All other words.
    Heard,
}

impl Channel {
    /// Every channel.
    pub const ALL: [Self; 5] = [Self::YesNo, Self::Open, Self::Choice, Self::Words, Self::Heard];

    /// The channel of a word.
    pub(crate) fn of_words(is_certain: bool) -> Self {
        if is_certain { Self::Words } else { Self::Heard }
    }
}

/// A person with their error rates, in [`steps`] from the configured ones: persons of the same
/// rates have the same model, so decisions recur.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Speaker {
    /// The name.
    pub from: PersonId,
    /// Steps by [`Channel`].
    pub(crate) channels: [i8; Channel::ALL.len()],
    /// Rates of misperception, by attribute.
    pub(crate) attributes: Vec<i8>,
}

/// Steps in a factor of two.
const STEPS: f64 = 2.0;
/// Highest rate of errors of a person, whatever was learned.
const RATE_MAX: f64 = 0.4;

/// Returns the number of steps from one rate to another; 0 steps if one of them is 0.
pub(crate) fn steps(from: f64, to: f64) -> i8 {
    let steps = ((to / from).log2() * STEPS).round();
    if steps.is_finite() { steps.clamp(-100.0, 100.0) as i8 } else { 0 }
}

/// Returns the rate some steps from another one.
fn stepped(rate: f64, steps: i8) -> f64 {
    match steps {
        0 => rate,
        steps => rate * (f64::from(steps) / STEPS).exp2(),
    }
}

/// Returns the steps of a channel's rate from the configured one; `learned` gives the rate for an
/// expected one. That of words is the share of slips in all words, from which `α` follows.
pub(crate) fn channel_steps(
    configured: &Model,
    channel: Channel,
    learned: impl Fn(f64) -> f64,
) -> i8 {
    let params = configured.params();
    let usual = Reliability { p_l: params.p_l, epsilon: params.epsilon };
    let of_answers = |rate: f64| steps(rate, learned(rate));
    match channel {
        Channel::YesNo => of_answers(usual.epsilon),
        Channel::Open => of_answers(params.open.unwrap_or(usual).epsilon),
        Channel::Choice => of_answers(params.choice.unwrap_or(usual).epsilon),
        Channel::Words | Channel::Heard => {
            // Eq. (5) mixes the object's own words with a slip, which is any word.
            let alpha = configured.smoothing(channel == Channel::Words);
            let own = configured.mean_own_words() / configured.words() as f64;
            let slips = alpha / (own + alpha);
            let slips = learned(slips).min(RATE_MAX.max(slips));
            steps(alpha, slips * own / (1.0 - slips))
        }
    }
}

fn bounded(rate: f64, steps: i8) -> f64 {
    stepped(rate, steps).min(RATE_MAX.max(rate))
}

impl Speaker {
    /// Appends numbers that are equal for speakers with equal decisions.
    pub(crate) fn key_into(&self, key: &mut Vec<i64>) {
        key.extend(self.channels.iter().chain(&self.attributes).map(|steps| i64::from(*steps)));
    }

    /// The model of this person in place of the configured one.
    pub(crate) fn model(&self, configured: &Model) -> Model {
        let is_as_configured = |steps: &i8| *steps == 0;
        if self.channels.iter().chain(&self.attributes).all(is_as_configured) {
            return configured.clone();
        }
        let params = self.params(configured.params());
        let alpha = |channel: Channel| {
            stepped(
                configured.smoothing(channel == Channel::Words),
                self.channels[channel as usize],
            )
        };
        let rates = |k: AttributeId| {
            let steps = self.attributes.get(k.index()).copied().unwrap_or(0);
            bounded(configured.misperceived(k), steps)
        };
        configured.of_person(params, [Channel::Heard, Channel::Words].map(alpha), rates)
    }

    /// The parameters of this person in place of the configured ones; `α` apart.
    pub fn params(&self, configured: Params) -> Params {
        let of = |channel: Channel, known: Reliability| {
            let epsilon = bounded(known.epsilon, self.channels[channel as usize]);
            Reliability { epsilon, ..known }
        };
        let Params { p_l, epsilon, alpha, open, choice } = configured;
        let usual = Reliability { p_l, epsilon };
        Params {
            p_l,
            epsilon: of(Channel::YesNo, usual).epsilon,
            alpha,
            open: Some(of(Channel::Open, open.unwrap_or(usual))),
            choice: Some(of(Channel::Choice, choice.unwrap_or(usual))),
        }
    }
}
