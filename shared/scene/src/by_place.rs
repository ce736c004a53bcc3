//! An attribute of places in a row, for otherwise identical objects: "Is it on the left?"

use std::collections::HashMap;

use crate::relation_truth::dot;
use crate::{Attribute, Object, Role, Scene, Value, ValueId, View, WordId};

/// Names of the attribute; the first that the scene does not have is taken.
const NAMES: [&str; 3] = ["place", "position", "spot"];
/// Places of two to five objects from the left to the right.
const ROWS: [&[&str]; 4] = [
    &["on the left", "on the right"],
    &["on the left", "in the middle", "on the right"],
    &["on the far left", "second from the left", "second from the right", "on the far right"],
    &[
        "on the far left",
        "second from the left",
        "in the middle",
        "second from the right",
        "on the far right",
    ],
];
/// Places of two objects of which one is behind the other.
const DEPTH: &[&str] = &["in front", "at the back"];
/// Distance at which people distinguish neighbours in a row, metres.
const APART_M: f64 = 0.04;
/// Likeness from which objects are told apart by their places.
const ALIKE_MIN: f64 = 0.5;

/// Distinction of objects by their places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ByPlace {
    view: View,
    /// Words of the scene without those of the places.
    words: usize,
}

impl Object {
    /// The probability that both have the same values, as far as their doubts allow; 1 if they are
    /// known to.
    fn likeness(&self, other: &Self) -> f64 {
        let chance = |object: &Self, k: usize, v: ValueId| match object.chances.get(k) {
            Some(Some(chances)) => chances[v.index()],
            _ => f64::from(u8::from(object.values[k] == Some(v))),
        };
        let doubts =
            |object: &Self, k| object.chances.get(k).and_then(Option::as_ref).map(Vec::len);
        let shared = |k: usize| match doubts(self, k).or(doubts(other, k)) {
            Some(values) => {
                (0..values).map(|v| chance(self, k, v.into()).min(chance(other, k, v.into()))).sum()
            }
            None => f64::from(u8::from(self.values[k] == other.values[k])),
        };
        (0..self.values.len()).map(shared).product()
    }
}

impl Scene {
    /// Returns the scene with an attribute of places, as the viewer sees them, if some objects
    /// share all other values, or may do so; otherwise the scene as it is. Replacing objects computes it again.
    #[must_use]
    pub fn by_place(mut self, view: View) -> Self {
        self.places = Some(ByPlace { view, words: self.words().len() });
        self.told_apart()
    }

    /// Returns the scene about other objects, with values of the attributes other than places.
    pub(crate) fn with(&self, objects: Vec<Object>) -> Self {
        let (name, noun, asks) =
            (self.name().to_owned(), self.noun().to_owned(), self.asks().clone());
        let attributes = self.attributes().iter().filter(|it| !it.by_place).cloned().collect();
        let words = self.places.map_or(self.words().len(), |places| places.words);
        let words = self.words()[..words].to_vec();
        let mut scene = Self::assemble(name, noun, asks, objects, attributes, words);
        scene.places = self.places;
        scene.told_apart()
    }

    /// Adds the attribute to a scene without it.
    fn told_apart(self) -> Self {
        let Some(places) = self.places else { return self };
        let rows = self.rows(places.view);
        let is_taken = |name: &&str| {
            let own = |it: &Attribute| it.name == *name || it.synonyms.iter().any(|s| s == name);
            self.attributes().iter().any(own)
        };
        let Some(name) = NAMES.into_iter().find(|name| !is_taken(name)) else { return self };
        let mut said: Vec<&str> = rows.iter().flatten().copied().collect();
        let order = |place: &&str| all_places().position(|known| known == *place);
        said.sort_by_key(order);
        said.dedup();
        if said.is_empty() {
            return self;
        }
        let mut words = self.words().to_vec();
        let values = said.iter().map(|place| {
            let known = words.iter().position(|word| word == place);
            let word = known.unwrap_or_else(|| {
                words.push((*place).to_owned());
                words.len() - 1
            });
            Value {
                name: (*place).to_owned(),
                synonyms: Vec::new(),
                spoken: spoken(place, places.view),
                word: WordId::from(word),
                role: Role::Place,
                is_noun: false,
            }
        });
        let attribute = Attribute {
            name: name.to_owned(),
            synonyms: Vec::new(),
            values: values.collect(),
            ask_yes_no: vec!["Is it {value}?".to_owned(), "Is it the one {value}?".to_owned()],
            ask_which: vec!["Where is it among those that are alike?".to_owned()],
            by_place: true,
        };
        let value = |place: &str| said.iter().position(|it| *it == place).map(ValueId::from);
        let mut objects = self.objects().to_vec();
        for (object, place) in objects.iter_mut().zip(rows) {
            object.values.push(place.and_then(value));
            if !object.chances.is_empty() {
                object.chances.push(None);
            }
        }
        let attributes = self.attributes().iter().cloned().chain([attribute]).collect();
        let (name, noun, asks) =
            (self.name().to_owned(), self.noun().to_owned(), self.asks().clone());
        let mut scene = Self::assemble(name, noun, asks, objects, attributes, words);
        scene.places = Some(places);
        scene
    }

