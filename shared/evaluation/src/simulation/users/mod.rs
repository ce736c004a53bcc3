//! The simulated user: wishes, words and timing.
//!
//! One [`SimulatedUser`] serves the study, the simulations, the tests with real sound and
//! `whichone await pick --answer-as`. It never keeps the scene: each call names the [`Domain`], so
//! that the scene may change under the dialogue.
//!
//! | kind | answers | speaks |
//! |---|---|---|
//! | `model` | with the probabilities of eq. (6) and (7), silent with `1 − p_l`, wrong with `ε` | in observations: nothing is misread |
//! | `mistaken-R` | as `model`, but takes each value for another one in R % of the cases and sticks to it; slips in 0.5 % | in observations |
//! | `wrong-R` | as `model`, but wrong in R % of the answers, each by itself | in observations |
//! | `truthful` | always, and always right | one word |
//! | `noisy` | wrong in 5 to 20 % and silent in 20 to 30 % of the cases, drawn per user | one word, through a recogniser that drops and confuses words |
//! | `human` | mostly right; by value, with corrections, hedges, more than was asked, and late | sentences, through a better recogniser |
//!
//! [`TimedUser`] adds reaction times and turn-taking errors. Words are read by the `language`
//! crate, as the grounding service does it.

mod manners;
mod model_user;
mod recogniser;
mod timing;
mod wording;

use dialogue::{Answer, Model};
use scene::{ObjectId, Question, Scene};
use vocabulary::{Announce, Rng};

pub use manners::Manners;
pub use model_user::{Errors, ModelUser};
pub use timing::{Habits, TimedKind, TimedUser, TimedUtterance, Timing};

use crate::simulation::draw::{Stream, chance, one_of, stream};
use recogniser::Recogniser;
use wording::{Wording, own_values};

/// Share of a noisy user's wrong answers: the range from which it is drawn.
const NOISY_WRONG: (f64, f64) = (0.05, 0.20);
/// Share of the questions that a noisy user leaves unanswered: the range from which it is drawn.
const NOISY_SILENT: (f64, f64) = (0.20, 0.30);
/// Probabilities that a noisy user's request names no, one, and two values.
const NOISY_REQUEST: [f64; 3] = [0.5, 0.3, 0.2];

/// Share of the answers in which mistaken users say other than they mean.
const MISTAKEN_SLIP: f64 = 0.005;

/// Share of the announcements that a noisy user attends to.
const NOISY_ATTENDS: f64 = 0.6;

/// The objects that a user talks about.
#[derive(Clone, Copy, Debug)]
pub struct Domain<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The observation model of the scene.
    pub model: &'a Model,
}

/// A user's contribution in one turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// Nothing.
    Silence,
    /// An answer, as the belief receives it.
    Answer(Answer),
    /// Recognised words: hypotheses with their probabilities, the most probable one first.
    Words(Vec<(String, f64)>),
}

impl Reply {
    /// The most probable words; `None` for silence or an answer without words.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Words(hypotheses) => hypotheses.first().map(|(text, _)| text.as_str()),
            Self::Silence | Self::Answer(_) => None,
        }
    }

    /// The number of words of the most probable hypothesis.
    pub fn words(&self) -> usize {
        match self {
            Self::Silence => 0,
            Self::Answer(_) => 1,
            Self::Words(_) => self.text().map_or(0, |text| text.split_whitespace().count()),
        }
    }
}

impl From<Answer> for Reply {
    fn from(answer: Answer) -> Self {
        if answer == Answer::Silence { Self::Silence } else { Self::Answer(answer) }
    }
}

/// A user's turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Text of the utterance.
    pub reply: Reply,
    /// Delay beyond the usual reaction time, seconds.
    pub late_s: f64,
}

impl Turn {
    /// A turn in which nothing is said.
    pub const SILENT: Self = Self { reply: Reply::Silence, late_s: 0.0 };

