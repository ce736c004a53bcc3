//! Lesson of an interaction about the person who spoke, once the wanted object is known.
//!
//! Given the object `D`, the attributes are independent. For each of them the person takes its
//! value for `m` with `P(m | D)`, and every word and answer about it is right or a slip of that one
//! `m`. So `P(m | D, heard) ∝ P(m | D) Π_j P(o_j | m)` is exact, and from it follow the expected
//! numbers of slips and of values taken for another one: the E-step of EM under the rates that
//! held. Errors that either kind explains are shared by their prior odds.
//!
//! If an utterance has several readings, each counts by its probability given `D`. A word heard
//! with a doubt `d` counts as `1 − d` of an observation.

use scene::{AttributeId, ObjectId, Question, Reading, Response, WordId};
use serde::{Deserialize, Serialize};

use crate::observation::{log_mixture, named_answer};
use crate::speaker::Channel;
use crate::{CERTAIN_DOUBT, Model, Naming};

/// Expected numbers of wrong and right observations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Count {
    /// Wrong ones.
    pub wrong: f64,
    /// Right ones.
    pub right: f64,
}

impl Count {
    /// Number of all observations.
    pub fn all(&self) -> f64 {
        self.wrong + self.right
    }

    /// Posterior mean of the error rate; the prior is a beta distribution of mean `rate`, worth
    /// `strength` observations.
    pub fn mean(&self, rate: f64, strength: f64) -> f64 {
        (self.wrong + rate * strength) / (self.all() + strength)
    }

    pub(crate) fn add(&mut self, more: &Self) {
        self.wrong += more.wrong;
        self.right += more.right;
    }

    /// Counts a share of one, of which `wrong` is wrong.
    fn see(&mut self, share: f64, wrong: f64) {
        self.add(&Self { wrong: share * wrong, right: share * (1.0 - wrong) });
    }
}

/// Lesson of one interaction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lesson {
    /// Slips, by [`Channel`].
    pub channels: [Count; Channel::ALL.len()],
    /// Mistaken values by attribute; empty for attributes that were not mentioned, and for a person
    /// who never mistakes values.
    pub attributes: Vec<Count>,
}

impl Lesson {
    /// The lesson of an interaction in which that object was wanted: its utterances, each with the
    /// weights of its readings. `model` is that of the person until now.
    ///
    /// # Panics
    /// If anything is not about the model's scene.
    pub fn new<'a>(
        model: &Model,
        object: ObjectId,
        heard: impl Iterator<Item = &'a [(f64, Question, Reading)]>,
    ) -> Self {
        let attributes = vec![Count::default(); model.attributes()];
        let mut lesson = Self { attributes, ..Self::default() };
        let mut said: Vec<Vec<Said>> = (0..model.attributes()).map(|_| Vec::new()).collect();
        for utterance in heard {
            for (share, question, reading) in shares(model, object, utterance) {
                lesson.see_point(model, object, share, (question, reading));
                for (k, one) in all_said(model, question, reading) {
                    said[k.index()].push(Said { share, ..one });
                }
            }
        }
        for (k, said) in said.iter().enumerate().filter(|(_, said)| !said.is_empty()) {
            lesson.see_attribute(model, object, k.into(), said);
        }
        lesson
    }

    /// "This one?" is about the object itself, which is known.
    fn see_point(
        &mut self,
        model: &Model,
        object: ObjectId,
        share: f64,
        (question, reading): (Question, &Reading),
    ) {
        let yes = match reading.response {
            Response::Yes => true,
            Response::No => false,
            _ => return,
        };
        if let Question::Point(asked) = question {
            let doubt = reading.doubt.response;
            let chance = Chance::of_answer(model, doubt, yes == (asked == object));
            self.channels[Channel::YesNo as usize].see(share * (1.0 - doubt), chance.wrong());
        }
    }

    fn see_attribute(&mut self, model: &Model, object: ObjectId, k: AttributeId, said: &[Said]) {
        let entry = model.column(k)[object.index()];
        let chances: Vec<f64> = match (model.chances(k, entry), model.value(object, k)) {
            (Some(chances), _) => chances.to_vec(),
            (None, Some(own)) => {
                (0..model.values(k)).map(|m| f64::from(u8::from(m == own.index()))).collect()
            }
            (None, None) => Vec::new(),
        };
        let weight = |(m, chance): (usize, &f64)| {
            said.iter().fold(*chance, |p, one| p * one.by_value[m].likelihood.powf(one.share))
        };
        let weights: Vec<f64> = chances.iter().enumerate().map(weight).collect();
        let all: f64 = weights.iter().sum();
        for one in said {
            let wrong = if chances.is_empty() {
                one.lacking.wrong()
            } else {
                let of = |(weight, chance): (&f64, &Chance)| weight * chance.wrong();
                weights.iter().zip(&one.by_value).map(of).sum::<f64>() / all
            };
            self.channels[one.channel as usize].see(one.share * one.understood, wrong);
        }
        if let (true, Some(own)) = (model.misperceived(k) > 0.0, model.known(k, entry)) {
            let share = said.iter().map(|one| one.share * one.understood).fold(0.0, f64::max);
            self.attributes[k.index()].see(share, 1.0 - weights[own.index()] / all);
        }
    }
}

