//! The observation model, eq. (1)–(7), and its extensions.
//!
//! | heard | factor per object `D` | source |
//! |---|---|---|
//! | no base word | `1 − p_l` | eq. (4) |
//! | base words | `p_l · Π P(w∣D)`, one factor per word as often as it was said | eq. (4), (5) |
//! | yes or no, question `point` or `attr` | `p_l(1−ε)` if true of `D`, `p_l·ε` if not; neither: `1−p_l` | eq. (6), (7) |
//! | yes or no, nothing asked | `1/3` each | section 3.6.2 |
//! | a value, question `which k` | [`Naming`] in place of that word's factor | section 7's future work |
//! | an option, or no, question `choice k S` | the same, "no" being "none of these" | extension |
//! | yes or no, question `which k`; yes, question `choice k S` | `1/3` each: no answer to it | extension |
//! | excluded group | `ε` for an object that has all of its words, `1−ε` for others | extension |
//! | word doubted by `d` | `(1−d) P(w∣D) + d Σ_u κ(u∣w) P(u∣D)`, `κ` of [`Confusion`](crate::Confusion) | extension |
//! | answer or group doubted by `d` | `ε + d (1/2 − ε)` in place of `ε` | extension |
//! | value of `D` in doubt | the mixture over what it may be ([`crate::ValueLikelihoods`]) | extension |
//!
//! Words that are certain ([`CERTAIN_DOUBT`]) may have an `α` of their own
//! ([`Model::with_certain_words`]).
//!
//! A doubt is the probability that something else was said ([`scene::Doubt`]): misheard by a
//! recogniser, or uncertain to the person.

use std::borrow::Cow;

use scene::{AttributeId, ObjectId, Options, Question, Reading, Response, ValueId, WordId};
use vocabulary::{Params, Reliability};

use crate::Model;
use crate::speaker::Channel;
use crate::value_evidence::ValueEvidence;

/// Doubt up to which a word counts as certain: it was typed, or recognised beyond doubt.
pub const CERTAIN_DOUBT: f64 = 0.02;

/// `ln P(l_b, l_r | D, Q_t, Q_v)` of eq. (1) for every hypothesis `D`, in the model's order.
///
/// Equal entries are equal bit for bit, so an observation that says nothing about the objects is
/// recognised exactly.
///
/// # Panics
/// If the question or the reading is not about the model's scene.
pub fn log_likelihood(model: &Model, question: Question, reading: &Reading) -> Vec<f64> {
    let mut log = vec![0.0; model.hypotheses()];
    let constant = weigh(model, question, reading, &mut log);
    log.iter_mut().for_each(|entry| *entry += constant);
    log
}

/// `ln Σ_j w_j P(o_j | D, Q_j)` for every hypothesis: the words, or the question that they answer,
/// are uncertain. `None` if nothing has weight.
///
/// The weights are how probable it is that `o_j` was said, given the sound. A longer reading is a
/// rarer observation than a shorter one whatever is wanted, so the factor of its words is taken
/// relative to its mean over the hypotheses; else the shortest reading would always win. Answers
/// need no such thing: as many can be given to one question as to another.
///
/// # Panics
/// If a weight is negative or not finite, or anything is not about the model's scene.
pub(crate) fn log_mixture(model: &Model, heard: &[(f64, Question, Reading)]) -> Option<Vec<f64>> {
    let rows = weighty(heard).map(|(weight, question, reading)| {
        let mut log = vec![0.0; model.hypotheses()];
        add_words(model, *question, reading, &mut log);
        let mean = log.iter().map(|log| log.exp()).sum::<f64>() / log.len() as f64;
        let constant = add_response(model, *question, reading, &mut log) + weight.ln() - mean.ln();
        log.iter_mut().for_each(|log| *log += constant);
        log
    });
    rows.reduce(|mut mixture, row| {
        mixture.iter_mut().zip(row).for_each(|(sum, log)| *sum = log_add(*sum, log));
        mixture
    })
}

/// The hypotheses of a mixture that count.
///
/// # Panics
/// On the way, if a weight is negative or not finite.
pub(crate) fn weighty(
    heard: &[(f64, Question, Reading)],
) -> impl Iterator<Item = &(f64, Question, Reading)> {
    heard.iter().filter(|(weight, ..)| {
        assert!(weight.is_finite() && *weight >= 0.0, "{weight} is not a weight");
        *weight > 0.0
    })
}

/// `ln(e^a + e^b)` without overflow.
fn log_add(a: f64, b: f64) -> f64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    high + (low - high).exp().ln_1p()
}

