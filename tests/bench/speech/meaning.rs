//! Comparison of the intended meaning with the understood one.

use super::corpus::Sentence;
use ::speech::Hypothesis;
use dialogue::{Belief, Model};
use language::Reader;
use scene::{Intent, Reading, Response, WordId};
use std::collections::{BTreeMap, BTreeSet};

/// The meaning of an utterance, as far as it affects the robot.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Meaning {
    base: BTreeSet<WordId>,
    excluded: BTreeSet<BTreeSet<WordId>>,
    /// 0 none, 1 yes, 2 no.
    answer: u8,
    /// 0 a statement, or nothing; else what the robot is to do.
    order: u8,
}

impl Meaning {
    pub(super) fn of(reading: &Reading) -> Self {
        let group = |words: &Vec<WordId>| words.iter().copied().collect();
        Self {
            base: reading.base.iter().copied().collect(),
            excluded: reading.excluded.iter().map(group).collect(),
            answer: match reading.response {
                Response::None => 0,
                Response::Yes => 1,
                Response::No => 2,
            },
            order: match reading.intent {
                Intent::Inform | Intent::None => 0,
                Intent::Stop => 1,
                Intent::Cancel => 2,
                Intent::Repeat => 3,
                Intent::StartOver => 4,
                Intent::AskBack => 5,
            },
        }
    }

    /// Returns whether the robot reacts to it.
    pub(super) fn is_acted_on(&self) -> bool {
        *self != Self::default()
    }

    /// Returns true if values and answer are the same, however the values are connected: word spotting's
    /// measure.
    pub(super) fn values(&self) -> (BTreeSet<WordId>, u8) {
        let excluded = self.excluded.iter().flatten();
        (self.base.iter().chain(excluded).copied().collect(), self.answer)
    }
}

pub(super) fn meaning(reader: &Reader, sentence: &Sentence, text: &str) -> Meaning {
    Meaning::of(&reader.read(text, sentence.question))
}

/// The meaning with the largest sum of weights, and its share of all weight. The earlier
/// hypothesis decides a tie.
pub(super) fn weightiest(
    reader: &Reader,
    sentence: &Sentence,
    hypotheses: &[Hypothesis],
) -> (Meaning, f64) {
    let mut sums: BTreeMap<Meaning, f64> = BTreeMap::new();
    let mut order = Vec::new();
    for hypothesis in hypotheses {
        let meant = meaning(reader, sentence, &hypothesis.text);
        *sums.entry(meant.clone()).or_default() += hypothesis.weight;
        order.push(meant);
    }
    let total: f64 = sums.values().sum();
    let heavier = |best: Option<(Meaning, f64)>, meant: Meaning| match (best, sums[&meant]) {
        (Some((best, weight)), other) if weight >= other => Some((best, weight)),
        (_, weight) => Some((meant, weight)),
    };
    let (meant, weight) = order.into_iter().fold(None, heavier).unwrap_or_default();
    (meant, weight / total.max(f64::MIN_POSITIVE))
}

/// The objects that are likeliest after hearing the readings as a mixture, from an even prior.
pub(super) fn likeliest(
    model: &Model,
    reader: &Reader,
    sentence: &Sentence,
    heard: &[(f64, &str)],
) -> BTreeSet<usize> {
    let mut belief = Belief::uniform(model.objects());
    let read = |(weight, text): &(f64, &str)| {
        (*weight, sentence.question, reader.read(text, sentence.question))
    };
    belief.update_mixture(model, &heard.iter().map(read).collect::<Vec<_>>());
    let probabilities = belief.probabilities();
    let top = probabilities.iter().copied().fold(0.0, f64::max);
    (0..probabilities.len()).filter(|&i| probabilities[i] > top * (1.0 - 1e-6)).collect()
}

/// Edits (words put in, left out, replaced) that turn `heard` into `said`, of scene words alone.
pub(super) fn edits(said: &[WordId], heard: &[WordId]) -> usize {
    let mut row: Vec<usize> = (0..=heard.len()).collect();
    for (i, word) in said.iter().enumerate() {
        let mut corner = i;
        row[0] = i + 1;
        for (j, other) in heard.iter().enumerate() {
            let replaced = corner + usize::from(word != other);
            corner = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(corner + 1);
        }
    }
    row[heard.len()]
}

/// Marks the words of `heard` that were said: those of the longest sequence of words that both texts
/// have in common.
pub(super) fn said_too(heard: &[&str], said: &[&str]) -> Vec<bool> {
    let width = said.len() + 1;
    let mut common = vec![0_usize; (heard.len() + 1) * width];
    for (i, j) in (0..heard.len()).rev().flat_map(|i| (0..said.len()).rev().map(move |j| (i, j))) {
        common[i * width + j] = match heard[i] == said[j] {
            true => common[(i + 1) * width + j + 1] + 1,
            false => common[(i + 1) * width + j].max(common[i * width + j + 1]),
        };
    }
    let (mut i, mut j) = (0, 0);
    let mut right = vec![false; heard.len()];
    while i < heard.len() && j < said.len() {
        if heard[i] == said[j] {
            right[i] = true;
            (i, j) = (i + 1, j + 1);
        } else if common[(i + 1) * width + j] >= common[i * width + j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    right
}
