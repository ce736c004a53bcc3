//! Objects that were perceived, in place of those of the scene file.
//!
//! The file remains the vocabulary (attributes, values, wording) and the table from the camera's
//! labels to the attributes that can be talked about. A perceived object refers to the file by
//! names, so that it outlives a change of the file.

use serde::{Deserialize, Serialize};

use crate::{AttributeId, Object, ObjectId, Placement, Scene, ValueId};

/// Probability from which a value counts as certain.
const CERTAIN: f64 = 0.995;

/// An object on the table as it was perceived.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Perceived {
    /// Its number: never reused, and never below the number of objects in the scene file, so that
    /// it is never taken for one of those.
    pub number: ObjectId,
    /// Its name, unique and never reused: the class that it was first taken for and its number,
    /// e.g. `white2-9`.
    pub name: String,
    /// What it was recognised as: names of objects in the scene file with their probabilities.
    pub classes: Vec<(String, f64)>,
    /// Values perceived directly, by attribute: each value's name with its probability. They
    /// replace what follows from the classes.
    pub attributes: Vec<(String, Vec<(String, f64)>)>,
    /// Centre in frame `base`, metres.
    pub xyz: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw: f64,
    /// Names of the sources that have seen it, so that it is missed where they look and do not.
    pub seen_by: Vec<String>,
    /// Whether it was handed to a person, who may still refuse it or have it put back.
    pub taken: bool,
}

impl Perceived {
    /// Returns the likeliest class, of equals the first.
    pub fn class(&self) -> Option<&str> {
        likeliest(&self.classes)
    }
}

/// Returns the likeliest name, of equals the first.
pub fn likeliest(chances: &[(String, f64)]) -> Option<&str> {
    let likelier = |a: &&(String, f64), b: &&(String, f64)| a.1.total_cmp(&b.1);
    chances.iter().rev().max_by(likelier).map(|(name, _)| name.as_str())
}

impl Scene {
    /// Returns the scene with perceived objects in place of its own. Names that the scene does not
    /// have are ignored. The result may be without objects.
    #[must_use]
    pub fn with_objects(&self, perceived: &[Perceived]) -> Self {
        let objects = perceived.iter().map(|object| self.object_of(object)).collect();
        self.with(objects)
    }

    /// Returns the number by which services refer to an object: its position in a scene file, or
    /// the number under which it was perceived.
    pub fn number(&self, object: ObjectId) -> ObjectId {
        self.objects().get(object.index()).and_then(|object| object.number).unwrap_or(object)
    }

    /// Returns the object with the given number.
    pub fn numbered(&self, number: ObjectId) -> Option<ObjectId> {
        let mut all = self.ids();
        all.find(|object| self.number(*object) == number)
    }

    /// Returns the probability of every value of an attribute that follows from the classes, and that
    /// of lacking the attribute. Names that the scene does not have are ignored.
    pub fn values_of_classes(&self, classes: &[(String, f64)], k: AttributeId) -> (Vec<f64>, f64) {
        let mut chances = vec![0.0; self.attributes()[k.index()].values.len()];
        let mut lacking = 0.0;
        let known = classes.iter().filter_map(|(name, p)| Some((self.object_named(name)?, *p)));
        for (class, p) in known {
            match self.object(class).values[k.index()] {
                Some(v) => chances[v.index()] += p,
                None => lacking += p,
            }
        }
        (chances, lacking)
    }

    fn object_of(&self, perceived: &Perceived) -> Object {
        let chances: Vec<Option<Vec<f64>>> =
            self.own_attributes().map(|k| self.chances_of(perceived, k)).collect();
        let likeliest = |chances: &Option<Vec<f64>>| {
            let chances = chances.as_ref()?;
            let likelier =
                |best: usize, v: usize| if chances[v] > chances[best] { v } else { best };
            (0..chances.len()).reduce(likelier).map(ValueId::from)
        };
        let is_certain = |chances: &Vec<f64>| chances.iter().any(|chance| *chance >= CERTAIN);
        Object {
            name: perceived.name.clone(),
            taken: perceived.taken,
            number: Some(perceived.number),
            values: chances.iter().map(likeliest).collect(),
            chances: chances.into_iter().map(|it| it.filter(|it| !is_certain(it))).collect(),
            placement: self.placement_of(perceived),
        }
    }