/// Adds [`log_likelihood`] to every entry, but for a constant that is returned: one pass for each
/// informative word or answer. No entry rises.
pub(crate) fn weigh(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) -> f64 {
    assert!(model.contains(question), "{question:?} is not about this scene");
    assert_eq!(log.len(), model.hypotheses(), "belief and model are of one scene");
    add_words(model, question, reading, log) + add_response(model, question, reading, log)
}

/// Adds the likelihood of words about the object's own values.
fn add_words(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) -> f64 {
    let constant = add_base(model, question, reading, log);
    let is_of_value = |group: &[WordId]| match group {
        [word] => model.doubtful_attribute(*word).is_some(),
        _ => group.is_empty(),
    };
    let said = reading.excluded.iter().enumerate().filter(|(_, group)| !is_of_value(group));
    let constant = said.fold(constant, |constant, (at, group)| {
        constant + add_excluded(model, group, reading.doubt.of_group(at), log)
    });
    let attributes = (0..model.attributes()).map(AttributeId::from);
    attributes.filter(|k| model.is_doubtful(*k)).fold(constant, |constant, k| {
        let said = ValueEvidence::of_words(model, k, question, reading);
        constant + said.map_or(0.0, |said| said.weigh(model, k, log))
    })
}

/// How a person answers a question by naming a value: "what is its k?", or "v, w or x?".
///
/// The true answer is given with `1 − ε`, each other one with `ε/(m − 1)`, where `m` is the number
/// of answers: the values of `V_k`, or the options, and "none of these" unless every hypothesis has
/// one of them. Silence is `1 − p_l` as for every question.
///
/// An object that is not here, or that lacks the attribute of an open question, has no known true
/// answer; a user who wants it is taken to give any answer with the same probability. With one
/// value there is nothing to confuse it with, so `ε` plays no part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Naming {
    pub(crate) attribute: AttributeId,
    options: Option<Options>,
    /// Number of possible answers.
    pub answers: usize,
    /// Whether "none of these" is one of them.
    pub neither: bool,
    /// Probability of the true answer, given an answer.
    pub own: f64,
    /// Probability of one particular other answer, given an answer.
    pub other: f64,
    /// Probability of any one answer about an object whose true answer is not known.
    pub lacking: f64,
}

impl Naming {
    /// The answer model of an open or a choice question; `None` for other questions.
    pub fn of(model: &Model, question: Question) -> Option<Self> {
        let (attribute, options) = match question {
            Question::Which(k) => (k, None),
            Question::Choice(k, options) => (k, Some(options)),
            Question::None | Question::Point(_) | Question::Attribute(..) => return None,
        };
        let neither = options.is_some_and(|options| !model.all_have(attribute, options));
        let values = options.map_or(model.values(attribute), |options| options.values().len());
        let answers = values + usize::from(neither);
        let law = Self { attribute, options, answers, neither, own: 1.0, other: 0.0, lacking: 1.0 };
        if answers < 2 {
            return Some(law);
        }
        let (count, epsilon) = (answers as f64, model.params().of(question).epsilon);
        let (own, other, lacking) = (1.0 - epsilon, epsilon / (count - 1.0), 1.0 / count);
        Some(Self { own, other, lacking, ..law })
    }

    /// Channel of the question's answers.
    pub(crate) fn channel(&self) -> Channel {
        if self.options.is_some() { Channel::Choice } else { Channel::Open }
    }

    /// Returns the model if another answer may have been given with probability `doubt`.
    pub(crate) fn doubted(self, doubt: f64) -> Self {
        let any = 1.0 / self.answers as f64;
        let blend = |p: f64| if doubt > 0.0 { (1.0 - doubt) * p + doubt * any } else { p };
        Self { own: blend(self.own), other: blend(self.other), ..self }
    }

    /// Probability of naming the value, or no option, given an answer, for a user who wants an
    /// object with that entry in the model's column.
    pub fn answer(&self, model: &Model, named: Option<ValueId>, entry: u16) -> f64 {
        let chances = model.chances(self.attribute, entry);
        self.right(named, entry, chances).map_or(self.lacking, |chance| self.mixture(chance))
    }

    /// Probability that the answer is true of an entry of the column, or of a value with these
    /// probabilities; `None` if unknown.
    pub(crate) fn right(
        &self,
        named: Option<ValueId>,
        entry: u16,
        chances: Option<&[f64]>,
    ) -> Option<f64> {
        let chance = |v: ValueId| match chances {
            Some(chances) => chances[v.index()],
            None => f64::from(u8::from(entry == v.0)),
        };
        let is_unknown = entry == Model::UNKNOWN || entry == Model::LACKS && self.options.is_none();
        let of_options = || {
            let options = self.options.iter().flat_map(|options| options.values());
            options.map(|v| chance(*v)).sum::<f64>()
        };
        (!is_unknown).then(|| named.map_or_else(|| (1.0 - of_options()).max(0.0), chance))
    }

