//! Objects in words, as a person would name them.

use std::cmp::Reverse;

use crate::forms::{definite, is_number, is_owner, measured};
use crate::plural::plural;
use crate::{AttributeId, ObjectId, Role, Scene, Value, ValueId};

/// Most attributes of which pairs are tried; beyond them the most telling value is taken first.
const PAIRED_MAX: usize = 24;

type Values = Vec<(AttributeId, ValueId)>;

impl Scene {
    /// Describes the object in words that fit no other object, e.g. `white bowl in the dishwasher`:
    /// the kind of thing that it is, with as few of its values as tell it apart, qualities before
    /// places. If no values do, all values that help are used.
    pub fn describe(&self, object: ObjectId) -> String {
        let all: Vec<ObjectId> = self.ids().collect();
        self.describe_among(object, &all)
    }

    /// Describes the object in words that fit none of these others; itself does not count.
    pub fn describe_among(&self, object: ObjectId, others: &[ObjectId]) -> String {
        let kind = self.kind(object);
        let alike = |&i: &ObjectId| i != object && kind.is_none_or(|(k, v)| self.has(i, k, v));
        let rivals: Vec<ObjectId> = others.iter().copied().filter(alike).collect();
        let mut chosen = self.telling(object, &rivals);
        chosen.extend(kind);
        chosen.sort_unstable();
        self.compose(&chosen)
    }

    /// Describes the object with one quality even if none is needed: people name conspicuous ones.
    fn describe_with_quality(&self, object: ObjectId, others: &[ObjectId]) -> String {
        let kind = self.kind(object);
        let alike = |&i: &ObjectId| i != object && kind.is_none_or(|(k, v)| self.has(i, k, v));
        let rivals: Vec<ObjectId> = others.iter().copied().filter(alike).collect();
        let is_quality = |&(k, v): &(AttributeId, ValueId)| {
            let is_shared = (0..self.objects().len()).all(|i| self.has(i.into(), k, v));
            self.value(k, v).role() == Role::Quality && !is_shared
        };
        let mut chosen = self.telling(object, &rivals);
        if !chosen.iter().any(is_quality) {
            chosen.extend(self.values_of(object).find(is_quality));
            if let Some(quality) = chosen.last().filter(|chosen| is_quality(chosen)).copied() {
                let left: Vec<ObjectId> =
                    rivals.into_iter().filter(|&i| self.has(i, quality.0, quality.1)).collect();
                chosen = [self.telling(object, &left), vec![quality]].concat();
            }
        }
        chosen.extend(kind);
        chosen.sort_unstable();
        chosen.dedup();
        self.compose(&chosen)
    }

    /// The objects as a choice or an enumeration, each distinct from the others: `the red mug, the
    /// blue mug or the white cup` for "or". Objects that no words distinguish are named once.
    pub fn list(&self, objects: &[ObjectId], conjunction: &str) -> String {
        let mut names: Vec<String> = Vec::new();
        for &object in objects {
            let name = definite(&self.describe_with_quality(object, objects));
            if !names.contains(&name) {
                names.push(name);
            }
        }
        enumerate(&names, conjunction)
    }

    /// The noun for an object: its kind, or else the scene's noun.
    pub fn noun_of(&self, object: ObjectId) -> &str {
        self.kind(object).map_or(self.noun(), |(k, v)| self.value(k, v).bare())
    }

    /// The nouns for these objects in plural, each once: `mugs and cups`.
    pub fn plural_nouns(&self, objects: &[ObjectId]) -> String {
        let mut nouns: Vec<String> = Vec::new();
        for &object in objects {
            let noun = plural(self.noun_of(object));
            if !nouns.contains(&noun) {
                nouns.push(noun);
            }
        }
        enumerate(&nouns, "and")
    }

    fn value(&self, k: AttributeId, v: ValueId) -> &Value {
        &self.attributes()[k.index()].values[v.index()]
    }

