//! Example requests from the scene's own objects.

use std::collections::HashMap;

use crate::{ObjectId, Role, Scene, ValueId};

/// Most objects of which the one with the shortest description is chosen.
const DESCRIBED_MAX: usize = 32;

/// Returns up to three requests: by kind, by a description of one object, by place.
pub fn examples(scene: &Scene) -> Vec<String> {
    let objects = || (0..scene.objects().len()).map(ObjectId::from);
    let mut alike: HashMap<&str, usize> = HashMap::new();
    for object in objects() {
        *alike.entry(scene.noun_of(object)).or_default() += 1;
    }
    let common = objects().rev().max_by_key(|object| alike[scene.noun_of(*object)]);
    let by_kind = common.map(|object| format!("get me the {}", scene.noun_of(object)));
    let has_place = |object: ObjectId| {
        let place = place(scene, object);
        place.is_some_and(|place| scene.describe(object).ends_with(place))
    };
    let mut same: HashMap<&[Option<ValueId>], usize> = HashMap::new();
    for object in scene.objects() {
        *same.entry(&object.values).or_default() += 1;
    }
    let unique = |object: &ObjectId| same[scene.object(*object).values.as_slice()] == 1;
    // The first ones are examples enough; rather those that can be fetched.
    let candidates = scene.placed().chain(objects());
    let described = candidates.filter(unique).take(DESCRIBED_MAX);
    let by_description = described
        .map(|object| (object, scene.describe(object)))
        .filter(|(object, words)| words != scene.noun_of(*object))
        .min_by_key(|(object, words)| (has_place(*object), words.len()));
    let chosen = by_description.as_ref().map(|(object, _)| *object);
    let by_place = objects().filter(|object| Some(*object) != chosen).find_map(|object| {
        Some(format!("the {} {}", scene.noun_of(object), place(scene, object)?))
    });
    let by_description = by_description.map(|(_, words)| format!("the {words}"));
    let mut examples = Vec::new();
    for example in [by_kind, by_description, by_place].into_iter().flatten() {
        if !examples.contains(&example) {
            examples.push(example);
        }
    }
    examples
}

/// Returns the words for an object's place: "on the counter".
fn place(scene: &Scene, object: ObjectId) -> Option<&str> {
    let values = scene.attributes().iter().zip(&scene.object(object).values);
    let mut values = values.filter_map(|(attribute, v)| Some(&attribute.values[(*v)?.index()]));
    values.find(|value| value.role() == Role::Place).map(|value| value.spoken.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, text: &str) -> Vec<String> {
        examples(&Scene::from_toml(name, text).unwrap())
    }

    #[test]
    fn examples_are_requests_by_kind_description_and_place() {
        let bowls = of("bowls", include_str!("../../../../config/scenes/bowls.toml"));
        assert_eq!(bowls, ["get me the bowl", "the clear bowl", "the bowl in the dishwasher"]);
        let mugs = of("mugs", include_str!("../../../../tests/talk/scenes/mugs.toml"));
        assert_eq!(mugs, ["get me the mug", "the red mug", "the cup next to the sink"]);
    }

    #[test]
    fn examples_are_fewer_where_the_scene_says_less() {
        let text = "name = \"s\"\nnoun = \"thing\"\n[[attributes]]\nname = \"colour\"\n\
                    values = [\"red\", \"blue\"]\n[[objects]]\nname = \"a\"\n\
                    attributes = { colour = \"red\" }\n";
        assert_eq!(of("s", text), ["get me the thing"]);
    }
}