    /// The place of each object in the row of those that are like it.
    fn rows(&self, view: View) -> Vec<Option<&'static str>> {
        let mut rows = vec![None; self.objects().len()];
        let [left, back] = self.axes(view);
        let along = |i: usize, way: [f64; 2]| {
            let xyz = self.objects()[i].placement.map(|placement| placement.xyz);
            xyz.map(|[x, y, _]| dot([x, y], way))
        };
        let mut seen = vec![false; rows.len()];
        let mut same: HashMap<&[Option<ValueId>], Vec<usize>> = HashMap::new();
        let is_certain = |i: &usize| self.objects()[*i].chances.is_empty();
        let (certain, doubtful): (Vec<usize>, _) = (0..rows.len()).partition(is_certain);
        certain.iter().for_each(|i| same.entry(&self.objects()[*i].values).or_default().push(*i));
        for first in 0..rows.len() {
            let other = &self.objects()[first];
            if seen[first] || other.taken {
                continue;
            }
            // Objects without doubts are alike if their values are the same: thousands are not
            // compared with one another.
            let mut alike: Vec<usize> = match is_certain(&first) {
                true => [&same[&*other.values], &doubtful[..]].concat(),
                false => (first..rows.len()).collect(),
            };
            alike.retain(|i| {
                let object = &self.objects()[*i];
                let is_left = *i >= first && !seen[*i] && !object.taken;
                is_left && object.likeness(other) >= ALIKE_MIN
            });
            if alike.len() < 2 {
                continue;
            }
            alike.iter().for_each(|i| seen[*i] = true);
            let row = |way: [f64; 2]| -> Option<Vec<(f64, usize)>> {
                let mut row: Vec<(f64, usize)> =
                    alike.iter().map(|i| Some((along(*i, way)?, *i))).collect::<Option<_>>()?;
                row.sort_by(|a, b| a.0.total_cmp(&b.0));
                row.windows(2).all(|pair| pair[1].0 - pair[0].0 >= APART_M).then_some(row)
            };
            let side = row([-left[0], -left[1]]);
            let named = side.zip(ROWS.get(alike.len() - 2).copied());
            let named = named.or_else(|| row(back).zip((alike.len() == 2).then_some(DEPTH)));
            for ((_, i), place) in
                named.into_iter().flat_map(|(row, names)| row.into_iter().zip(names))
            {
                rows[i] = Some(*place);
            }
        }
        rows
    }
}

fn all_places() -> impl Iterator<Item = &'static str> {
    ROWS.into_iter().rev().flatten().chain(DEPTH).copied()
}

/// A user who faces the robot hears whose left it is.
fn spoken(place: &str, view: View) -> String {
    match view {
        View::Robot => place.to_owned(),
        View::User(_) => ["left", "right"].iter().fold(place.to_owned(), |text, side| {
            text.replace(&format!("the {side}"), &format!("your {side}"))
                .replace(&format!("the far {side}"), &format!("your far {side}"))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cups(places: &[[f64; 2]]) -> Scene {
        let head = "name = \"cups\"\nnoun = \"cup\"\n[[attributes]]\nname = \"color\"\n\
            values = [\"white\", \"red\"]\n[[objects]]\nname = \"r\"\n\
            attributes = { color = \"red\" }\nxyz = [0.5, 0.5, 0.0]\nsize = [0.1, 0.1, 0.1]\n\
            grasp_width = 0.05\n";
        let object = |(n, [x, y]): (usize, &[f64; 2])| {
            format!(
                "[[objects]]\nname = \"c{n}\"\nattributes = {{ color = \"white\" }}\n\
                 xyz = [{x:?}, {y:?}, 0.0]\nsize = [0.1, 0.1, 0.1]\ngrasp_width = 0.05\n"
            )
        };
        let objects: String = places.iter().enumerate().map(object).collect();
        Scene::from_toml("cups.toml", &format!("{head}{objects}")).unwrap_or_else(|e| panic!("{e}"))
    }

    /// The places of the objects in their order.
    fn places(scene: &Scene) -> Vec<&str> {
        let Some(k) = scene.attribute_named("place") else { return Vec::new() };
        let values = &scene.attributes()[k.index()].values;
        let all = scene.objects().iter().map(|object| object.values[k.index()]);
        all.map(|v| v.map_or("", |v| values[v.index()].name.as_str())).collect()
    }

    #[test]
    fn objects_that_are_alike_are_told_apart_by_their_row() {
        let row = |places: &[[f64; 2]]| cups(places).by_place(View::Robot);
        let two = row(&[[0.6, -0.1], [0.6, 0.1]]);
        assert_eq!(places(&two), ["", "on the right", "on the left"]);
        assert_eq!(two.describe(1.into()), "white cup on the right");
        assert_eq!(
            places(&row(&[[0.6, 0.0], [0.6, 0.1], [0.6, -0.1]])),
            ["", "in the middle", "on the left", "on the right"]
        );
        assert_eq!(places(&row(&[[0.6, 0.0], [0.8, 0.01]])), ["", "in front", "at the back"]);
        assert_eq!(places(&row(&[[0.6, 0.0], [0.61, 0.01]])), [""; 0], "too close");
        assert_eq!(places(&row(&[[0.6, 0.0]])), [""; 0], "none is like another");
    }

    #[test]
    fn a_user_who_faces_the_robot_is_asked_about_the_own_left() {
        let scene = cups(&[[0.6, -0.1], [0.6, 0.1]]).by_place(View::User([1.6, 0.0, 0.4]));
        assert_eq!(places(&scene), ["", "on the left", "on the right"]);
        assert_eq!(scene.describe(1.into()), "white cup on your left");
    }

    #[test]
    fn the_row_is_that_of_the_objects_that_are_there() {
        let scene = cups(&[[0.6, -0.1], [0.6, 0.1]]);
        let placed = scene.clone().by_place(View::Robot);
        let mut objects = scene.objects().to_vec();
        objects[1].taken = true;
        let left = placed.with(objects);
        assert_eq!(places(&left), [""; 0], "one was handed over");
        assert_eq!(left.words(), scene.words());
        assert_eq!(placed.with(scene.objects().to_vec()), placed);
    }
}
