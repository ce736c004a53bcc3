//! Statements of an utterance about each value word in it.

use ::vocabulary::Language;
use scene::{Question, WordId};
use words::{Tokens, normalise};

use crate::features::{Example, Features, features};
use crate::judge::FLOOR;
use crate::reader::Reader;

/// A value word of an utterance, and the probabilities of its polarities; they sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Mention {
    /// The scene's word behind the value word.
    pub word: WordId,
    /// The words as they were said, in plain lower case.
    pub surface: String,
    /// The wanted object has the value.
    pub wanted: f64,
    /// The wanted object does not have it.
    pub denied: f64,
    /// Nothing about the wanted object.
    pub neither: f64,
}

impl Reader {
    /// Returns the value words of an utterance that followed `last_question`, in order, with their
    /// polarities; none in the paper's language.
    pub fn mentions(&self, text: &str, last_question: Question) -> Vec<Mention> {
        if self.language() == Language::Paper {
            return Vec::new();
        }
        let features = self.features(text, last_question);
        let stated = self.judge().stated(&features);
        let mention = |(example, stated): (Example, [f64; 3])| {
            let [wanted, denied, neither] = stated.map(|it| it * (1.0 - FLOOR));
            let Example { word, surface, .. } = example;
            Mention { word, surface, wanted, denied, neither: neither + FLOOR }
        };
        features.examples.into_iter().zip(stated).map(mention).collect()
    }

    /// Returns the judge's features of an utterance that followed `last_question`.
    pub fn features(&self, text: &str, last_question: Question) -> Features {
        let text = normalise(text);
        let tokens = Tokens::of(&text);
        let heard = self.hear(&tokens, last_question);
        let mut features = features(&heard.tags, heard.asked);
        for example in &mut features.examples {
            let (tag, next) = (&heard.tags[example.at], heard.tags.get(example.at + 1));
            let end = next.map_or(tokens.words.len(), |next| next.at);
            let words = tokens.words[tag.at..end].iter().map(|token| token.word);
            example.surface = words.collect::<Vec<_>>().join(" ");
        }
        features
    }
}
