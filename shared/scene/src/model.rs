//! The checked scene. Built only by this crate, so every invariant below holds: names are unique,
//! every value of an object is listed by its attribute, and a scene file has at least one object.

use std::collections::HashMap;

use crate::by_place::ByPlace;
use crate::forms::{has_quantity, indefinite, without_article};
use crate::role::Role;
use crate::wording::Asks;
use crate::{AttributeId, ObjectId, Question, StableHash, ValueId, WordId};

/// A scene: objects `I`, attributes `K`, values `V_k` (section 3.1 of the paper).
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    name: String,
    noun: String,
    asks: Asks,
    objects: Vec<Object>,
    attributes: Vec<Attribute>,
    words: Vec<String>,
    key: u64,
    names: Names,
    vocabularies: Vocabularies,
    /// How objects are told apart by place, where they are.
    pub(crate) places: Option<ByPlace>,
}

/// One object that can be asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Unique name; not something that people say.
    pub name: String,
    /// The number under which it was perceived; none for an object of the scene file.
    pub number: Option<ObjectId>,
    /// Value per attribute, in the scene's attribute order; an object may lack one. Of a value that
    /// is in doubt it is the likeliest.
    pub values: Vec<Option<ValueId>>,
    /// Per attribute the probability of each value, where it is in doubt; empty if nothing is.
    pub chances: Vec<Option<Vec<f64>>>,
    /// Whether it was handed to a person ([`Perceived::taken`](crate::Perceived::taken)).
    pub taken: bool,
    /// Place and size; an object without them can be talked about and not fetched.
    pub placement: Option<Placement>,
}

/// Place and size of an object in frame `base` of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Centre of the object, metres, frame `base`.
    pub xyz: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw: f64,
    /// Extents along the object's own x, y and z, metres.
    pub size: [f64; 3],
    /// Width that the gripper closes on, metres.
    pub grasp_width: f64,
    /// Mass, kilograms, if known: the gripper may be too weak.
    pub mass_kg: Option<f64>,
    /// Slope of a wall that is gripped at its rim, degrees from the vertical, outwards.
    pub wall_deg: f64,
    /// Whether it has a rim to be gripped at.
    pub form: Form,
}

/// Form of an object, as far as it decides how the fingers take it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Solid body that the fingers span.
    #[default]
    Solid,
    /// A bowl, cup or box without a lid: if it is wider than the fingers open, they take its rim.
    Hollow,
}

impl Form {
    /// The names of the forms in a scene file.
    pub const NAMES: [(&str, Self); 2] = [("solid", Self::Solid), ("hollow", Self::Hollow)];

    /// Returns its name in a scene file.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }
}

/// An attribute with its values and the wording of its questions.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name, e.g. `color`.
    pub name: String,
    /// Other words for the attribute itself, lower case, e.g. `colour`.
    pub synonyms: Vec<String>,
    /// `V_k`, in the scene file's order.
    pub values: Vec<Value>,
    /// Yes/no wordings with `{value}`, e.g. `Is it {value}?`; at least one, the usual one first.
    pub ask_yes_no: Vec<String>,
    /// Open wordings, e.g. `What colour is it?`; at least one, the usual one first.
    pub ask_which: Vec<String>,
    /// Whether this is the attribute of places in a row, not of the scene file: people say them as
    /// relations ([`Relation`](crate::Relation)).
    pub by_place: bool,
}

/// A value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The scene's own spelling; a member of `V`.
    pub name: String,
    /// Other words and phrases for it, lower case.
    pub synonyms: Vec<String>,
    /// Form of the value in questions, e.g. `in the dishwasher`; the name by default.
    pub spoken: String,
    /// The value as a word of `V`.
    pub word: WordId,
    pub(crate) role: Role,
    /// Whether it is a part named without an article: "green handle".
    pub(crate) is_noun: bool,
}

impl Value {
    /// Returns the grammatical role of the value.
    pub fn role(&self) -> Role {
        self.role
    }

    /// The value without an article, as used with a noun or instead of one: "felt tip" of "a felt
    /// tip".
    pub fn bare(&self) -> &str {
        without_article(&self.spoken).filter(|_| self.role == Role::Kind).unwrap_or(&self.spoken)
    }

    /// The value after a noun: "in the dishwasher", "with a green handle", "with no handle".
    pub fn after_noun(&self) -> String {
        let spoken = &self.spoken;
        let is_noun = self.role == Role::Part && self.is_noun;
        match has_quantity(spoken) {
            true if self.role == Role::Part => format!("with {spoken}"),
            false if is_noun => format!("with {} {spoken}", indefinite(spoken)),
            _ => spoken.clone(),
        }
    }
}

/// Indices by name, so that a lookup costs the same in any scene.
#[derive(Clone, Debug, PartialEq)]
struct Names {
    objects: HashMap<String, ObjectId>,
    attributes: HashMap<String, AttributeId>,
    values: Vec<HashMap<String, ValueId>>,
    words: HashMap<String, WordId>,
}

/// `V_D` of every object as a sorted set, one after the other.
#[derive(Clone, Debug, PartialEq)]
struct Vocabularies {
    words: Vec<WordId>,
    ends: Vec<usize>,
}