    /// Words that are recognised as they were said, in time.
    pub fn words(text: &str) -> Self {
        if text.is_empty() {
            return Self::SILENT;
        }
        Reply::Words(vec![(text.to_owned(), 1.0)]).into()
    }
}

impl From<Reply> for Turn {
    fn from(reply: Reply) -> Self {
        Self { reply, late_s: 0.0 }
    }
}

/// A kind of user by name, as `whichone study` has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UserKind {
    /// Answers as the planner expects.
    Model,
    /// Answers without errors.
    Truthful,
    /// Often silent, often wrong, badly recognised.
    Noisy,
    /// Talks as people do.
    Human,
    /// Takes each value for another one in that many of a hundred cases, and sticks to it.
    Mistaken(u8),
    /// Answers wrongly in that many of a hundred cases, each by itself.
    Wrong(u8),
}

impl UserKind {
    /// All kinds by name.
    pub const ALL: [(&'static str, Self); 11] = [
        ("model", Self::Model),
        ("truthful", Self::Truthful),
        ("noisy", Self::Noisy),
        ("human", Self::Human),
        ("mistaken-0", Self::Mistaken(0)),
        ("mistaken-1", Self::Mistaken(1)),
        ("mistaken-3", Self::Mistaken(3)),
        ("mistaken-5", Self::Mistaken(5)),
        ("mistaken-10", Self::Mistaken(10)),
        ("wrong-5", Self::Wrong(5)),
        ("wrong-10", Self::Wrong(10)),
    ];

    /// Returns the kind of the given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
    }

    /// Returns the kind's name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// User `number` of a study: their object, traits and replies follow from the seed and the
    /// number.
    pub fn user(self, domain: Domain<'_>, seed: u64, number: u64) -> SimulatedUser {
        SimulatedUser::wanting_any(self.into(), domain, stream(seed, Stream::Person, number))
    }
}

/// A user's errors and the form of their replies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Policy {
    /// The answer distribution of the observation model.
    Model,
    /// Answers with errors of one's own.
    Erring(Errors),
    /// Always right, in one word; with probability `by_value` a yes or no is replaced by the value
    /// itself ("it is white").
    Truthful {
        /// Probability of an answer by value.
        by_value: f64,
    },
    /// Answers with probability `answers`, of those `random` at random, right or wrong.
    Unreliable {
        /// Probability of answering at all.
        answers: f64,
        /// Probability that an answer is drawn at random.
        random: f64,
    },
    /// One word, often wrong or missing, through a bad recogniser.
    Noisy,
    /// Full sentences with these manners.
    Talkative(&'static Manners),
}

impl From<UserKind> for Policy {
    fn from(kind: UserKind) -> Self {
        match kind {
            UserKind::Model => Self::Model,
            UserKind::Truthful => Self::Truthful { by_value: 0.0 },
            UserKind::Noisy => Self::Noisy,
            UserKind::Human => Self::Talkative(&Manners::EVERYDAY),
            UserKind::Mistaken(percent) => {
                let misperception = f64::from(percent) / 100.0;
                Self::Erring(Errors { misperception, slip: MISTAKEN_SLIP })
            }
            UserKind::Wrong(percent) => {
                Self::Erring(Errors { misperception: 0.0, slip: f64::from(percent) / 100.0 })
            }
        }
    }
}

