//! Sound as flights hold it: its length. The reducer passes sound on without a look at its samples,
//! so the length is all that a replay needs; and people's voices stay out of unknown files.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Longest sound, samples: an hour. A damaged length must not ask for all of the memory.
const SAMPLES_MAX: u64 = 3600 * 16_000;

/// For `#[serde(with)]`.
pub fn serialize<S: Serializer>(samples: &[i16], serializer: S) -> Result<S::Ok, S::Error> {
    (samples.len() as u64).serialize(serializer)
}

/// For `#[serde(with)]`: silence of the same length.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<i16>, D::Error> {
    match u64::deserialize(deserializer)? {
        samples @ ..=SAMPLES_MAX => Ok(vec![0; samples as usize]),
        samples => Err(D::Error::custom(format!("a sound of {samples} samples"))),
    }
}