/// A word or an answer about an attribute.
struct Said {
    channel: Channel,
    /// Probability that the word was said.
    share: f64,
    /// 1 less the doubt.
    understood: f64,
    /// Chances by the value that the person perceives.
    by_value: Vec<Chance>,
    /// Chance for an object that lacks the attribute.
    lacking: Chance,
}

/// Likelihood of an observation.
#[derive(Clone, Copy)]
struct Chance {
    /// All.
    likelihood: f64,
    /// Part of the likelihood in which the person has slipped.
    slip: f64,
}

impl Chance {
    /// Chance of a yes, a no or a denial that is true or not.
    fn of_answer(model: &Model, doubt: f64, is_true: bool) -> Self {
        let epsilon = model.error_rate(0.0);
        // With a doubt either may have been said.
        let any = doubt / 2.0;
        let (own, slip) = if is_true {
            ((1.0 - doubt) * (1.0 - epsilon), any * epsilon)
        } else {
            ((1.0 - doubt) * epsilon, ((1.0 - doubt) + any) * epsilon)
        };
        Self { likelihood: own + any, slip }
    }

    /// Chance of an answer that names a value, or none.
    fn of_name(law: Naming, doubt: f64, is_true: Option<bool>) -> Self {
        let (epsilon, answers) = (1.0 - law.own, law.answers as f64);
        let (own, own_slip) = match is_true {
            Some(true) => (law.own, 0.0),
            Some(false) => (law.other, law.other),
            None => (law.lacking, law.lacking * epsilon),
        };
        let mix = |p: f64, any: f64| (1.0 - doubt) * p + doubt * any / answers;
        Self { likelihood: mix(own, 1.0), slip: mix(own_slip, epsilon) }
    }

    fn wrong(self) -> f64 {
        self.slip / self.likelihood
    }
}

/// Probability of each reading of an utterance given the object.
fn shares<'a>(
    model: &Model,
    object: ObjectId,
    utterance: &'a [(f64, Question, Reading)],
) -> Vec<(f64, Question, &'a Reading)> {
    let log = |one| log_mixture(model, std::slice::from_ref(one)).map(|log| log[object.index()]);
    let logs: Vec<Option<f64>> = utterance.iter().map(log).collect();
    let greatest = logs.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights = logs.iter().map(|log| log.map_or(0.0, |log| (log - greatest).exp()));
    let all: f64 = weights.clone().sum();
    let readings = utterance.iter().zip(weights).filter(|(_, weight)| *weight > 0.0);
    readings.map(|((_, question, reading), weight)| (weight / all, *question, reading)).collect()
}