/// A [`Policy`] with drawn traits.
#[derive(Clone, Debug)]
enum Traits {
    Model(ModelUser),
    Truthful { by_value: f64 },
    Unreliable { answers: f64, random: f64 },
    Noisy { wrong: f64, silent: f64 },
    Talkative(&'static Manners),
    Scripted(std::collections::VecDeque<Turn>),
}

/// A user who wants one object. The same generator gives the same replies.
#[derive(Clone, Debug)]
pub struct SimulatedUser {
    wanted: Option<ObjectId>,
    traits: Traits,
    rng: Rng,
}

impl SimulatedUser {
    /// A user who wants that object.
    pub fn new(policy: Policy, wanted: ObjectId, mut rng: Rng) -> Self {
        let traits = match policy {
            Policy::Model => Traits::Model(ModelUser::new(wanted, rng.next_u64())),
            Policy::Erring(errors) => {
                Traits::Model(ModelUser::erring(wanted, rng.next_u64(), errors))
            }
            Policy::Truthful { by_value } => Traits::Truthful { by_value },
            Policy::Unreliable { answers, random } => Traits::Unreliable { answers, random },
            Policy::Noisy => {
                let wrong = rng.between(NOISY_WRONG);
                Traits::Noisy { wrong, silent: rng.between(NOISY_SILENT) }
            }
            Policy::Talkative(manners) => Traits::Talkative(manners),
        };
        Self { wanted: Some(wanted), traits, rng }
    }

    /// A user who wants one of the objects, each with the same probability.
    pub fn wanting_any(policy: Policy, domain: Domain<'_>, mut rng: Rng) -> Self {
        let wanted = ObjectId::from(rng.below(domain.model.objects()));
        Self::new(policy, wanted, rng)
    }

    /// A truthful user; without an object, one who wants something that is not in the scene.
    pub fn truthful(wanted: Option<ObjectId>) -> Self {
        Self { wanted, traits: Traits::Truthful { by_value: 0.0 }, rng: Rng::new(0) }
    }

    /// A user with prepared turns, the request first, who is silent once they are used up.
    pub fn scripted(wanted: ObjectId, turns: Vec<Turn>) -> Self {
        Self { wanted: Some(wanted), traits: Traits::Scripted(turns.into()), rng: Rng::new(0) }
    }

    /// The wanted object; `None` if the scene does not have it.
    pub fn wanted(&self) -> Option<ObjectId> {
        self.wanted
    }

    /// Sets the wanted object, after the scene has changed.
    pub fn want(&mut self, object: Option<ObjectId>) {
        self.wanted = object;
    }

    /// The user's generator, for further draws of the same stream.
    pub fn rng(&mut self) -> &mut Rng {
        &mut self.rng
    }

    /// Returns the opening request.
    pub fn request(&mut self, domain: Domain<'_>) -> Turn {
        match (&mut self.traits, self.wanted) {
            (Traits::Scripted(turns), _) => turns.pop_front().unwrap_or(Turn::SILENT),
            (Traits::Model(_), _) => Turn::SILENT,
            (Traits::Noisy { .. }, Some(wanted)) => {
                let named = own_values(domain.scene, wanted, &NOISY_REQUEST, &mut self.rng);
                let object = Wording::plain(domain.scene).object(&named, &mut self.rng);
                let heard = Recogniser::BAD.hear(
                    &format!("get me the {object}"),
                    domain.scene,
                    &mut self.rng,
                );
                heard.into()
            }
            (Traits::Talkative(manners), Some(wanted)) => {
                manners.speaker(domain, wanted, &mut self.rng).request()
            }
            _ => Turn::words(&format!("get me the {}", domain.scene.noun())),
        }
    }

    /// Returns the reaction to the announcement of an object: a silence if it is taken for the
    /// wanted one, or not attended to. Users who answer as the model has it object with its
    /// probabilities; the attention of others does not depend on the robot's expectation.
    pub fn objection(&mut self, domain: Domain<'_>, announce: Announce, object: ObjectId) -> Turn {
        let this = Question::Point(object);
        let rng = &mut self.rng;
        match (&mut self.traits, self.wanted) {
            (Traits::Scripted(turns), _) => turns.pop_front().unwrap_or(Turn::SILENT),
            (Traits::Model(user), _) => match user.denies(domain.model, announce, object) {
                true => Reply::Answer(Answer::No).into(),
                false => Turn::SILENT,
            },
            (Traits::Noisy { wrong, .. }, Some(wanted)) => {
                let attends = chance(rng, NOISY_ATTENDS);
                match answer_or_slip(domain.model, this, wanted, *wrong, rng) {
                    Answer::No if attends => Recogniser::BAD
                        .hear(Answer::No.text(domain.scene), domain.scene, rng)
                        .into(),
                    _ => Turn::SILENT,
                }
            }
            (Traits::Talkative(manners), Some(wanted)) => {
                manners.speaker(domain, wanted, rng).objection(object)
            }
            (Traits::Unreliable { .. }, _) => match self.answer(domain, this) {
                turn if turn.reply == Reply::Answer(Answer::No) => turn,
                _ => Turn::SILENT,
            },
            (_, wanted) if wanted == Some(object) => Turn::SILENT,
            _ => Turn::words(Answer::No.text(domain.scene)),
        }
    }

