//! The values that a choice question names.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::ValueId;

/// Two to four values of one attribute, in the attribute's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// The first `count` are in use, the others zero.
    values: [ValueId; Self::MAX],
    count: u8,
}

impl Options {
    /// Most values that people keep in mind.
    pub const MAX: usize = 4;
    /// Values from this one on are not offered: messages have a byte for each.
    pub const VALUES_MAX: u16 = 255;

    /// Sorts the values; `None` unless there are two to four different ones, below `VALUES_MAX`.
    pub fn new(values: &[ValueId]) -> Option<Self> {
        Self::of(values).filter(|options| options.count >= 2)
    }

    /// Sorts one to four different values.
    fn of(values: &[ValueId]) -> Option<Self> {
        let mut kept = [ValueId(0); Self::MAX];
        kept.get_mut(..values.len())?.copy_from_slice(values);
        let used = &mut kept[..values.len()];
        used.sort_unstable();
        let last = used.last().is_some_and(|last| last.0 < Self::VALUES_MAX);
        let differ = last && used.windows(2).all(|pair| pair[0] != pair[1]);
        differ.then_some(Self { values: kept, count: values.len() as u8 })
    }

    /// The values, in the attribute's order, which is the order in which they are said.
    pub fn values(&self) -> &[ValueId] {
        &self.values[..usize::from(self.count)]
    }

    /// Returns true if the value is one of the options.
    pub fn contains(&self, value: ValueId) -> bool {
        self.values().contains(&value)
    }
}

impl Serialize for Options {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.values().serialize(to)
    }
}

impl<'de> Deserialize<'de> for Options {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let values: Vec<ValueId> = Vec::deserialize(from)?;
        let what =
            || format!("expected up to 4 different values of an attribute, found {values:?}");
        // Schemas are derived from reading lists of one.
        Self::of(&values).ok_or_else(|| serde::de::Error::custom(what()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_two_to_four_different_values_in_order() {
        let of = |values: &[u16]| {
            let values: Vec<ValueId> = values.iter().copied().map(ValueId).collect();
            Options::new(&values)
        };
        for wrong in [&[][..], &[1], &[1, 1], &[0, 1, 2, 3, 4], &[2, 0, 2], &[0, 255]] {
            assert_eq!(of(wrong), None, "{wrong:?}");
        }
        let three = of(&[7, 0, 3]).unwrap();
        assert_eq!(three, of(&[0, 3, 7]).unwrap());
        assert_eq!(three.values(), [0, 3, 7].map(ValueId));
        assert!(three.contains(ValueId(3)) && !three.contains(ValueId(1)));
        let text = serde_json::to_string(&three).unwrap();
        assert_eq!(text, "[0,3,7]");
        assert_eq!(serde_json::from_str::<Options>(&text).unwrap(), three);
        assert!(serde_json::from_str::<Options>("[0,0]").is_err());
    }
}
