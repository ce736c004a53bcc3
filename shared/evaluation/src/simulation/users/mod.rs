//! Simulated people, one file each.
//!
//! | name | answers | speaks |
//! |---|---|---|
//! | `model` | with the probabilities of eq. (6) and (7), silent with `1 − p_l`, wrong with `ε` | in observations: nothing is misread |
//! | `truthful` | always, and always right | one word |
//! | `noisy` | wrong in 5 to 20 % and silent in 20 to 30 % of the cases, drawn per person | one word, through a recogniser that drops and confuses words |
//! | `human` | mostly right; by value, with corrections, hedges, more than was asked, and late | sentences, through a better recogniser |
//!
//! Whatever they say in words is read by the `language` crate, as the grounding service does it.

mod human;
mod model;
mod noisy;
mod recogniser;
mod truthful;
mod wording;

use dialogue::{Answer, Rng};
use scene::{ObjectId, Question};

use crate::simulation::draw::{Stream, stream};
use crate::simulation::interaction::Room;

/// What somebody does when it is their turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    /// Nothing.
    Nothing,
    /// The answer itself, as the belief hears it.
    Answer(Answer),
    /// Words as they were recognised: hypotheses with their probabilities.
    Words(Vec<(String, f64)>),
}

/// A turn of a person's.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// What is said.
    pub said: Said,
    /// How much later than usual it is said, seconds.
    pub late_s: f64,
}

/// A person who wants one object.
pub trait User {
    /// What the person wants.
    fn wanted(&self) -> ObjectId;

    /// The first words: a request that the robot has understood to be one, and what it says about
    /// the object.
    fn request(&mut self) -> Turn;

    /// The answer to a question, or what is said while the robot waits ([`Question::None`]).
    fn answer(&mut self, question: Question) -> Turn;
}

/// A kind of people.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UserKind {
    /// As the planner takes them to be.
    Model,
    /// Without fault.
    Truthful,
    /// Often silent, often wrong, badly heard.
    Noisy,
    /// As people talk.
    Human,
}

impl UserKind {
    /// All kinds by name.
    pub const ALL: [(&'static str, Self); 4] = [
        ("model", Self::Model),
        ("truthful", Self::Truthful),
        ("noisy", Self::Noisy),
        ("human", Self::Human),
    ];

    /// The kind of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// Person `number` of a study: what they want, how they are and what they say.
    pub fn person<'a>(self, room: &Room<'a>, seed: u64, number: u64) -> Box<dyn User + 'a> {
        let mut rng = stream(seed, Stream::Person, number);
        let wanted = ObjectId::from(rng.below(room.problem.model.objects()));
        match self {
            Self::Model => Box::new(model::Model::new(room, wanted, rng)),
            Self::Truthful => Box::new(truthful::Truthful::new(room, wanted)),
            Self::Noisy => Box::new(noisy::Noisy::new(room, wanted, rng)),
            Self::Human => Box::new(human::Human::new(room, wanted, rng)),
        }
    }
}

impl Turn {
    /// Saying nothing.
    pub(crate) const SILENCE: Self = Self { said: Said::Nothing, late_s: 0.0 };

    /// Something said at the usual time.
    pub(crate) fn now(said: Said) -> Self {
        Self { said, late_s: 0.0 }
    }

    /// Words that are heard as they were said.
    pub(crate) fn words(text: &str) -> Self {
        Self::now(if text.is_empty() {
            Said::Nothing
        } else {
            Said::Words(vec![(text.to_owned(), 1.0)])
        })
    }
}

/// An answer to `question` that is not the true one: the other of yes and no, or another value;
/// the true one where there is no other.
pub(crate) fn wrong_answer(
    model: &dialogue::Model,
    question: Question,
    wanted: ObjectId,
    rng: &mut Rng,
) -> Answer {
    let truth = Answer::truthful(model, question, wanted);
    let others: Vec<Answer> = Answer::possible(model, question)
        .into_iter()
        .filter(|answer| *answer != truth && *answer != Answer::Silence)
        .collect();
    crate::simulation::draw::one_of(rng, &others).copied().unwrap_or(truth)
}

#[cfg(test)]
mod tests;
