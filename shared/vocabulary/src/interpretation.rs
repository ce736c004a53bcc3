//! Interpretations of an utterance.

use scene::{Doubt, Reading, Response, Scene, WordId};
use serde::{Deserialize, Serialize};

/// One interpretation of an utterance, given the question that it answers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interpretation {
    /// Probability among the interpretations that answer the same question.
    pub weight: f64,
    /// The question that the reading answers, as an index into the presentations carried by the
    /// utterance; `None` if it answers no question.
    pub answers: Option<usize>,
    /// Content of the interpretation.
    pub reading: Reading,
}

/// A [`Reading`] by words instead of numbers: it outlives a change of the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NamedReading {
    /// The scene's words, as they were said.
    pub base: Vec<String>,
    /// The answer.
    pub response: Response,
    /// Groups of words; an object that has all words of a group is ruled out.
    pub excluded: Vec<Vec<String>>,
    /// Doubts about parts of the reading.
    pub doubt: Doubt,
}

impl NamedReading {
    /// Returns the reading by the scene's words.
    ///
    /// # Panics
    /// If the reading is not about this scene.
    pub fn new(scene: &Scene, reading: &Reading) -> Self {
        let names = |words: &[WordId]| -> Vec<String> {
            words.iter().map(|word| scene.words()[word.index()].clone()).collect()
        };
        Self {
            base: names(&reading.base),
            response: reading.response,
            excluded: reading.excluded.iter().map(|group| names(group)).collect(),
            doubt: reading.doubt.clone(),
        }
    }

    /// Returns the reading in a scene. A word that the scene does not have is true of no object,
    /// and so is a group that contains one.
    pub fn reading(&self, scene: &Scene) -> Reading {
        let word = |name: &String| scene.word_named(name);
        let base = self.base.iter().enumerate();
        let base = base.filter_map(|(at, name)| Some((word(name)?, self.doubt.of_word(at))));
        let groups = self.excluded.iter().enumerate();
        let groups = groups.filter_map(|(at, group)| {
            let words: Option<Vec<WordId>> = group.iter().map(word).collect();
            Some((words?, self.doubt.of_group(at)))
        });
        let (base, base_doubt) = base.unzip();
        let (excluded, excluded_doubt) = groups.unzip();
        let doubt =
            Doubt { base: base_doubt, excluded: excluded_doubt, response: self.doubt.response };
        Reading { base, response: self.response, excluded, doubt, ..Reading::default() }
    }

    /// Returns the number of words it holds.
    pub fn names(&self) -> usize {
        self.base.len() + self.excluded.iter().map(Vec::len).sum::<usize>()
    }
}
