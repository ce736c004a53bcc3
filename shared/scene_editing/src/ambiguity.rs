//! Ambiguities of a valid scene: objects and words that a person cannot name clearly.

use std::collections::HashMap;

use crate::{Attribute, Scene, Value};

impl Scene {
    /// Returns the scene's ambiguities, one sentence each.
    pub fn ambiguities(&self) -> Vec<String> {
        let mut found = Vec::new();
        self.noun_as_value(&mut found);
        self.shared_words(&mut found);
        self.missing_attributes(&mut found);
        self.indistinguishable(&mut found);
        found
    }

    /// "mug" for any of the objects, and for those that are not cups.
    fn noun_as_value(&self, found: &mut Vec<String>) {
        let noun = self.noun().to_lowercase();
        for attribute in self.attributes().iter().filter(|attribute| attribute.values.len() > 1) {
            if names(attribute).any(|name| name == noun) {
                found.push(format!(
                    "\"{noun}\" is the noun of the scene and a value of `{}`; help: choose another noun, \
                     \"thing\" say",
                    attribute.name
                ));
            }
        }
    }

    fn shared_words(&self, found: &mut Vec<String>) {
        let mut owners: HashMap<String, &str> = HashMap::new();
        for attribute in self.attributes() {
            for name in names(attribute) {
                let owner = *owners.entry(name.clone()).or_insert(&attribute.name);
                if owner != attribute.name {
                    let both = format!("`{owner}` and `{}`", attribute.name);
                    found.push(format!(
                        "\"{name}\" stands for values of {both}; help: list it in one of them"
                    ));
                }
            }
        }
    }

    fn missing_attributes(&self, found: &mut Vec<String>) {
        for (k, attribute) in self.attributes().iter().enumerate().filter(|(_, it)| !it.by_place) {
            let lacks = self.objects().iter().filter(|object| object.values[k].is_none());
            let lacks: Vec<&str> = lacks.map(|object| object.name.as_str()).collect();
            if let Some(first) = lacks.first().filter(|_| lacks.len() < self.objects().len()) {
                let others = match lacks.len() - 1 {
                    0 => String::new(),
                    more => format!(" and {more} more"),
                };
                found.push(format!(
                    "`{first}`{others} has no `{}`, which counts as a no to each of its values; help: \
                     give it one",
                    attribute.name
                ));
            }
        }
    }

    fn indistinguishable(&self, found: &mut Vec<String>) {
        let mut first: HashMap<&[Option<crate::ValueId>], &str> = HashMap::new();
        for object in self.objects() {
            let same = *first.entry(&object.values).or_insert(&object.name);
            if same != object.name {
                found.push(format!(
                    "no attribute tells `{}` from `{same}`; help: give them different values",
                    object.name
                ));
            }
        }
    }
}

/// The names and synonyms of an attribute's values, in lower case.
fn names(attribute: &Attribute) -> impl Iterator<Item = String> + '_ {
    let names = |value: &Value| -> Vec<String> {
        let names = std::iter::once(&value.name).chain(&value.synonyms);
        names.map(|name| name.to_lowercase()).collect()
    };
    attribute.values.iter().flat_map(names)
}
