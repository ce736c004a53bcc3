//! Random numbers and reference files for tests.

use std::path::Path;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// A small generator (xorshift); tests name its seed when they fail.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((self.next() >> 33) as usize) % n.max(1)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1u64 << 53) as f64)
    }
}

/// A file of `tests/fixtures`.
pub(crate) fn fixture(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub(crate) fn facts() -> toml::Table {
    fixture("baxter/baxter_facts.toml").parse().unwrap()
}

/// The numbers of an array.
pub(crate) fn numbers(value: &toml::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_float().unwrap()).collect()
}

/// x y z, then the quaternion x y z w.
pub(crate) fn pose(n: &[f64]) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(n[0], n[1], n[2]),
        UnitQuaternion::new_normalize(Quaternion::new(n[6], n[3], n[4], n[5])),
    )
}

/// The greatest difference of any number of two poses, quaternions compared as they are.
pub(crate) fn difference(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    let translation = (a.translation.vector - b.translation.vector).amax();
    translation.max((a.rotation.coords - b.rotation.coords).amax())
}
