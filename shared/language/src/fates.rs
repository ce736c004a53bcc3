//! From the judge's probabilities to the possible fates of an utterance's values.
//!
//! The values of one noun phrase share their fate: wanted, denied or neither. Each choice of a fate
//! for every phrase is one way to read the utterance, weighed by the judge's probabilities.

use scene::{Role, WordId};

use crate::features::{Example, Features, MENTIONS_MAX, features};
use crate::judge::{FLOOR, Judge};
use crate::question_words::QuestionWords;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// Probability from which the judge's statement is used without alternatives.
const SURE: f64 = 0.9;
/// All that can be said of a phrase.
const POLARITIES: [Polarity; 3] = [Polarity::Wanted, Polarity::Denied, Polarity::Neither];
/// Most phrases whose fate is open; that of the others, the surest, is their most probable one.
const OPEN_MAX: usize = 3;

/// Polarity of a value word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Polarity {
    /// The wanted object has the value.
    Wanted,
    /// The wanted object does not have it.
    Denied,
    /// Nothing about the wanted object.
    Neither,
}

/// Polarity of the value of each tag.
#[derive(Clone, Debug)]
pub(crate) struct Fates(Vec<Option<Polarity>>);

impl Fates {
    /// Nothing is said of any value.
    fn none(tags: &[Tag<'_>]) -> Self {
        Self(tags.iter().map(|tag| tag.value().map(|_| Polarity::Neither)).collect())
    }

    /// The values are those that are named, whatever is said of them: "which ones are not white".
    pub(crate) fn named(tags: &[Tag<'_>]) -> Self {
        let mut denies = false;
        let fate = |tag: &Tag<'_>| {
            let is_new = tag.pauses() || tag.is_any(classes![And But Join Fetch Want]);
            denies = !is_new && denies || tag.is_any(classes![Not No Except]);
            tag.value().map(|_| if denies { Polarity::Denied } else { Polarity::Wanted })
        };
        Self(tags.iter().map(fate).collect())
    }

    /// Returns the named things, except places among others: "put the bowl on the table".
    pub(crate) fn named_things(tags: &[Tag<'_>]) -> Self {
        let mut fates = Self::named(tags);
        if !tags.iter().any(|tag| tag.is_value() && !tag.is_role(Role::Place)) {
            return fates;
        }
        for (fate, _) in fates.0.iter_mut().zip(tags).filter(|(_, tag)| tag.is_role(Role::Place)) {
            *fate = Some(Polarity::Neither);
        }
        fates
    }

    /// Returns the polarity of a tag's value.
    pub(crate) fn of(&self, at: usize) -> Polarity {
        self.0[at].unwrap_or(Polarity::Neither)
    }

    /// Returns whether a tag is a value of which nothing is said.
    pub(crate) fn is_neither(&self, at: usize) -> bool {
        self.0[at] == Some(Polarity::Neither)
    }

    /// Returns whether there are values, and nothing is said of any.
    pub(crate) fn are_neither(&self) -> bool {
        self.0.iter().any(Option::is_some) && !self.are_wishes()
    }

    /// Returns whether a value is wanted or denied.
    pub(crate) fn are_wishes(&self) -> bool {
        self.0.iter().flatten().any(|fate| *fate != Polarity::Neither)
    }
}

/// A noun phrase with values.
struct Phrase {
    examples: Vec<Example>,
    stated: [f64; 3],
}

impl Phrase {
    fn best(&self) -> usize {
        best(&self.stated)
    }
}

fn best(stated: &[f64; 3]) -> usize {
    (0..3).max_by(|a, b| stated[*a].total_cmp(&stated[*b])).unwrap_or(0)
}

/// Returns the possible fates of an utterance's values after a question, each with probability.
pub(crate) fn fates(
    judge: &Judge,
    tags: &[Tag<'_>],
    asked: QuestionWords<'_>,
) -> Vec<(f64, Fates)> {
    let features = features(tags, asked);
    // So many values are a list, and no description.
    if features.examples.is_empty() || features.examples.len() >= MENTIONS_MAX {
        return vec![(1.0, Fates::none(tags))];
    }
    let phrases = phrases(tags, &judge.stated(&features), features);
    let mut ways = ways(&phrases);
    ways.retain(|(weight, _)| *weight > 0.0);
    if ways.iter().any(|(_, way)| !contradicts(&phrases, way)) {
        ways.retain(|(_, way)| !contradicts(&phrases, way));
    }
    let fates = |(weight, way): (f64, Vec<usize>)| {
        let mut fates = Fates::none(tags);
        for (phrase, polarity) in phrases.iter().zip(way) {
            let places = phrase.examples.iter().map(|example| example.at);
            places.for_each(|at| fates.0[at] = Some(POLARITIES[polarity]));
        }
        (weight, fates)
    };
    ways.into_iter().map(fates).collect()
}

/// The phrases, each with the judge's joint statement about its values. A phrase with different
/// statements about its values ("not white clear") is two; "white or clear" is one.
fn phrases(tags: &[Tag<'_>], stated: &[[f64; 3]], features: Features) -> Vec<Phrase> {
    let mut phrases: Vec<Phrase> = Vec::new();
    for (example, stated) in features.examples.into_iter().zip(stated) {
        let is_its = |it: &&mut Phrase| {
            let last = &it.examples[it.examples.len() - 1];
            let is_one = last.phrase == example.phrase || are_joined(tags, last.at, example.at);
            is_one && it.best() == best(stated)
        };
        match phrases.iter_mut().find(is_its) {
            Some(phrase) => {
                phrase.examples.push(example);
                phrase.stated.iter_mut().zip(stated).for_each(|(sum, stated)| *sum += stated);
            }
            None => phrases.push(Phrase { examples: vec![example], stated: *stated }),
        }
    }
    for phrase in &mut phrases {
        let count = phrase.examples.len() as f64;
        let [wanted, denied, neither] = phrase.stated.map(|sum| sum / count * (1.0 - FLOOR));
        phrase.stated = [wanted, denied, neither + FLOOR];
        let best = phrase.best();
        if phrase.stated[best] >= SURE {
            phrase.stated = [0.0; 3];
            phrase.stated[best] = 1.0;
        }
    }
    phrases
}

/// Only "or" stands between two values: "the white or the clear one".
fn are_joined(tags: &[Tag<'_>], one: usize, other: usize) -> bool {
    let between = tags.get(one + 1..other).unwrap_or_default();
    between.iter().any(|tag| tag.is(Class::Or))
        && between.iter().all(|tag| tag.is_any(classes![Or Determiner Preposition]))
}

/// Every choice of a polarity for each phrase, with its probability.
fn ways(phrases: &[Phrase]) -> Vec<(f64, Vec<usize>)> {
    let mut unsure: Vec<usize> = (0..phrases.len()).collect();
    let sure = |n: &usize| phrases[*n].stated[phrases[*n].best()];
    unsure.sort_by(|a, b| sure(a).total_cmp(&sure(b)));
    unsure.truncate(OPEN_MAX);
    let mut ways = vec![(1.0, Vec::new())];
    for (n, phrase) in phrases.iter().enumerate() {
        let open: Vec<usize> = match unsure.contains(&n) {
            true => vec![0, 1, 2],
            false => vec![phrase.best()],
        };
        let extended = |(weight, way): &(f64, Vec<usize>)| {
            let extend = |polarity: &usize| {
                let way = way.iter().copied().chain([*polarity]).collect();
                (weight * phrase.stated[*polarity], way)
            };
            open.iter().map(extend).collect::<Vec<_>>()
        };
        ways = ways.iter().flat_map(extended).collect();
    }
    ways
}

/// Whether a denied phrase has only words wanted elsewhere: "the red mug, no wait, the red cup".
fn contradicts(phrases: &[Phrase], way: &[usize]) -> bool {
    let of = |polarity: Polarity| {
        let has = move |it: &(&Phrase, &usize)| POLARITIES[*it.1] == polarity;
        phrases.iter().zip(way).filter(has).map(|(phrase, _)| phrase)
    };
    let is_wanted = |word: WordId| {
        of(Polarity::Wanted).any(|phrase| phrase.examples.iter().any(|it| it.word == word))
    };
    of(Polarity::Denied).any(|phrase| phrase.examples.iter().all(|it| is_wanted(it.word)))
}
