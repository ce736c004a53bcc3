//! Ambiguities of a valid scene: objects and words that a person cannot name clearly.

use std::collections::HashMap;

use scene::{Attribute, Scene, Value, ValueId};

/// Returns the scene's ambiguities, one sentence each.
pub(crate) fn ambiguities(scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    noun_as_value(scene, &mut found);
    shared_words(scene, &mut found);
    missing_attributes(scene, &mut found);
    indistinguishable(scene, &mut found);
    found
}

/// "mug" for any of the objects, and for those that are not cups.
fn noun_as_value(scene: &Scene, found: &mut Vec<String>) {
    let noun = scene.noun().to_lowercase();
    for attribute in scene.attributes().iter().filter(|attribute| attribute.values.len() > 1) {
        if names(attribute).any(|name| name == noun) {
            found.push(format!(
                "\"{noun}\" is the noun of the scene and a value of `{}`; help: choose another noun, \
                 \"thing\" say",
                attribute.name
            ));
        }
    }
}

fn shared_words(scene: &Scene, found: &mut Vec<String>) {
    let mut owners: HashMap<String, &str> = HashMap::new();
    for attribute in scene.attributes() {
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

fn missing_attributes(scene: &Scene, found: &mut Vec<String>) {
    for (k, attribute) in scene.attributes().iter().enumerate().filter(|(_, it)| !it.by_place) {
        let lacks = scene.objects().iter().filter(|object| object.values[k].is_none());
        let lacks: Vec<&str> = lacks.map(|object| object.name.as_str()).collect();
        if let Some(first) = lacks.first().filter(|_| lacks.len() < scene.objects().len()) {
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

fn indistinguishable(scene: &Scene, found: &mut Vec<String>) {
    let mut first: HashMap<&[Option<ValueId>], &str> = HashMap::new();
    for object in scene.objects() {
        let same = *first.entry(&object.values).or_insert(&object.name);
        if same != object.name {
            found.push(format!(
                "no attribute tells `{}` from `{same}`; help: give them different values",
                object.name
            ));
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const BOWLS: &str = include_str!("../../../config/scenes/bowls.toml");
    const TOOLS: &str = include_str!("../../../config/scenes/tools.toml");

    #[test]
    fn ambiguous_scenes_are_told() {
        for shipped in [BOWLS, TOOLS] {
            assert_eq!(
                ambiguities(&Scene::from_toml("shipped", shipped).unwrap()),
                [] as [&str; 0]
            );
        }
        let json = json!({"noun": "mug", "values": {
            "kind": ["mug", "cup"], "color": ["orange", "red"], "fruit": ["Orange"],
        }, "objects": [
            {"name": "a", "attributes": {"kind": "mug", "color": "red"}},
            {"name": "b", "attributes": {"kind": "mug", "color": "red"}},
            {"name": "c", "attributes": {"kind": "cup"}},
        ]});
        let scene = Scene::from_json("s", &json).expect("a scene");
        let found = ambiguities(&scene);
        let told = |part: &str| found.iter().any(|line| line.contains(part));
        assert!(told("\"mug\" is the noun of the scene and a value of `kind`"), "{found:#?}");
        assert!(told("\"orange\" stands for values of `color` and `fruit`"), "{found:#?}");
        assert!(told("`c` has no `color`"), "{found:#?}");
        assert!(told("no attribute tells `b` from `a`"), "{found:#?}");
        assert_eq!(found.len(), 4, "{found:#?}");
    }
}