    fn own_attributes(&self) -> impl Iterator<Item = AttributeId> + '_ {
        let own = self.attributes().iter().enumerate().filter(|(_, it)| !it.by_place);
        own.map(|(k, _)| k.into())
    }

    /// Size and grasp are those of the class, the place is the perceived one.
    fn placement_of(&self, perceived: &Perceived) -> Option<Placement> {
        let class = self.object_named(perceived.class()?)?;
        let known = self.object(class).placement?;
        Some(Placement { xyz: perceived.xyz, yaw: perceived.yaw, ..known })
    }

    /// Returns the probability of every value of an attribute; `None` if the object lacks it. The
    /// remaining probability is shared evenly by all values.
    fn chances_of(&self, perceived: &Perceived, k: AttributeId) -> Option<Vec<f64>> {
        let attribute = &self.attributes()[k.index()];
        let mut chances = vec![0.0; attribute.values.len()];
        let direct = perceived.attributes.iter().find(|(name, _)| *name == attribute.name);
        let mut lacking = 0.0;
        if let Some((_, values)) = direct {
            let known = values.iter().filter_map(|(v, p)| Some((self.value_named(k, v)?, *p)));
            known.for_each(|(v, p)| chances[v.index()] += p);
        } else {
            (chances, lacking) = self.values_of_classes(&perceived.classes, k);
        }
        let told: f64 = chances.iter().sum();
        if lacking >= told {
            return None;
        }
        if told > 1.0 {
            chances.iter_mut().for_each(|p| *p /= told);
        } else {
            let share = (1.0 - told) / chances.len() as f64;
            chances.iter_mut().for_each(|p| *p += share);
        }
        Some(chances)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bowls() -> Scene {
        Scene::from_toml("bowls", include_str!("../../../config/scenes/bowls.toml")).unwrap()
    }

    fn seen(number: u16, classes: &[(&str, f64)]) -> Perceived {
        Perceived {
            number: ObjectId(number),
            name: format!("{}-{number}", classes[0].0),
            classes: classes.iter().map(|(name, p)| ((*name).to_owned(), *p)).collect(),
            attributes: Vec::new(),
            xyz: [0.7, 0.1, -0.1],
            yaw: 0.5,
            seen_by: Vec::new(),
            taken: false,
        }
    }

    #[test]
    fn perceived_objects_have_the_words_of_the_file_and_numbers_of_their_own() {
        let file = bowls();
        let table = file.with_objects(&[seen(9, &[("white2", 1.0)]), seen(12, &[("metal", 1.0)])]);
        assert_eq!((table.words(), table.attributes()), (file.words(), file.attributes()));
        let names: Vec<&str> = table.objects().iter().map(|it| it.name.as_str()).collect();
        assert_eq!(names, ["white2-9", "metal-12"]);
        let (own, like) = (&table.objects()[0], file.object(file.object_named("white2").unwrap()));
        assert_eq!((&own.values, own.chances.iter().flatten().count()), (&like.values, 0));
        let place = own.placement.unwrap();
        assert_eq!((place.xyz, place.yaw), ([0.7, 0.1, -0.1], 0.5));
        assert_eq!(place.size, like.placement.unwrap().size);
        assert_eq!(table.number(ObjectId(1)), ObjectId(12));
        assert_eq!(table.numbered(ObjectId(12)), Some(ObjectId(1)));
        assert_eq!((table.numbered(ObjectId(1)), file.number(ObjectId(1))), (None, ObjectId(1)));
        assert_ne!(table.key(), file.key());
    }

    #[test]
    fn doubtful_classes_make_doubtful_attributes_only_where_they_differ() {
        let file = bowls();
        let table = file.with_objects(&[seen(9, &[("white", 0.7), ("metal", 0.2)])]);
        let object = &table.objects()[0];
        let like = |name| file.object(file.object_named(name).unwrap());
        let several = |(_, attribute): &(usize, &crate::Attribute)| attribute.values.len() > 1;
        for (k, attribute) in file.attributes().iter().enumerate().filter(several) {
            let chances = object.chances[k].as_ref().expect("a tenth is not accounted for");
            assert!((chances.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let (a, b) = (like("white").values[k].unwrap(), like("metal").values[k].unwrap());
            let rest = 0.1 / attribute.values.len() as f64;
            let expected = if a == b { 0.9 } else { 0.7 } + rest;
            assert!((chances[a.index()] - expected).abs() < 1e-9, "{}", attribute.name);
            assert_eq!(object.values[k], Some(a));
        }
    }

    #[test]
    fn what_is_perceived_directly_counts_and_unknown_names_do_not() {
        let file = bowls();
        let mut it = seen(9, &[("white", 0.6), ("teapot", 0.4)]);
        let name = &file.attributes()[0].name;
        let value = &file.attributes()[0].values[1].name;
        it.attributes = vec![
            (name.clone(), vec![(value.clone(), 1.5), ("mauve".to_owned(), 9.0)]),
            ("weight".to_owned(), vec![]),
        ];
        let table = file.with_objects(&[it]);
        assert_eq!(table.objects()[0].values[0], Some(ValueId(1)));
        assert_eq!(table.objects()[0].chances[0], None, "certain");
        assert!(file.with_objects(&[]).objects().is_empty());
    }
}
