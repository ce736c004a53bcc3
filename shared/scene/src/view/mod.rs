//! The scene as pages show it: its attributes with their words, objects with unique labels, example requests.

mod examples;
mod labels;

use serde::{Serialize, Serializer};

use crate::{ObjectId, Scene};

pub use examples::examples;
pub use labels::{Label, Labels};

/// A scene.
#[derive(Debug, Serialize)]
pub struct SceneView<'a> {
    key: String,
    name: &'a str,
    noun: &'a str,
    attributes: Vec<Attribute<'a>>,
    /// Number of objects in the scene.
    count: usize,
    /// Those that have a place; the section `further` has others.
    objects: Vec<ObjectView<'a>>,
    /// Requests that the robot understands, for who does not know what to say.
    examples: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Attribute<'a> {
    name: &'a str,
    values: Vec<Value<'a>>,
}

#[derive(Debug, Serialize)]
struct Value<'a> {
    name: &'a str,
    spoken: &'a str,
}

/// An object of a scene.
#[derive(Debug, Serialize)]
pub struct ObjectView<'a> {
    name: &'a str,
    /// Unique: objects with the same description are numbered.
    label: &'a str,
    /// The robot's own words for it, which it also understands.
    description: &'a str,
    #[serde(serialize_with = "map")]
    attributes: Vec<(&'a str, &'a str)>,
    xyz: Option<[f64; 3]>,
    size: Option<[f64; 3]>,
    yaw: Option<f64>,
}

impl<'a> SceneView<'a> {
    /// Makes the view of a scene, with these objects of it.
    pub fn new(scene: &'a Scene, labels: &'a Labels, listed: &[ObjectId]) -> Self {
        let attributes = scene.attributes().iter().map(|attribute| Attribute {
            name: &attribute.name,
            values: (attribute.values.iter())
                .map(|value| Value { name: &value.name, spoken: &value.spoken })
                .collect(),
        });
        Self {
            key: format!("{:016x}", scene.key()),
            name: scene.name(),
            noun: scene.noun(),
            attributes: attributes.collect(),
            count: scene.objects().len(),
            objects: objects(scene, labels, listed.iter().copied()),
            examples: examples(scene),
        }
    }
}

/// Describes objects of the scene.
pub fn objects<'a>(
    scene: &'a Scene,
    labels: &'a Labels,
    listed: impl Iterator<Item = ObjectId>,
) -> Vec<ObjectView<'a>> {
    listed.filter_map(|i| ObjectView::new(scene, i, labels.of(scene, i)?)).collect()
}

impl<'a> ObjectView<'a> {
    fn new(scene: &'a Scene, object: ObjectId, label: &'a Label) -> Option<Self> {
        let object = scene.objects().get(object.index())?;
        let values = scene.attributes().iter().zip(&object.values);
        Some(Self {
            name: &object.name,
            label: &label.unique,
            description: &label.description,
            attributes: values
                .filter_map(|(attribute, value)| {
                    let value = &attribute.values[(*value)?.index()];
                    Some((attribute.name.as_str(), value.name.as_str()))
                })
                .collect(),
            xyz: object.placement.map(|placed| placed.xyz),
            size: object.placement.map(|placed| placed.size),
            yaw: object.placement.map(|placed| placed.yaw),
        })
    }
}

fn map<S: Serializer>(pairs: &[(&str, &str)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(pairs.iter().copied())
}