    /// The values of an object by attribute.
    fn values_of(&self, object: ObjectId) -> impl Iterator<Item = (AttributeId, ValueId)> + '_ {
        let values = self.object(object).values.iter().enumerate();
        values.filter_map(|(k, v)| Some((AttributeId::from(k), (*v)?)))
    }

    fn kind(&self, object: ObjectId) -> Option<(AttributeId, ValueId)> {
        self.values_of(object).find(|&(k, v)| self.value(k, v).role() == Role::Kind)
    }

    /// Returns whether an object has a value, or may be said to have it: one that is like no other
    /// is in no row, and may be further left than the left one of a row.
    fn may_have(&self, i: ObjectId, k: AttributeId, v: ValueId) -> bool {
        let is_in_none = || self.object(i).values[k.index()].is_none();
        self.has(i, k, v) || self.attributes()[k.index()].by_place && is_in_none()
    }

    /// Returns the smallest set of values that no rival shares, or else the values that exclude
    /// any.
    fn telling(&self, object: ObjectId, rivals: &[ObjectId]) -> Values {
        if rivals.is_empty() {
            return Vec::new();
        }
        let is_place = |&(k, v): &(AttributeId, ValueId)| {
            matches!(self.value(k, v).role(), Role::Place | Role::Part)
        };
        let mut values: Values = self
            .values_of(object)
            .filter(|&(k, v)| self.value(k, v).role() != Role::Kind)
            .filter(|&(k, v)| rivals.iter().any(|&i| !self.may_have(i, k, v)))
            .collect();
        values.sort_by_key(is_place);
        let unique = |chosen: &[(AttributeId, ValueId)]| {
            !rivals.iter().any(|&i| chosen.iter().all(|&(k, v)| self.may_have(i, k, v)))
        };
        if let Some(one) = values.iter().find(|&&one| unique(&[one])) {
            return vec![*one];
        }
        if values.len() <= PAIRED_MAX {
            for (n, &one) in values.iter().enumerate() {
                if let Some(&other) = values[n + 1..].iter().find(|&&other| unique(&[one, other])) {
                    return vec![one, other];
                }
            }
        }
        self.most_telling(&values, rivals.to_vec())
    }

    /// One after the other the value that the fewest of the remaining rivals share.
    fn most_telling(&self, values: &[(AttributeId, ValueId)], mut rivals: Vec<ObjectId>) -> Values {
        let mut chosen = Values::new();
        loop {
            let left = values.iter().enumerate().map(|(n, &(k, v))| {
                (rivals.iter().filter(|&&i| self.may_have(i, k, v)).count(), n)
            });
            let Some((_, best)) = left.min().filter(|(left, _)| *left < rivals.len()) else {
                return chosen;
            };
            let (k, v) = values[best];
            rivals.retain(|&i| self.may_have(i, k, v));
            chosen.push((k, v));
        }
    }

    /// Returns these values as a description, `Anna's red mug on the shelf`; the noun is their
    /// kind, or else the scene's noun.
    pub fn compose(&self, values: &[(AttributeId, ValueId)]) -> String {
        let kind = values.iter().map(|&(k, v)| self.value(k, v)).find(|v| v.role() == Role::Kind);
        self.compose_around(kind.map_or(self.noun(), Value::bare), values)
    }

    /// Returns values around a noun: owners, qualities, numbers, the noun, then parts and places.
    pub fn compose_around(&self, noun: &str, values: &[(AttributeId, ValueId)]) -> String {
        let valued = |&(k, v): &(AttributeId, ValueId)| (k, self.value(k, v));
        let all: Vec<(AttributeId, &Value)> = values.iter().map(valued).collect();
        let of = |role: Role| all.iter().filter(move |(_, value)| value.role() == role);
        let mut qualities: Vec<(AttributeId, &Value)> = of(Role::Quality).copied().collect();
        // The last attribute is said first; two values of one keep their order.
        qualities.sort_by_key(|(k, value)| {
            (!is_owner(&value.spoken), is_number(&value.spoken), Reverse(*k))
        });
        let quality = |(k, value): &(AttributeId, &Value)| match is_number(&value.spoken) {
            true => format!("{} {}", self.attributes()[k.index()].name, value.spoken),
            false => measured(&value.spoken).unwrap_or_else(|| value.spoken.clone()),
        };
        let before = qualities.iter().map(quality);
        let after = of(Role::Part).chain(of(Role::Place)).map(|(_, value)| value.after_noun());
        before.chain([noun.to_owned()]).chain(after).collect::<Vec<_>>().join(" ")
    }
}

/// `a`, `a or b`, `a, b or c`.
pub(crate) fn enumerate(names: &[String], conjunction: &str) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => {
            format!("{} {conjunction} {last}", first.join(", "))
        }
        _ => names.concat(),
    }
}
