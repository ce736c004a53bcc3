//! The scene: the objects that can be asked for, their attributes and values, and the words that
//! people use for them.
//!
//! This crate is pure: no IO, no clock, no threads. It is read from text that somebody else loaded
//! ([`Scene::from_toml`], [`Scene::from_json`]) and reports every problem of that text at once.
//! It also holds the vocabulary that language and dialogue share: [`Question`] (what the robot
//! asks, section 3.2 of the paper) and [`Reading`] (what an utterance was understood to say,
//! section 3.6).

mod check;
mod describe;
mod ids;
mod json;
mod key;
mod model;
mod question;
mod question_json;
mod reading;
mod stable_hash;
mod toml_form;
mod wording;

#[cfg(test)]
mod tests;

pub use ids::{AttributeId, ObjectId, ValueId, WordId};
pub use model::{Attribute, Object, Placement, Role, Scene, Value};
pub use question::Question;
pub use question_json::{QuestionError, question_from_json, question_to_json, reading_to_json};
pub use reading::{Doubt, Intent, Reading, Response};
pub use stable_hash::StableHash;
