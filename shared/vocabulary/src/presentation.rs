//! Questions as they were put to the user.

use scene::{AttributeId, Options, Question, Scene, ValueId};
use serde::{Deserialize, Serialize};

use crate::ids::PromptId;
use crate::time::Time;

/// One presentation of a prompt: a question is put to the user as often as it is repeated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Presentation {
    /// The prompt.
    pub prompt: PromptId,
    /// Number of the presentation of the prompt, from 1.
    pub number: u32,
    /// The question; [`Question::None`] for a remark.
    pub question: Question,
    /// Key of the scene whose objects and attributes the question is about.
    pub scene: u64,
    /// Start of the prompt's sound.
    pub began: Time,
    /// End or interruption of the prompt's sound; `None` while it plays.
    pub ended: Option<Time>,
    /// Whether it was said to its end.
    pub complete: bool,
}

/// A question by names instead of numbers: it outlives a change of the scene, under which every
/// object, attribute and value may get another number.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum NamedQuestion {
    /// No question.
    #[default]
    None,
    /// "This one?", about the object of that name.
    Point(String),
    /// "Is its k v?", with the names of k and v.
    Attribute(String, String),
    /// "What is its k?", with the name of k.
    Which(String),
    /// "v, w or x?", with the names of k and of the values.
    Choice(String, Vec<String>),
}

impl NamedQuestion {
    /// Returns the question by the scene's names.
    ///
    /// # Panics
    /// If the question is not about this scene.
    pub fn new(scene: &Scene, question: Question) -> Self {
        let attribute = |k: AttributeId| &scene.attributes()[k.index()];
        match question {
            Question::None => Self::None,
            Question::Point(object) => Self::Point(scene.object(object).name.clone()),
            Question::Attribute(k, v) => {
                let value = attribute(k).values[v.index()].name.clone();
                Self::Attribute(attribute(k).name.clone(), value)
            }
            Question::Which(k) => Self::Which(attribute(k).name.clone()),
            Question::Choice(k, options) => {
                let name = |v: &ValueId| attribute(k).values[v.index()].name.clone();
                let values = options.values().iter().map(name).collect();
                Self::Choice(attribute(k).name.clone(), values)
            }
        }
    }

    /// Returns the question in a scene. A question about something that the scene does not have
    /// becomes [`Question::None`]: its answer is equally likely whatever is wanted.
    pub fn question(&self, scene: &Scene) -> Question {
        let found = match self {
            Self::None => None,
            Self::Point(name) => scene.object_named(name).map(Question::Point),
            Self::Attribute(k, v) => scene.attribute_named(k).and_then(|k| {
                let value = scene.value_named(k, v)?;
                Some(Question::Attribute(k, value))
            }),
            Self::Which(k) => scene.attribute_named(k).map(Question::Which),
            Self::Choice(k, values) => scene.attribute_named(k).and_then(|k| {
                let values = values.iter().map(|v| scene.value_named(k, v));
                let options = Options::new(&values.collect::<Option<Vec<_>>>()?)?;
                Some(Question::Choice(k, options))
            }),
        };
        found.unwrap_or_default()
    }

    /// Returns the number of names it holds.
    pub fn names(&self) -> usize {
        match self {
            Self::None => 0,
            Self::Point(_) | Self::Which(_) => 1,
            Self::Attribute(..) => 2,
            Self::Choice(_, values) => 1 + values.len(),
        }
    }
}
