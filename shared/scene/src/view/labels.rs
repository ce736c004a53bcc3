//! Unique words for each object.

use std::cell::OnceCell;

use crate::{ObjectId, Scene};

/// Words for objects, found when they are first needed: in a scene of thousands few ever are.
#[derive(Debug)]
pub struct Labels(Vec<OnceCell<Label>>);

/// Words for an object.
#[derive(Debug)]
pub struct Label {
    /// The robot's own words for it, which it also understands.
    pub description: String,
    /// The same, numbered where objects have the same values.
    pub unique: String,
}

impl Labels {
    /// Prepares for the objects of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self(scene.objects().iter().map(|_| OnceCell::new()).collect())
    }

    /// Returns the words for an object of the scene; none if it has no such object.
    pub fn of(&self, scene: &Scene, object: ObjectId) -> Option<&Label> {
        let cell = self.0.get(object.index())?;
        Some(cell.get_or_init(|| Label::new(scene, object)))
    }

    /// Returns the unique words for an object; its name if the scene has no such object.
    pub fn unique<'a>(&'a self, scene: &Scene, object: ObjectId, name: &'a str) -> &'a str {
        self.of(scene, object).map_or(name, |label| &label.unique)
    }
}

impl Label {
    fn new(scene: &Scene, object: ObjectId) -> Self {
        let description = scene.describe(object);
        let values = &scene.object(object).values;
        let same =
            |objects: &[crate::Object]| objects.iter().filter(|o| o.values == *values).count();
        let unique = match same(scene.objects()) {
            0 | 1 => description.clone(),
            _ => format!("{description} {}", same(&scene.objects()[..object.index()]) + 1),
        };
        Self { description, unique }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_of_equal_values_are_numbered() {
        let head =
            "name = \"s\"\nnoun = \"mug\"\n[[attributes]]\nname = \"colour\"\nvalues = [\"red\"]\n";
        let mug =
            |n| format!("[[objects]]\nname = \"m{n}\"\nattributes = {{ colour = \"red\" }}\n");
        let mugs: String = (0..3).map(mug).collect();
        let scene = Scene::from_toml("s", &format!("{head}{mugs}")).unwrap();
        let labels = Labels::new(&scene);
        let label = |n: u16| labels.of(&scene, ObjectId(n)).map(|label| label.unique.as_str());
        assert_eq!([0, 2, 3].map(label), [Some("mug 1"), Some("mug 3"), None]);
    }
}
