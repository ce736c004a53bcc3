//! Fixed layouts in serde, for files and for people: field by field.
//!
//! A binary format gets the used part of each array: elements at its end that are all zeros are
//! left out, so that a message takes only the space of its content. A message read back has the
//! same bytes, except those behind the end of a [`FixedText`], which no reader sees.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::FixedText;
use crate::fixed::Pcm;
use crate::wire::{Code, WireCode};

/// Longest array of which people see the zeros at its end.
const WHOLE_MAX: usize = 8;

/// A field of a fixed layout.
pub(crate) trait WireSerde: Copy {
    /// Returns the value whose bytes are zero.
    fn zero() -> Self;

    /// Returns whether every byte is zero.
    fn is_zero(&self) -> bool;

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;
}

/// For `#[serde(with)]`.
pub(crate) fn serialize<T: WireSerde, S: Serializer>(
    field: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    field.write(serializer)
}

/// For `#[serde(with)]`.
pub(crate) fn deserialize<'de, T: WireSerde, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    T::read(deserializer)
}

macro_rules! numbers {
    ($($number:ty)+) => {
        $(impl WireSerde for $number {
            fn zero() -> Self {
                Self::default()
            }

            fn is_zero(&self) -> bool {
                // Not `== 0.0`, which holds for a negative zero too.
                self.to_ne_bytes() == [0; size_of::<$number>()]
            }

            fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.serialize(serializer)
            }

            fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                Self::deserialize(deserializer)
            }
        })+
    };
}
numbers! { u8 u16 u32 u64 i16 i32 f32 f64 }

/// An array element in its serde form.
struct Element<T>(T);

impl<T: WireSerde> Serialize for Element<&T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.write(serializer)
    }
}

impl<'de, T: WireSerde> Deserialize<'de> for Element<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::read(deserializer).map(Self)
    }
}

impl<T: WireSerde, const N: usize> WireSerde for [T; N] {
    fn zero() -> Self {
        [T::zero(); N]
    }

    fn is_zero(&self) -> bool {
        self.iter().all(T::is_zero)
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let used = match serializer.is_human_readable() && N <= WHOLE_MAX {
            true => N,
            false => self.iter().rposition(|element| !element.is_zero()).map_or(0, |last| last + 1),
        };
        let mut sequence = serializer.serialize_seq(Some(used))?;
        self[..used]
            .iter()
            .try_for_each(|element| sequence.serialize_element(&Element(element)))?;
        sequence.end()
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ArrayVisitor(PhantomData))
    }
}

struct ArrayVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: WireSerde, const N: usize> Visitor<'de> for ArrayVisitor<T, N> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at most {N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
        let mut array = [T::zero(); N];
        let mut slots = array.iter_mut();
        while let Some(Element(element)) = elements.next_element()? {
            let slot = slots.next().ok_or_else(|| A::Error::invalid_length(N + 1, &self))?;
            *slot = element;
        }
        Ok(array)
    }
}

/// A byte in binary formats; for people the variant's name, or the number of an invalid code.
impl<E: WireCode> WireSerde for Code<E> {
    fn zero() -> Self {
        Self::default()
    }

    fn is_zero(&self) -> bool {
        self.raw() == 0
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let known = E::CODES.iter().find(|(.., code)| *code == self.raw());
        match known.filter(|_| serializer.is_human_readable()) {
            Some((_, name, _)) => serializer.serialize_str(name),
            None => serializer.serialize_u8(self.raw()),
        }
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match deserializer.is_human_readable() {
            true => deserializer.deserialize_any(CodeVisitor(PhantomData)),
            false => u8::deserialize(deserializer).map(Self::from_raw),
        }
    }
}

struct CodeVisitor<E>(PhantomData<E>);

