//! Attributes that the user does not know or does not care about.

use scene::{AttributeId, Question, Reading, Reference, Response, Scene};
use serde::{Deserialize, Serialize};

use super::Manager;
use super::state::{Interaction, Preference};
use crate::Concessions;

/// Statements of the user about attributes, by name so that they outlive a change of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Conceded {
    /// Attributes that the user does not know.
    pub unknown: Vec<String>,
    /// Attributes that do not matter to the user.
    pub indifferent: Vec<String>,
}

impl Conceded {
    /// Returns the concessions in a scene.
    pub fn in_scene(&self, scene: &Scene) -> Concessions {
        let ids = |names: &[String]| -> Vec<AttributeId> {
            names.iter().filter_map(|name| scene.attribute_named(name)).collect()
        };
        Concessions { unknown: ids(&self.unknown), indifferent: ids(&self.indifferent) }
    }
}

impl Manager {
    /// Records an utterance's concessions and returns the user's preference. "I do not know" and
    /// "it does not matter" are about the attribute that was asked about; without one, or with
    /// other words ("any red cup"), the latter is about the object.
    pub(super) fn concede(
        &self,
        open: &mut Interaction,
        heard: &[(f64, Question, Reading)],
    ) -> Preference {
        let Some((question, reading)) = likeliest(heard) else { return Preference::Best };
        let name =
            question.attribute().map(|k| self.setup.scene.attributes()[k.index()].name.clone());
        match (reading.response, name) {
            (Response::CannotTell, name) => {
                add(&mut open.conceded.unknown, name);
                Preference::Otherwise
            }
            (Response::DoesNotMatter, Some(name))
                if reading.base.is_empty() && reading.refers != Reference::Any =>
            {
                add(&mut open.conceded.indifferent, Some(name));
                Preference::Best
            }
            (Response::DoesNotMatter, _) => Preference::Any,
            _ => Preference::Best,
        }
    }
}

/// Returns the interpretation with the majority, or one of several that concede the same.
pub(super) fn likeliest(heard: &[(f64, Question, Reading)]) -> Option<(Question, &Reading)> {
    let all: f64 = heard.iter().map(|(weight, ..)| weight).sum();
    let (_, question, first) = heard.first()?;
    // "the red one or the blue one, I don't mind": both interpretations concede the same.
    let agrees = |reading: &Reading| {
        let concedes = matches!(first.response, Response::CannotTell | Response::DoesNotMatter);
        reading == first || concedes && reading.response == first.response
    };
    let agreeing = heard.iter().filter(|(_, asked, reading)| asked == question && agrees(reading));
    let weight: f64 = agreeing.map(|(weight, ..)| weight).sum();
    (2.0 * weight > all).then_some((*question, first))
}

fn add(names: &mut Vec<String>, name: Option<String>) {
    if let Some(name) = name.filter(|name| !names.contains(name)) {
        names.push(name);
    }
}