/// Everything that a reading says about one attribute at a time.
fn all_said(model: &Model, question: Question, reading: &Reading) -> Vec<(AttributeId, Said)> {
    let mut all = Vec::new();
    let answer = named_answer(model, question, &reading.base);
    let law = Naming::of(model, question).filter(|law| law.answers > 1);
    let mut answering = answer.map(|(k, v)| model.word(k, v));
    let is_answer = |word: WordId| answer.is_some_and(|(k, v)| model.word(k, v) == word);
    for (at, &word) in reading.base.iter().enumerate() {
        let doubt = reading.doubt.of_word(at);
        if !is_answer(word) {
            all.extend(of_word(model, word, doubt));
        } else if let (Some(law), true) = (law, answering.take().is_some()) {
            all.extend(answer.map(|(k, v)| (k, named(model, law, Some(v), doubt))));
        }
    }
    for (at, group) in reading.excluded.iter().enumerate() {
        if let Some((k, v)) = only_meaning(model, group) {
            let is = |m: Option<usize>| m != Some(v);
            all.push((k, answered(model, k, reading.doubt.of_group(at), is)));
        }
    }
    let doubt = reading.doubt.response;
    match (question, reading.response) {
        (Question::Attribute(k, v), Response::Yes | Response::No) => {
            let yes = reading.response == Response::Yes;
            let is = |m: Option<usize>| (m == Some(v.index())) == yes;
            all.push((k, answered(model, k, doubt, is)));
        }
        (Question::Choice(k, _), Response::No) if answer.is_none() => {
            let law = law.filter(|law| law.neither);
            all.extend(law.map(|law| (k, named(model, law, None, doubt))));
        }
        _ => {}
    }
    all
}

fn said(
    model: &Model,
    k: AttributeId,
    (channel, doubt): (Channel, f64),
    of: impl Fn(Option<usize>) -> Chance,
) -> Said {
    let by_value = (0..model.values(k)).map(|m| of(Some(m))).collect();
    Said { channel, share: 1.0, understood: 1.0 - doubt, by_value, lacking: of(None) }
}

/// A yes, a no or a denial, and of which values it is true.
fn answered(
    model: &Model,
    k: AttributeId,
    doubt: f64,
    is_true: impl Fn(Option<usize>) -> bool,
) -> Said {
    said(model, k, (Channel::YesNo, doubt), |m| Chance::of_answer(model, doubt, is_true(m)))
}

fn named(model: &Model, law: Naming, named: Option<scene::ValueId>, doubt: f64) -> Said {
    said(model, law.attribute, (law.channel(), doubt), |m| {
        let entry = m.map_or(Model::LACKS, |m| m as u16);
        Chance::of_name(law, doubt, law.right(named, entry, None).map(|chance| chance == 1.0))
    })
}

/// A word by eq. (5): one of the object's own, or by its smoothing any word.
fn of_word(model: &Model, word: WordId, doubt: f64) -> Option<(AttributeId, Said)> {
    let (k, _) = only_meaning(model, &[word])?;
    let is_certain = doubt <= CERTAIN_DOUBT;
    let alpha = model.smoothing(is_certain);
    let mut own = vec![0.0; model.values(k)];
    let mut elsewhere = 0.0;
    for (u, share) in model.said_instead(word, doubt) {
        match model.meanings(u).iter().find(|(of, _)| *of == k) {
            Some((_, v)) => own[v.index()] += share,
            None => elsewhere += share * model.mean_word_chance(u),
        }
    }
    let channel = Channel::of_words(is_certain);
    let of = |m: Option<usize>| {
        let own = m.map_or(0.0, |m| own[m]);
        Chance { likelihood: own + elsewhere + alpha, slip: alpha }
    };
    Some((k, said(model, k, (channel, doubt), of)))
}

/// The attribute and value of a group of words, if it is one word with no other meaning.
fn only_meaning(model: &Model, group: &[WordId]) -> Option<(AttributeId, usize)> {
    let [word] = group else { return None };
    match model.meanings(*word) {
        [(k, v)] => Some((*k, v.index())),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
