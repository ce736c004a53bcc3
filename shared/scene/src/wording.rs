//! The words of the robot's questions.

use crate::{Question, Scene};

/// Yes/no wording of an attribute that brings none.
pub(crate) const ASK_YES_NO: &str = "Is the {attribute} {value}?";
/// Open wording of an attribute that brings none.
pub(crate) const ASK_WHICH: &str = "What is the {attribute}?";

impl Scene {
    /// What the robot says to ask `question`: "Is it in the dishwasher?", "What colour is it?",
    /// "This one?" (while it points).
    ///
    /// # Panics
    /// If the question is not of this scene ([`Scene::contains`]).
    pub fn phrase(&self, question: Question) -> String {
        match question {
            Question::None => format!("Which {} would you like?", self.noun()),
            Question::Point(_) => "This one?".to_owned(),
            Question::Attribute(k, v) => {
                let attribute = &self.attributes()[k.index()];
                let wording = attribute.ask_yes_no.replace("{attribute}", &attribute.name);
                let wording = wording.replace("{noun}", self.noun());
                wording.replace("{value}", &attribute.values[v.index()].spoken)
            }
            Question::Which(k) => {
                let attribute = &self.attributes()[k.index()];
                let wording = attribute.ask_which.replace("{attribute}", &attribute.name);
                wording.replace("{noun}", self.noun())
            }
        }
    }
}

/// The first `{…}` of a wording that would be read out as it stands.
pub(crate) fn unknown_slot(wording: &str) -> Option<String> {
    let mut rest = wording;
    while let Some(open) = rest.find('{') {
        let after = &rest[open..];
        let end = after.find('}').map_or(after.len(), |close| close + 1);
        let slot = &after[..end];
        if !["{value}", "{attribute}", "{noun}"].contains(&slot) {
            return Some(slot.to_owned());
        }
        rest = &after[end..];
    }
    None
}
