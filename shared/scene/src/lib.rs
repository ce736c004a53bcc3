//! The scene: objects that can be requested, their attributes and values, and the words for them.
//!
//! This crate is pure: no IO, no clock, no threads. [`Scene::from_toml`] and [`Scene::from_json`]
//! parse text and report every problem of it at once. The types that language and dialogue share
//! are here as well: [`Question`] (section 3.2 of the publication) and [`Reading`], an understood
//! utterance (section 3.6).
//!
//! # Example
//!
//! ```
//! use scene::Scene;
//!
//! let file = r#"
//! name = "markers"
//! noun = "marker"
//! [[attributes]]
//! name = "color"
//! ask_yes_no = "Is it {value}?"
//! values = ["red", { name = "blue", synonyms = ["navy"] }]
//! [[objects]]
//! name = "left"
//! attributes = { color = "red" }
//! [[objects]]
//! name = "right"
//! attributes = { color = "blue" }
//! "#;
//! let scene = Scene::from_toml("markers.toml", file)?;
//! let (color, right) = (scene.attribute_named("color"), scene.object_named("right"));
//! let (color, right) = (color.ok_or("color")?, right.ok_or("right")?);
//! let blue = scene.value_named(color, "blue").ok_or("blue")?;
//! assert!(scene.has(right, color, blue));
//! assert_eq!(scene.describe(right), "blue marker");
//!
//! // Every problem comes with its place and a way out.
//! let wrong = Scene::from_toml("markers.toml", &file.replace("\"red\" }", "\"green\" }"));
//! assert!(wrong.is_err_and(|problems| problems.to_string().contains("green")));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod by_place;
mod check;
mod describe;
mod forms;
mod ids;
mod json;
mod model;
mod options;
mod perceived;
mod plural;
mod question;
mod question_json;
mod reading;
mod reading_text;
mod relation;
mod relation_truth;
mod role;
mod spoken;
mod stable_hash;
mod toml_form;
pub mod view;
mod wording;

#[cfg(test)]
mod tests;

pub use forms::definite;
pub use ids::{AttributeId, ObjectId, ValueId, WordId};
pub use model::{Attribute, Form, Object, Placement, Scene, Value};
pub use options::Options;
pub use perceived::{Perceived, likeliest};
pub use plural::{count, plural};
pub use question::Question;
pub use question_json::{QuestionError, question_from_json, question_to_json, reading_to_json};
pub use reading::{Doubt, Intent, Reading, Reference, Response, UnknownWord};
pub use relation::{Measure, Relation};
pub use relation_truth::{Related, View, size_rank};
pub use role::Role;
pub use spoken::{WordFindings, WordProblem};
pub use stable_hash::StableHash;
