//! The reader: one utterance in, its meaning out.

use scene::{Intent, Question, Reading, Scene};

use crate::answer::response;
use crate::asked::Askable;
use crate::clauses::clauses;
use crate::heard::Heard;
use crate::hedges::hedge;
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
            Language::Careful => {
                let text = normalise(text);
                let tokens = Tokens::of(&text);
                let heard = self.listen(&tokens, last_question);
                Understood {
                    reading: heard.reading(),
                    unknown: unknown_words(&heard.marks, &heard.clauses),
                }
            }
        }
    }

    /// The ways in which an utterance that was said after `last_question` can be understood, each
    /// with its weight, best first; the weights sum to 1 and there are at most
    /// [`READINGS_MAX`](crate::READINGS_MAX). The first is what [`Self::read`] gives, but for its
    /// doubts.
    ///
    /// `confidence` says of each blank-separated word of the text how probable it is that it was
    /// said, 0 to 1; words beyond its end are certain. It becomes the doubt of the scene words,
    /// groups and answers that were read from them. The paper's language has one reading without
    /// doubt.
    pub fn readings(
        &self,
        text: &str,
        confidence: &[f32],
        last_question: Question,
    ) -> Vec<(f64, Reading)> {
        match self.language {
            Language::Paper => vec![(1.0, self.spotter.read(text))],
            Language::Careful => {
                let text = normalise(text);
                let tokens = Tokens::heard(&text, confidence);
                self.listen(&tokens, last_question).readings()
            }
        }
    }

    fn listen<'a>(&'a self, tokens: &Tokens<'a>, last_question: Question) -> Heard<'a> {
        let mut marks = marks(&self.lexicon, &tokens.words);
        let clauses = clauses(&self.lexicon, &marks, tokens.code);
        hedge(&mut marks, &clauses);
        let asked = self.askable.asked(last_question);
        let mut meaning = listen(&self.lexicon, &marks, &clauses, asked);
        let side_talk = meaning.base.is_empty()
            && meaning.excluded.is_empty()
            && is_side_talk(&marks, &clauses);
        if side_talk {
            meaning = Meaning::default();
        }
        let response = response(&meaning, &marks, asked);
        let intent = match intent(&marks, &clauses, &meaning, tokens.code) {
            Intent::Inform if side_talk => Intent::None,
            intent => intent,
        };
        Heard { meaning, response, intent, asked, marks, clauses }
    }
}