    /// Probability of naming the value, or no option, for an object of value `m`.
    pub(crate) fn of_value(&self, named: Option<ValueId>, m: ValueId) -> f64 {
        self.right(named, m.0, None).map_or(self.lacking, |chance| self.mixture(chance))
    }

    /// Probability of naming the value for an object without the attribute, and for the absent one.
    pub(crate) fn without_value(&self, named: Option<ValueId>) -> [f64; 2] {
        [Model::LACKS, Model::UNKNOWN].map(|entry| self.of_value(named, ValueId(entry)))
    }

    /// Probability of naming the value if the answer is true with the given probability.
    fn mixture(&self, chance: f64) -> f64 {
        chance * self.own + (1.0 - chance) * self.other
    }
}

/// The value that answers an open or a choice question: the only value named, if it is an option.
/// "On the counter or in the cabinet" is not an answer, but its words still count.
pub(crate) fn named_answer(
    model: &Model,
    question: Question,
    base: &[WordId],
) -> Option<(AttributeId, ValueId)> {
    let (k, options) = match question {
        Question::Which(k) => (k, None),
        Question::Choice(k, options) => (k, Some(options)),
        Question::None | Question::Point(_) | Question::Attribute(..) => return None,
    };
    let mut named = base.iter().flat_map(|&word| model.meanings(word)).filter(|(of, _)| *of == k);
    let &answer = named.next()?;
    let is_option = options.is_none_or(|options| options.contains(answer.1));
    (is_option && named.all(|&again| again == answer)).then_some(answer)
}

/// Eq. (4) and (5), with the value that answers a question in place of its word's own factor.
fn add_base(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) -> f64 {
    if reading.base.is_empty() {
        return (1.0 - model.params().p_l).ln();
    }
    let mut constant = model.params().p_l.ln();
    let answer = named_answer(model, question, &reading.base);
    let answering = answer.map(|(k, v)| model.word(k, v));
    let plain = answer.filter(|(k, _)| !model.is_doubtful(*k));
    if let (Some((_, v)), Some(law)) = (plain, Naming::of(model, question)) {
        let said = reading.base.iter().position(|word| Some(*word) == answering);
        let law = law.doubted(reading.doubt.of_word(said.unwrap_or(0)));
        constant += add_named(model, law, Some(v), None, log);
    }
    for (at, &word) in reading.base.iter().enumerate() {
        if Some(word) != answering {
            let doubt = reading.doubt.of_word(at);
            constant += match doubt {
                _ if model.doubtful_attribute(word).is_some() => {
                    model.add_vocabulary(doubt <= CERTAIN_DOUBT, log)
                }
                0.0 => model.add_log_word(word, log),
                doubt => model.add_doubted_word(word, doubt, log),
            };
        }
    }
    constant
}

/// Adds the factor of an answer that names a value, or no option. `said` are further words about
/// the same value.
fn add_named(
    model: &Model,
    law: Naming,
    named: Option<ValueId>,
    said: Option<&ValueEvidence>,
    log: &mut [f64],
) -> f64 {
    let k = law.attribute;
    let column = model.column(k);
    if !model.is_doubtful(k) && column.iter().all(|entry| *entry == column[0]) {
        return law.answer(model, named, column[0]).ln();
    }
    let constant = law.own.ln();
    let of = |right: Option<f64>| match right {
        Some(1.0) => 0.0,
        right => right.map_or(law.lacking, |chance| law.mixture(chance)).ln() - constant,
    };
    let in_doubt = |chances: &[f64]| {
        let chances = said.map_or(Cow::Borrowed(chances), |said| said.condition(chances).into());
        of(law.right(named, Model::DOUBTFUL, Some(&chances)))
    };
    let [lacks, unknown] =
        [Model::LACKS, Model::UNKNOWN].map(|entry| of(law.right(named, entry, None)));
    let other = law.other.ln() - constant;
    let without = |value| if value == Model::LACKS { lacks } else { unknown };
    match (named, law.options) {
        (Some(v), _) => {
            let known = |value| match value {
                Model::LACKS | Model::UNKNOWN => without(value),
                own if own == v.0 => 0.0,
                _ => other,
            };
            add_by_value(model, k, log, known, in_doubt);
        }
        (None, Some(options)) => {
            let known = |value| match value {
                Model::LACKS | Model::UNKNOWN => without(value),
                value if options.contains(ValueId(value)) => other,
                _ => 0.0,
            };
            add_by_value(model, k, log, known, in_doubt);
        }
        (None, None) => {}
    }
    constant
}

