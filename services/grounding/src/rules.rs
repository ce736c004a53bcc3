//! The rules of `language` as a grounder.

use language::Reader;
use messages::Hypothesis;
use scene::{Question, Reading, Scene, UnknownWord};
use whichone_sdk::grounding::Grounder;

/// Reads by the rules of this reader.
pub(crate) struct Rules<'a>(pub(crate) &'a Reader);

impl Grounder for Rules<'_> {
    fn read(
        &mut self,
        heard: &Hypothesis,
        question: Question,
        _scene: &Scene,
    ) -> Vec<(f64, Reading)> {
        self.0.readings(&heard.text, &heard.word_confidence, question)
    }

    fn unknown(
        &mut self,
        best: &Hypothesis,
        question: Question,
        _scene: &Scene,
    ) -> Option<UnknownWord> {
        self.0.unknown_word(&best.text, question)
    }
}
