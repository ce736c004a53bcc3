//! Evidence of an interaction by names instead of numbers: it outlives a change of the scene, under
//! which every object, attribute, value and word may get another number.

use scene::{Question, Reading, Response, Scene, UnknownWord};
use serde::{Deserialize, Serialize};
use vocabulary::{NamedQuestion, NamedReading};

use super::state::Interaction;

/// Names that the evidence of one interaction may hold, all utterances together. Beyond it the
/// oldest utterance is dropped: the belief keeps its content, but a change of the scene scores the
/// objects without it. A typical dialogue needs a tenth of it.
pub const NAMES_MAX: usize = 1024;
/// Cost of an utterance besides its names.
const ENTRY: usize = 4;

/// Content of one utterance about the wanted object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// Interpretations with the question that each answers and its weight, the likeliest first.
    pub interpretations: Vec<(f64, NamedQuestion, NamedReading)>,
    /// A word that the scene did not have. Another scene may have it.
    pub unknown: Option<UnknownWord>,
    /// The point that the user points at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Objects that it plainly refused or meant.
    pub mark: Option<Mark>,
}

/// Objects, by name, that the user refused, meant or described beyond the words of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Mark {
    /// Refused.
    Not(String),
    /// One of these is meant.
    OneOf(Vec<String>),
    /// How likely a relation would be said of each, as the scene was then.
    Likely {
        /// Likelihoods for the named objects.
        named: Vec<(String, f64)>,
        /// Likelihood for every other one.
        others: f64,
    },
    /// The utterance is an answer that a later one has replaced. It counts no longer, but still
    /// teaches about the person who gave it.
    Replaced,
}

/// Factor of a refused object: beyond compensation by any words.
const REFUSED: f64 = 1e-30;
/// Factor of objects that are not pointed to: beyond compensation by the words of one utterance.
const NOT_MEANT: f64 = 1e-9;

impl Mark {
    /// Returns the logarithm of its likelihood for each hypothesis.
    pub(super) fn log_likelihood(&self, scene: &Scene, hypotheses: usize) -> Vec<f64> {
        let factor = |i: usize| {
            let name = scene.objects().get(i).map(|object| &object.name);
            match self {
                Self::Not(refused) if name == Some(refused) => REFUSED,
                Self::OneOf(meant) if name.is_none_or(|name| !meant.contains(name)) => NOT_MEANT,
                Self::Not(_) | Self::OneOf(_) | Self::Replaced => 1.0,
                Self::Likely { named, others } => {
                    let of = |(known, _): &&(String, f64)| name == Some(known);
                    named.iter().find(of).map_or(*others, |(_, factor)| *factor)
                }
            }
        };
        (0..hypotheses).map(|i| factor(i).ln()).collect()
    }

    fn names(&self) -> usize {
        match self {
            Self::Not(_) => 1,
            Self::Replaced => 0,
            Self::OneOf(names) => names.len(),
            Self::Likely { named, .. } => named.len(),
        }
    }
}

impl Evidence {
    /// Returns whether it counts: no later one has replaced it.
    pub(super) fn counts(&self) -> bool {
        self.mark != Some(Mark::Replaced)
    }

    /// Returns the interpretations in a scene.
    pub fn in_scene(&self, scene: &Scene) -> Vec<(f64, Question, Reading)> {
        let of = |(weight, question, reading): &(f64, NamedQuestion, NamedReading)| {
            (*weight, question.question(scene), reading.reading(scene))
        };
        let mut all: Vec<(f64, Question, Reading)> = self.interpretations.iter().map(of).collect();
        // The unknown word belongs to the best reading. Whether it was negated is not known, so it
        // counts only if nothing was.
        let unknown = self.unknown.as_ref().and_then(|unknown| scene.word_named(&unknown.text));
        if let (Some((_, _, best)), Some(word)) = (all.first_mut(), unknown)
            && best.response != Response::No
            && best.excluded.is_empty()
        {
            best.base.push(word);
        }
        all
    }

    fn names(&self) -> usize {
        let of = |(_, question, reading): &(f64, NamedQuestion, NamedReading)| {
            question.names() + reading.names()
        };
        let marked = self.mark.as_ref().map_or(0, Mark::names);
        ENTRY + marked + self.interpretations.iter().map(of).sum::<usize>()
    }
}

impl Interaction {
    /// Returns the content of the utterances that count.
    pub(super) fn counting(&self) -> impl Iterator<Item = &Evidence> {
        self.evidence.iter().filter(|it| it.counts())
    }

    /// Adds the content of an utterance; beyond [`NAMES_MAX`] the oldest is dropped.
    pub fn remember(&mut self, evidence: Evidence) {
        self.evidence.push(evidence);
        let mut names: usize = self.evidence.iter().map(Evidence::names).sum();
        while names > NAMES_MAX {
            names -= self.evidence.remove(0).names();
            self.forgotten += 1;
        }
    }
}