/// Adds to every entry the term for the hypothesis's value of attribute `k`: `known` of its entry
/// in the column, or `in_doubt` of the probabilities of its values.
fn add_by_value(
    model: &Model,
    k: AttributeId,
    log: &mut [f64],
    known: impl Fn(u16) -> f64,
    in_doubt: impl Fn(&[f64]) -> f64,
) {
    let entries = log.iter_mut().zip(model.column(k));
    if model.is_doubtful(k) {
        for (entry, &value) in entries {
            *entry += model.chances(k, value).map_or_else(|| known(value), &in_doubt);
        }
    } else {
        // Without a search in each step the compiler takes several at a time.
        entries.for_each(|(entry, &value)| *entry += known(value));
    }
}

/// An error rate of one half is uninformative, and results from a doubt of 1.
fn doubted(params: Reliability, doubt: f64) -> Reliability {
    Reliability { epsilon: params.epsilon + doubt * (0.5 - params.epsilon), ..params }
}

impl Model {
    /// Probability that an answer or a denial is wrong which was something else with probability
    /// `doubt`.
    pub(crate) fn error_rate(&self, doubt: f64) -> f64 {
        {
            let Params { p_l, epsilon, .. } = self.params();
            doubted(Reliability { p_l, epsilon }, doubt).epsilon
        }
    }
}

/// Eq. (6) and (7), and "none of these".
fn add_response(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) -> f64 {
    let params = doubted(model.params().of(question), reading.doubt.response);
    let response = reading.response;
    let yes = match (question, response) {
        (Question::Choice(..), Response::No) => return add_neither(model, question, reading, log),
        (Question::None | Question::Which(_) | Question::Choice(..), _) => {
            return (1.0_f64 / 3.0).ln();
        }
        (_, Response::None | Response::CannotTell | Response::DoesNotMatter) => {
            return (1.0 - params.p_l).ln();
        }
        (_, response) => response == Response::Yes,
    };
    let right = (params.p_l * (1.0 - params.epsilon)).ln();
    let odds = (params.epsilon / (1.0 - params.epsilon)).ln();
    let (if_true, if_false) = if yes { (0.0, odds) } else { (odds, 0.0) };
    match question {
        Question::Attribute(k, v) if !model.splits(k, v) => {
            right + if model.has(ObjectId(0), k, v) { if_true } else { if_false }
        }
        Question::Attribute(k, v) => {
            let known = |value| if value == v.0 { if_true } else { if_false };
            // The other words of an answer are about the same value.
            let said = ValueEvidence::of_words(model, k, question, reading);
            add_by_value(model, k, log, known, |chances| {
                let chance =
                    said.as_ref().map_or(chances[v.index()], |it| it.condition(chances)[v.index()]);
                mixture(chance, if_true, if_false)
            });
            if let Some(absent) = model.absent() {
                let unknown = model.unknown_yes(k);
                let unknown_share = params.p_l * if yes { unknown } else { 1.0 - unknown };
                log[absent.index()] += unknown_share.ln() - right - if_false;
            }
            right
        }
        Question::Point(_) if log.len() == 1 => right + if_true,
        Question::Point(asked) => {
            let own = log[asked.index()];
            if yes {
                log.iter_mut().for_each(|entry| *entry += odds);
            }
            log[asked.index()] = own + if_true;
            right
        }
        Question::None | Question::Which(_) | Question::Choice(..) => 0.0,
    }
}

/// "No" to a choice. A value named instead counts as an option, or by its own word.
fn add_neither(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) -> f64 {
    let heard = model.params().of(question).p_l.ln();
    match Naming::of(model, question) {
        Some(law) if law.neither && named_answer(model, question, &reading.base).is_none() => {
            let said = ValueEvidence::of_words(model, law.attribute, question, reading);
            heard + add_named(model, law.doubted(reading.doubt.response), None, said.as_ref(), log)
        }
        _ => heard,
    }
}

/// "Not the small white one": an error of the person's or of the listening is as likely as in an
/// answer.
fn add_excluded(model: &Model, group: &[WordId], doubt: f64, log: &mut [f64]) -> f64 {
    let chance =
        |i: usize| -> f64 { group.iter().map(|&word| model.word_chance(i.into(), word)).product() };
    let epsilon = doubted(model.params().of(Question::None), doubt).epsilon;
    let constant = (1.0 - epsilon).ln();
    let factor = epsilon.ln() - constant;
    if (0..log.len()).all(|i| chance(i) == 1.0) {
        return constant + factor;
    }
    for (i, entry) in log.iter_mut().enumerate() {
        *entry += mixture(chance(i), factor, 0.0);
    }
    constant
}

/// `ln(p e^a + (1−p) e^b)`, where `p` may be certain.
fn mixture(p: f64, a: f64, b: f64) -> f64 {
    match p {
        0.0 => b,
        1.0 => a,
        _ => (p * a.exp() + (1.0 - p) * b.exp()).ln(),
    }
}

#[cfg(test)]
mod tests;
