//! What was said in the open interaction, in words in place of numbers: it outlives a change of the
//! scene, under which every object, attribute, value and word may get another number.

use crate::state::Interaction;
use dialogue::{NamedQuestion, NamedReading};
use scene::{Question, Reading, Response, Scene};
use serde::{Deserialize, Serialize};

/// Names and words that the evidence of one interaction may hold, all utterances together. Beyond
/// it the oldest utterance is forgotten: the belief keeps what it said, but a change of the scene
/// scores the objects without it. A dialogue of the usual length needs a tenth of it.
pub const NAMES_MAX: usize = 1024;
/// What an utterance costs besides its names.
const ENTRY: usize = 4;

/// What one utterance said about the wanted object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What it may mean and which question it answers then, with weights; the likeliest first.
    pub meant: Vec<(f64, NamedQuestion, NamedReading)>,
    /// A word that the scene did not have; may be empty. Another one may.
    pub unknown: String,
    /// The point that the person pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
}

impl Evidence {
    /// What it says in a scene, each reading as the answer to its question.
    pub fn in_scene(&self, scene: &Scene) -> Vec<(f64, Question, Reading)> {
        let meant = self.meant.iter();
        let mut heard: Vec<(f64, Question, Reading)> = meant
            .map(|(weight, asked, said)| (*weight, asked.question(scene), said.reading(scene)))
            .collect();
        // The unknown word is of the best reading. Whether it was denied is not known, so it counts
        // only where nothing was.
        if let (Some((_, _, best)), Some(word)) =
            (heard.first_mut(), scene.word_named(&self.unknown))
            && best.response != Response::No
            && best.excluded.is_empty()
        {
            best.base.push(word);
        }
        heard
    }

    fn names(&self) -> usize {
        let of =
            |(_, asked, said): &(f64, NamedQuestion, NamedReading)| asked.names() + said.names();
        ENTRY + self.meant.iter().map(of).sum::<usize>()
    }
}

impl Interaction {
    /// Keeps what an utterance said; beyond [`NAMES_MAX`] what was said first is forgotten.
    pub fn keep(&mut self, evidence: Evidence) {
        self.evidence.push(evidence);
        let mut names: usize = self.evidence.iter().map(Evidence::names).sum();
        while names > NAMES_MAX {
            names -= self.evidence.remove(0).names();
            self.forgotten += 1;
        }
    }
}
