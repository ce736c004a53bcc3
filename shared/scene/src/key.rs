//! Identity of a decision problem: a hash of its canonical form.

use crate::{Attribute, Object, StableHash};

/// Hash of objects, attributes and values in order. Every text is preceded by its length and
/// every list by its count, so that no two problems share a canonical form.
pub(crate) fn of(objects: &[Object], attributes: &[Attribute]) -> u64 {
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
    }
    hash.value()
}