impl<E: WireCode> Visitor<'_> for CodeVisitor<E> {
    type Value = Code<E>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a {} by name or number", E::NAME)
    }

    fn visit_u64<X: Error>(self, code: u64) -> Result<Self::Value, X> {
        u8::try_from(code).map(Code::from_raw).map_err(X::custom)
    }

    fn visit_str<X: Error>(self, name: &str) -> Result<Self::Value, X> {
        let known = E::CODES.iter().find(|(_, known, _)| *known == name);
        let (.., code) = known.ok_or_else(|| X::custom(format!("no {} `{name}`", E::NAME)))?;
        Ok(Code::from_raw(*code))
    }
}

struct Bytes<'a>(&'a [u8]);

impl Serialize for Bytes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self.0)
    }
}

/// The used bytes with the length, which may be invalid; text for people.
impl<const N: usize> WireSerde for FixedText<N> {
    fn zero() -> Self {
        Self::default()
    }

    fn is_zero(&self) -> bool {
        self.raw_len() == 0
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            return serializer.serialize_str(&String::from_utf8_lossy(self.used()));
        }
        (self.raw_len(), Bytes(self.used())).serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return Self::new(&String::deserialize(deserializer)?).map_err(D::Error::custom);
        }
        let (len, bytes) = <(u32, &[u8])>::deserialize(deserializer)?;
        Self::from_raw(len, bytes).map_err(D::Error::custom)
    }
}

impl<const N: usize> WireSerde for Pcm<N> {
    fn zero() -> Self {
        Self::default()
    }

    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.write(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        <[i16; N]>::read(deserializer).map(Self)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use crate::{AskedQuestion, Code, FixedText, Observation, RobotAct, WireReading};
    use scene::Role;

    fn full() -> Observation {
        let reading = WireReading { weight: 0.75, base: [3; _], ..WireReading::default() };
        let mut observation = Observation {
            seq: 7,
            reading_count: 2,
            unknown: FixedText::truncated("Teller ß"),
            unknown_role: Code::from_raw(200),
            ..Observation::default()
        };
        observation.readings[1] = reading;
        observation.readings[1].base_doubt[2] = -0.0;
        observation.asked[0] = AskedQuestion { prompt: u64::MAX, ..AskedQuestion::default() };
        observation
    }

    #[test]
    fn message_takes_the_space_of_what_it_says_and_comes_back_the_same() {
        let observation = full();
        let bytes = postcard::to_stdvec(&observation).unwrap();
        assert!(bytes.len() < 400, "{} bytes", bytes.len());
        let back: Observation = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(back, observation);
        assert_eq!(back.unknown_role, Code::<Role>::from_raw(200));
        assert!(back.readings[1].base_doubt[2].is_sign_negative());
        assert_eq!(postcard::to_stdvec(&back).unwrap(), bytes);
    }

    #[test]
    fn message_has_names_for_people_and_comes_back_the_same() {
        let mut observation = full();
        observation.unknown_role = Role::Place.into();
        let json = serde_json::to_value(observation).unwrap();
        assert_eq!(json["unknown"], "Teller ß");
        assert_eq!(json["unknown_role"], "Place");
        assert_eq!(json["readings"][1]["weight"], 0.75);
        assert_eq!(serde_json::from_value::<Observation>(json).unwrap(), observation);
    }

    #[test]
    fn invalid_text_stays_invalid_and_too_much_is_refused() {
        let mut bytes = postcard::to_stdvec(&FieldOf(FixedText::<4>::truncated("ab"))).unwrap();
        bytes[0] = 9;
        let FieldOf(text) = postcard::from_bytes(&bytes).unwrap();
        let error = text.as_str().unwrap_err().to_string();
        assert_eq!(error, "invalid text length 9 on the wire");
        assert_eq!(postcard::to_stdvec(&FieldOf(text)).unwrap()[0], 9);
        let long = postcard::to_stdvec(&(5_u32, b"abcde".as_slice())).unwrap();
        assert!(postcard::from_bytes::<FieldOf>(&long).is_err());
        let acts = postcard::to_stdvec(&RobotAct::default()).unwrap();
        assert!(postcard::from_bytes::<RobotAct>(&acts[1..]).is_err());
    }

    #[derive(serde::Serialize, serde::Deserialize)]
    struct FieldOf(#[serde(with = "super")] FixedText<4>);
}
