//! From what a person says to what is meant, for the objects of one scene.
//!
//! This crate is pure: no IO, no clock, no threads; any text is read in time linear in its length
//! (of which there is a bound) and nothing panics. The result depends on the utterance, the scene
//! and the last question alone.
//!
//! [`Reader`] reads in one of two languages. `Paper` spots words as section 3.6 of the paper does.
//! `Careful` runs a pipeline, one file per stage:
//!
//! | stage | file | gives |
//! |---|---|---|
//! | normalise | `normalise.rs` | plain lower-case text |
//! | tokens | `tokens.rs` | words and the pauses between them |
//! | marks | `marks.rs` (`settle.rs`, `lexicon.rs`, `forms.rs`, `spelling.rs`, `sound.rs`, `vocabulary/`) | the part that each word or phrase plays |
//! | clauses | `clauses.rs` (`topic.rs`, `aside.rs`) | which parts are about the objects |
//! | meaning | `meaning.rs` (`denial.rs`, `negation.rs`, `repair.rs`) | values asserted, groups ruled out, answers |
//! | answer, intent | `answer.rs`, `intent.rs` | the response that counts, what the person wants |
//! | readings | `heard.rs` (`hedges.rs`) | the ways to understand it, with weights and doubts |
//!
//! [`confusion`] says which of a scene's words are heard for one another.
//!
//! Words that belong to a scene come from the scene; words of English that hold a dialogue
//! together are data in `vocabulary/`.

mod answer;
mod aside;
mod asked;
mod clauses;
mod confusion;
mod cue;
mod denial;
mod forms;
mod heard;
mod hedges;
mod intent;
mod lexicon;
mod marks;
mod meaning;
mod negation;
mod normalise;
mod paper;
mod reader;
mod repair;
mod settle;
mod sound;
mod spelling;
mod tokens;
mod topic;
mod vocabulary;

#[cfg(test)]
mod tests;

pub use confusion::confusion;
pub use heard::READINGS_MAX;
pub use normalise::TEXT_CHARS_MAX;
pub use reader::{Language, Reader, Understood};