impl Scene {
    /// Puts checked parts together and precomputes frequent look-ups.
    pub(crate) fn assemble(
        name: String,
        noun: String,
        asks: Asks,
        objects: Vec<Object>,
        attributes: Vec<Attribute>,
        words: Vec<String>,
    ) -> Self {
        let names = Names {
            objects: index(objects.iter().map(|object| &object.name)),
            attributes: index(attributes.iter().map(|attribute| &attribute.name)),
            values: attributes.iter().map(|a| index(a.values.iter().map(|v| &v.name))).collect(),
            words: index(words.iter()),
        };
        let vocabularies = vocabularies(&objects, &attributes);
        let key = key(&objects, &attributes);
        let places = None;
        Self { name, noun, asks, objects, attributes, words, key, names, vocabularies, places }
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The common noun of the objects, e.g. `bowl`.
    pub fn noun(&self) -> &str {
        &self.noun
    }

    /// The wordings of the questions that no attribute words.
    pub(crate) fn asks(&self) -> &Asks {
        &self.asks
    }

    /// The objects, in order.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The attributes, in order.
    pub fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }

    /// `V`: every value string once, in order of first appearance.
    pub fn words(&self) -> &[String] {
        &self.words
    }

    /// Identity of the decision problem: a hash of objects, attributes and values (not of poses,
    /// synonyms or wording), equal on every machine.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Returns the object of the given name.
    pub fn object_named(&self, name: &str) -> Option<ObjectId> {
        self.names.objects.get(name).copied()
    }

    /// Returns the attribute of the given name.
    pub fn attribute_named(&self, name: &str) -> Option<AttributeId> {
        self.names.attributes.get(name).copied()
    }

    /// The value of that name in attribute `k`.
    pub fn value_named(&self, k: AttributeId, name: &str) -> Option<ValueId> {
        self.names.values[k.index()].get(name).copied()
    }

    /// The word of `V` with that spelling.
    pub fn word_named(&self, word: &str) -> Option<WordId> {
        self.names.words.get(word).copied()
    }

    /// The objects that have a place, in order.
    pub fn placed(&self) -> impl Iterator<Item = ObjectId> + '_ {
        let objects = self.objects.iter().enumerate();
        objects.filter(|(_, object)| object.placement.is_some()).map(|(i, _)| i.into())
    }

    /// The numbers of the objects.
    pub fn ids(&self) -> impl Iterator<Item = ObjectId> + use<> {
        (0..self.objects.len()).map(ObjectId::from)
    }

    /// The object `i`.
    pub fn object(&self, i: ObjectId) -> &Object {
        &self.objects[i.index()]
    }

    /// `attr_k,v(i)`: whether object `i` has value `v` for attribute `k`. An object without the
    /// attribute has no value of it.
    pub fn has(&self, i: ObjectId, k: AttributeId, v: ValueId) -> bool {
        self.objects[i.index()].values[k.index()] == Some(v)
    }

    /// `1_{V_D}(w)`: whether `w` is among object `i`'s own values.
    pub fn has_word(&self, i: ObjectId, w: WordId) -> bool {
        self.vocabulary_set(i).binary_search(&w).is_ok()
    }

    /// `V_D` as a set: the words of object `i`'s values, each once, in word order.
    pub fn vocabulary(&self, i: ObjectId) -> impl Iterator<Item = WordId> + '_ {
        self.vocabulary_set(i).iter().copied()
    }

    /// `|V_D|`.
    pub fn vocabulary_len(&self, i: ObjectId) -> usize {
        self.vocabulary_set(i).len()
    }

    fn vocabulary_set(&self, i: ObjectId) -> &[WordId] {
        let Vocabularies { words, ends } = &self.vocabularies;
        let start = if i.index() == 0 { 0 } else { ends[i.index() - 1] };
        &words[start..ends[i.index()]]
    }

    /// Returns true if the scene has the object, attribute and value of the question.
    pub fn contains(&self, question: Question) -> bool {
        match question {
            Question::None => true,
            Question::Point(i) => i.index() < self.objects.len(),
            Question::Which(k) => k.index() < self.attributes.len(),
            Question::Attribute(k, v) => {
                self.attributes.get(k.index()).is_some_and(|a| v.index() < a.values.len())
            }
            Question::Choice(k, options) => (self.attributes.get(k.index()))
                .is_some_and(|a| options.values().iter().all(|v| v.index() < a.values.len())),
        }
    }
}

fn index<'a, Id: From<usize>>(names: impl Iterator<Item = &'a String>) -> HashMap<String, Id> {
    names.enumerate().map(|(at, name)| (name.clone(), Id::from(at))).collect()
}

fn vocabularies(objects: &[Object], attributes: &[Attribute]) -> Vocabularies {
    let mut words = Vec::new();
    let mut ends = Vec::with_capacity(objects.len());
    let mut own = Vec::new();
    for object in objects {
        own.clear();
        let values = object.values.iter().zip(attributes);
        own.extend(values.filter_map(|(v, attribute)| v.map(|v| attribute.values[v.index()].word)));
        own.sort_unstable();
        own.dedup();
        words.extend_from_slice(&own);
        ends.push(words.len());
    }
    Vocabularies { words, ends }
}

/// Hash of objects, attributes and values in order. Every text is preceded by its length and
/// every list by its count, so that no two problems share a canonical form.
fn key(objects: &[Object], attributes: &[Attribute]) -> u64 {
    let mut hash = StableHash::default();
    hash.count(attributes.len());
    for attribute in attributes {
        hash.text(&attribute.name);
        hash.count(attribute.values.len());
        for value in &attribute.values {
            hash.text(&value.name);
        }
    }
    hash.count(objects.len());
    for object in objects {
        hash.text(&object.name);
        for value in &object.values {
            hash.count(value.map_or(0, |v| v.index() + 1));
        }
        for chance in object.chances.iter().flatten().flatten() {
            hash.number(*chance);
        }
    }
    hash.value()
}
