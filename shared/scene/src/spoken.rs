//! The phrases in which people name the values of a scene.

use crate::forms::definite;
use crate::{AttributeId, Role, Scene, Value, ValueId};

/// Findings of reading a scene's own words back; other crates pass in the reader.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WordFindings {
    /// Words that make the scene unusable.
    pub problems: Vec<WordProblem>,
    /// Ambiguities for a person in this scene, one sentence each.
    pub warnings: Vec<String>,
}

/// A name of a scene that is not understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WordProblem {
    /// Dotted key of the scene file, e.g. `attributes[0].values[2]`.
    pub key: String,
    /// The problem: expected and found.
    pub what: String,
    /// The fix.
    pub help: String,
}

impl Value {
    /// Returns a phrase with another name of the value in the place of its own: whole words alone
    /// ("colored red" has one "red").
    pub fn with_name(&self, phrase: &str, name: &str) -> String {
        let is_edge = |text: char| !text.is_alphanumeric();
        let (mut out, mut rest) = (String::new(), phrase);
        while let Some(at) = rest.find(&self.name).filter(|_| !self.name.is_empty()) {
            let (before, after) = (&rest[..at], &rest[at + self.name.len()..]);
            let begins = before.chars().next_back().or(out.chars().next_back()).is_none_or(is_edge);
            let ends = after.chars().next().is_none_or(is_edge);
            out.push_str(before);
            out.push_str(if begins && ends { name } else { &self.name });
            rest = after;
        }
        out + rest
    }
}

impl Scene {
    /// Returns the plain phrases that ask for things with a value, `name` being one of its names;
    /// the name alone is the first.
    pub fn requests(&self, value: &Value, name: &str) -> Vec<String> {
        let noun = self.noun();
        let after = value.with_name(&value.after_noun(), name);
        let forms: &[String] = &match value.role() {
            Role::Quality => {
                vec![format!("the {name} one"), format!("get me the {name} {noun}")]
            }
            Role::Kind => vec![
                format!("the {name}"),
                format!("could you bring the {name} over here"),
                format!("I need a {name} please"),
            ],
            Role::Part => vec![
                format!("get me the {name}"),
                format!("the one {after}"),
                format!("get me the {noun} {after}"),
            ],
            Role::Place => vec![format!("the one {after}"), format!("get me the {noun} {after}")],
        };
        let plain = [name.to_owned(), format!("it's {}", value.with_name(&value.spoken, name))];
        plain.into_iter().chain(forms.iter().cloned()).collect()
    }

    /// Returns the plain phrases that deny a value.
    pub fn denials(&self, value: &Value, name: &str) -> Vec<String> {
        let after = value.with_name(&value.after_noun(), name);
        match value.role() {
            Role::Quality => vec![format!("not the {name} one"), format!("anything but {name}")],
            Role::Kind => vec![format!("not the {name}"), format!("anything but the {name}")],
            Role::Part | Role::Place => vec![format!("not the one {after}")],
        }
    }

    /// Returns the phrase that requests a thing with these values.
    pub fn request_for(&self, values: &[(AttributeId, ValueId)]) -> String {
        format!("get me {}", definite(&self.compose(values)))
    }
}
