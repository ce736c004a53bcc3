//! Questions and actions in the scene's names, as pages and journals' text show them.

use scene::{Question, Scene, ValueId};
use serde::{Deserialize, Serialize};

use crate::Action;

/// A question, in the scene's names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum QuestionView<Name> {
    /// No question.
    None,
    /// "Is it this one?"
    Point {
        /// The object's name.
        object: Name,
    },
    /// "Is it white?"
    Attr {
        /// The attribute's name.
        attribute: Name,
        /// The value's name.
        value: Name,
    },
    /// "What colour is it?"
    Which {
        /// The attribute's name.
        attribute: Name,
    },
    /// "White, metallic or clear?"
    Choice {
        /// The attribute's name.
        attribute: Name,
        /// The values' names.
        values: Vec<Name>,
    },
}

/// Returns answers that fit a question; none where it is not of this scene.
pub fn options(scene: &Scene, question: Question) -> Vec<&str> {
    let attributes = scene.attributes();
    let mut options: Vec<&str> = match question {
        Question::None => return Vec::new(),
        _ if !scene.contains(question) => return Vec::new(),
        Question::Point(_) | Question::Attribute(..) => vec!["yes", "no"],
        Question::Which(k) => {
            attributes[k.index()].values.iter().map(|value| value.spoken.as_str()).collect()
        }
        Question::Choice(k, options) => {
            let values = &attributes[k.index()].values;
            options.values().iter().map(|v| values[v.index()].spoken.as_str()).collect()
        }
    };
    options.push("I don't know");
    options
}

/// An action, in the scene's names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ActionView<Name> {
    /// Do nothing for a turn.
    Wait,
    /// Fetch an object.
    Pick {
        /// The object's name.
        object: Name,
    },
    /// Conclude that the wanted object is not here.
    NotHere,
    /// Ask a question.
    #[serde(untagged)]
    Ask(QuestionView<Name>),
}

impl<'a, Name: From<&'a str>> ActionView<Name> {
    /// Names an action's parts.
    pub fn new(scene: &'a Scene, action: Action) -> Self {
        match action {
            Action::Wait => Self::Wait,
            Action::Pick(object) => match scene.objects().get(object.index()) {
                Some(object) => Self::Pick { object: object.name.as_str().into() },
                None => Self::NotHere,
            },
            Action::Ask(question) => {
                Self::Ask(QuestionView::new(scene, question).unwrap_or(QuestionView::None))
            }
        }
    }
}

impl<'a, Name: From<&'a str>> QuestionView<Name> {
    /// Names a question's parts; none where it is not of this scene.
    pub fn new(scene: &'a Scene, question: Question) -> Option<Self> {
        scene.contains(question).then(|| match question {
            Question::None => Self::None,
            Question::Point(object) => {
                Self::Point { object: scene.object(object).name.as_str().into() }
            }
            Question::Attribute(attribute, value) => {
                let attribute = &scene.attributes()[attribute.index()];
                Self::Attr {
                    attribute: attribute.name.as_str().into(),
                    value: attribute.values[value.index()].name.as_str().into(),
                }
            }
            Question::Which(attribute) => Self::Which {
                attribute: scene.attributes()[attribute.index()].name.as_str().into(),
            },
            Question::Choice(attribute, options) => {
                let attribute = &scene.attributes()[attribute.index()];
                let name = |v: &ValueId| attribute.values[v.index()].name.as_str().into();
                Self::Choice {
                    attribute: attribute.name.as_str().into(),
                    values: options.values().iter().map(name).collect(),
                }
            }
        })
    }
}
