//! The reader: one utterance in, its meaning out.

use scene::{Question, Reading, Response, Scene};

use crate::answer::response;
use crate::asked::Askable;
use crate::clauses::clauses;
use crate::intent::{intent, is_side_talk, unknown_words};
use crate::lexicon::Lexicon;
use crate::marks::marks;
use crate::meaning::{Meaning, listen};
use crate::normalise::normalise;
use crate::paper::WordSpotter;
use crate::tokens::Tokens;

/// How utterances are read.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// Word spotting, exactly as in section 3.6 of the paper.
    Paper,
    /// What a careful listener takes: synonyms, negation with scope, repairs, intents.
    #[default]
    Careful,
}

/// An utterance understood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Understood {
    /// What it says.
    pub reading: Reading,
    /// Attribute and object words that the scene lacks, as said; for the robot's reply, not for
    /// the belief.
    pub unknown: Vec<String>,
}

/// Reads utterances about one scene. Holds all that it needs of the scene.
#[derive(Clone, Debug)]
pub struct Reader {
    language: Language,
    spotter: WordSpotter,
    lexicon: Lexicon,
    askable: Askable,
}

impl Reader {
    /// Prepares for a scene.
    pub fn new(scene: &Scene, language: Language) -> Self {
        Self {
            language,
            spotter: WordSpotter::new(scene),
            lexicon: Lexicon::new(scene),
            askable: Askable::new(scene),
        }
    }

    /// The language that it reads.
    pub fn language(&self) -> Language {
        self.language
    }

    /// Reads an utterance that was said after `last_question`. Any text is an utterance; of one
    /// longer than [`TEXT_CHARS_MAX`](crate::TEXT_CHARS_MAX) characters the rest is not read.
    pub fn read(&self, text: &str, last_question: Question) -> Understood {
        match self.language {
            Language::Paper => Understood { reading: self.spotter.read(text), unknown: Vec::new() },
            Language::Careful => self.read_carefully(text, last_question),
        }
    }

    fn read_carefully(&self, text: &str, last_question: Question) -> Understood {
        let text = normalise(text);
        let tokens = Tokens::of(&text);
        let marks = marks(&self.lexicon, &tokens.words);
        let clauses = clauses(&self.lexicon, &marks, tokens.code);
        let asked = self.askable.asked(last_question);
        let mut meaning = listen(&self.lexicon, &marks, &clauses, asked);
        let side_talk = meaning.base.is_empty()
            && meaning.excluded.is_empty()
            && is_side_talk(&marks, &clauses);
        if side_talk {
            meaning = Meaning::default();
        }
        let certain = !meaning.hedged && !meaning.alternatives;
        let response = response(&meaning.answers, &marks, &meaning.base, asked, certain);
        let intent = match intent(&marks, &clauses, &meaning, tokens.code) {
            scene::Intent::Inform if side_talk => scene::Intent::None,
            intent => intent,
        };
        Understood {
            reading: Reading {
                base: meaning.base.iter().map(|value| value.word).collect(),
                response: if intent == scene::Intent::None { Response::None } else { response },
                excluded: meaning.excluded,
                intent,
                ..Reading::default()
            },
            unknown: unknown_words(&marks, &clauses),
        }
    }
}
