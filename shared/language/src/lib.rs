//! Natural-language understanding: from an utterance to its meaning for the objects of one scene.
//!
//! This crate is pure: no IO, no clock, no threads. Any text is read in time linear in its bounded
//! length, and nothing panics. The result depends on the utterance, the scene and the last question
//! alone.
//!
//! [`Reader`] reads in one of two languages. `Paper` spots words as section 3.6 of the publication
//! does. `Careful` runs a pipeline:
//!
//! | stage | file | output |
//! |---|---|---|
//! | normalise | `words` | plain lower-case text |
//! | tokenise | `words` | words and the pauses between them |
//! | halting words | `halting.rs` (`vocabulary/halting.txt`) | what halts the arm, whatever the scene |
//! | tag | `tagger.rs` (`disambiguate.rs`, `lexicon.rs`, `lookalikes.rs`, `morphology.rs`, `relations.rs`, `spelling.rs`, `vocabulary/`) | value or class of each word or phrase |
//! | judge | `features.rs`, `sequence.rs` (`word_groups.rs`), `judge.rs`, `recurrent.rs` (`vocabulary/judge.bin`), `mentions.rs` | how probable each value word is wanted, denied, neither |
//! | fates | `fates.rs` | ways to read the values, each with its probability; the rest is done for each way |
//! | clauses | `clauses.rs` (`topic.rs`, `asking_back.rs`, `errands.rs`), `hedges.rs` | the parts that are about the objects |
//! | content | `extractor.rs` (`content.rs`, `negation_scope.rs`, `negation.rs`) | values asserted, groups excluded, answers |
//! | answer, intent | `answer.rs` (`indifference.rs`), `intent.rs` (`questions.rs`), `references.rs`, `objects.rs` | the response that counts, the user's intent, what is referred to, each object asked for |
//! | readings | `parsed.rs`, `reader.rs` | alternative readings with weights and doubts |
//! | judge of answers | `answer_judge.rs` (`vocabulary/answer_judge.bin`) | how probable each answer to a question of yes or no is |
//!
//! [`CompletenessJudge`] judges whether a speaker will continue after a pause. [`words::confusion`]
//! gives the probabilities of mishearing one of a scene's words for another.
//!
//! Words that belong to a scene come from the scene; the English of a dialogue is data in
//! `vocabulary/`.
//!
//! # Example
//!
//! ```
//! use language::Reader;
//! use scene::{Question, Scene};
//! use vocabulary::Language;
//!
//! let scene = Scene::from_json(
//!     "markers",
//!     &serde_json::json!({
//!         "objects": [
//!             { "name": "left", "attributes": { "color": "red" } },
//!             { "name": "right", "attributes": { "color": "blue" } },
//!         ],
//!         "values": { "color": ["red", "blue"] },
//!     }),
//! )?;
//! let reader = Reader::new(&scene, Language::Careful);
//!
//! let reading = reader.read("the blue one please", Question::None);
//! assert_eq!(reading.base, [scene.word_named("blue").ok_or("blue")?]);
//!
//! // "not" excludes what it stands before.
//! let reading = reader.read("not the red one", Question::None);
//! assert_eq!(reading.excluded, [[scene.word_named("red").ok_or("red")?]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod answer_judge;
mod asking_back;
mod clauses;
mod closed_class;
mod completeness;
mod content;
mod disambiguate;
mod echo;
mod errands;
mod extractor;
mod fates;
mod features;
mod halting;
mod hedges;
mod indifference;
mod intent;
mod judge;
mod lexicon;
mod lookalikes;
mod mentions;
mod morphology;
mod negation;
mod negation_scope;
mod objects;
mod ordinals;
mod own_words;
mod paper;
mod parsed;
mod question_words;
mod questions;
mod read_back;
mod reader;
pub mod recurrent;
mod references;
mod related;
mod relation_words;
mod relations;
mod sequence;
mod spelling;
mod synonyms;
mod tagger;
mod token_class;
mod topic;
mod unknown;
mod vocabulary;
mod word_groups;

#[cfg(test)]
mod tests;

pub use answer_judge::{ANSWER_ROWS, ANSWERS, AnswerJudge, answers_trained_on};
pub use completeness::{Completeness, CompletenessJudge};
pub use echo::is_echo;
pub use fates::Polarity;
pub use features::{Example, Features, ROWS};
pub use halting::is_stop;
pub use judge::{FLOOR, Judge, NETWORKS, recurrent_sums, softmax, trained_on};
pub use mentions::Mention;
pub use parsed::READINGS_MAX;
pub use read_back::word_findings;
pub use reader::Reader;
pub use word_groups::words_of_group;
