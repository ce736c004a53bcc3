//! Comparison of the intended meaning with the understood one.

use super::corpus::Sentence;
use ::speech::Hypothesis;
use language::Reader;
use scene::{Intent, Reading, Response, WordId};
use std::collections::BTreeSet;

/// The meaning of an utterance, as far as it affects the robot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Meaning {
    base: BTreeSet<WordId>,
    excluded: BTreeSet<BTreeSet<WordId>>,
    answer: Response,
    /// The robot's task; a statement is none.
    order: Intent,
}

impl Meaning {
    fn of(reading: &Reading) -> Self {
        let group = |words: &Vec<WordId>| words.iter().copied().collect();
        Self {
            base: reading.base.iter().copied().collect(),
            excluded: reading.excluded.iter().map(group).collect(),
            answer: reading.response,
            order: match reading.intent {
                Intent::None => Intent::Inform,
                order => order,
            },
        }
    }

    /// Returns whether the robot reacts to it.
    pub(super) fn is_acted_on(&self) -> bool {
        *self != Self::default()
    }
}

pub(super) fn meaning(reader: &Reader, sentence: &Sentence, text: &str) -> Meaning {
    Meaning::of(&reader.read(text, sentence.question))
}

/// The meaning with the largest sum of weights. The earlier hypothesis decides a tie.
pub(super) fn weightiest(reader: &Reader, sentence: &Sentence, heard: &[Hypothesis]) -> Meaning {
    let mut sums: Vec<(Meaning, f64)> = Vec::new();
    for hypothesis in heard {
        let meant = meaning(reader, sentence, &hypothesis.text);
        match sums.iter_mut().find(|(known, _)| *known == meant) {
            Some((_, sum)) => *sum += hypothesis.weight,
            None => sums.push((meant, hypothesis.weight)),
        }
    }
    // The last of equals is the maximum.
    let best = sums.into_iter().rev().max_by(|(_, a), (_, b)| a.total_cmp(b));
    best.map(|(meant, _)| meant).unwrap_or_default()
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
