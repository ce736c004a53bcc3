//! The scene for pages: what there is, and short words for people.

use scene::{ObjectId, Scene};
use serde_json::{Map, Value as Json, json};

/// The section.
pub(super) fn section(scene: &Scene) -> Json {
    let attributes: Vec<Json> = (scene.attributes().iter())
        .map(|attribute| {
            let values = attribute.values.iter();
            let values = values.map(|value| json!({ "name": value.name, "spoken": value.spoken }));
            json!({ "name": attribute.name, "values": values.collect::<Vec<_>>() })
        })
        .collect();
    let labels = labels(scene);
    let objects = scene.objects().iter().zip(&labels).map(|(object, label)| {
        let values = scene.attributes().iter().zip(&object.values);
        let values: Map<String, Json> = values
            .filter_map(|(attribute, value)| {
                let value = &attribute.values[(*value)?.index()];
                Some((attribute.name.clone(), value.name.clone().into()))
            })
            .collect();
        let placed = object.placement;
        json!({
            "name": object.name,
            "label": label,
            "attributes": values,
            "xyz": placed.map(|placed| placed.xyz),
            "size": placed.map(|placed| placed.size),
            "yaw": placed.map(|placed| placed.yaw),
        })
    });
    json!({
        "key": format!("{:016x}", scene.key()),
        "name": scene.name(),
        "noun": scene.noun(),
        "attributes": attributes,
        "objects": objects.collect::<Vec<_>>(),
    })
}

/// A name in words for each object. Those that no words tell apart are numbered.
fn labels(scene: &Scene) -> Vec<String> {
    let said: Vec<String> =
        (0..scene.objects().len()).map(|i| scene.describe(ObjectId::from(i))).collect();
    let number = |i: usize| said[..i].iter().filter(|other| **other == said[i]).count() + 1;
    let is_alone = |i: usize| said.iter().filter(|other| **other == said[i]).count() == 1;
    (0..said.len())
        .map(|i| if is_alone(i) { said[i].clone() } else { format!("{} {}", said[i], number(i)) })
        .collect()
}

/// An object's name in words.
pub(super) fn label(scene: &Scene, object: usize) -> Option<String> {
    labels(scene).into_iter().nth(object)
}