    /// Returns the reply to a question, or to a robot that waits ([`Question::None`]).
    pub fn answer(&mut self, domain: Domain<'_>, question: Question) -> Turn {
        let rng = &mut self.rng;
        match (&mut self.traits, self.wanted) {
            (Traits::Scripted(turns), _) => turns.pop_front().unwrap_or(Turn::SILENT),
            (Traits::Model(user), _) => Reply::from(user.answer(domain.model, question)).into(),
            (Traits::Unreliable { answers, random }, Some(wanted)) => {
                let answer = if chance(rng, *answers) {
                    let truth = Answer::truthful(domain.model, question, wanted);
                    if chance(rng, *random) {
                        any_answer(domain.model, question, truth, rng)
                    } else {
                        truth
                    }
                } else {
                    Answer::Silence
                };
                Reply::from(answer).into()
            }
            (Traits::Noisy { wrong, silent }, Some(wanted)) => {
                if chance(rng, *silent) {
                    return Turn::SILENT;
                }
                let wrong = *wrong;
                let answer = answer_or_slip(domain.model, question, wanted, wrong, rng);
                Recogniser::BAD.hear(answer.text(domain.scene), domain.scene, rng).into()
            }
            (Traits::Talkative(manners), Some(wanted)) => {
                manners.speaker(domain, wanted, rng).answer(question)
            }
            (Traits::Truthful { by_value }, Some(wanted)) => {
                let by_value = chance(rng, *by_value);
                if let (Question::Attribute(k, _), true) = (question, by_value)
                    && let Some(v) = domain.model.value(wanted, k)
                {
                    let value = &domain.scene.attributes()[k.index()].values[v.index()];
                    return Turn::words(&format!("it is {}", value.spoken));
                }
                let answer = Answer::truthful(domain.model, question, wanted);
                Turn::words(answer.text(domain.scene))
            }
            // Nothing that the robot can name is true of an object that is not here.
            (_, None) => match question {
                Question::Point(_) | Question::Attribute(..) | Question::Choice(..) => {
                    Turn::words(Answer::No.text(domain.scene))
                }
                Question::Which(_) | Question::None => Turn::SILENT,
            },
        }
    }
}

/// The true answer, or with probability `slip` a wrong one.
fn answer_or_slip(
    model: &Model,
    question: Question,
    wanted: ObjectId,
    slip: f64,
    rng: &mut Rng,
) -> Answer {
    let truth = Answer::truthful(model, question, wanted);
    if !chance(rng, slip) {
        return truth;
    }
    let mut others = spoken_answers(model, question);
    others.retain(|answer| *answer != truth);
    // The true one without alternatives.
    one_of(rng, &others).copied().unwrap_or(truth)
}

/// One of the answers, right or wrong.
fn any_answer(model: &Model, question: Question, truth: Answer, rng: &mut Rng) -> Answer {
    one_of(rng, &spoken_answers(model, question)).copied().unwrap_or(truth)
}

fn spoken_answers(model: &Model, question: Question) -> Vec<Answer> {
    let mut all = Answer::possible(model, question);
    all.retain(|answer| *answer != Answer::Silence);
    all
}

#[cfg(test)]
mod tests;
