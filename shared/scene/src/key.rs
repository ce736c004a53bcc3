//! The identity of a decision problem: 64-bit FNV-1a over its canonical form.

use crate::{Attribute, Object};

/// Hash of objects, attributes and values in order. Every text is preceded by its length and
/// every list by its count, so that no two problems share a canonical form.
pub(crate) fn of(objects: &[Object], attributes: &[Attribute]) -> u64 {
    let mut hash = Fnv1a::new();
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
    hash.0
}

/// 64-bit FNV-1a: small, stable, the same on every machine; to tell honest differences apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fnv1a(u64);

impl Default for Fnv1a {
    fn default() -> Self {
        Self::new()
    }
}

impl Fnv1a {
    /// Nothing hashed yet.
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// The hash of everything so far.
    pub fn value(self) -> u64 {
        self.0
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn count(&mut self, count: usize) {
        self.bytes(&(count as u64).to_le_bytes());
    }

    /// Takes in a text and its length.
    pub fn text(&mut self, text: &str) {
        self.count(text.len());
        self.bytes(text.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::Fnv1a;

    #[test]
    fn agrees_with_the_published_test_vectors() {
        for (text, expected) in [("", 0xcbf2_9ce4_8422_2325), ("foobar", 0x8594_4171_f739_67e8)] {
            let mut hash = Fnv1a::new();
            hash.bytes(text.as_bytes());
            assert_eq!(hash.0, expected, "{text}");
        }
    }
}
