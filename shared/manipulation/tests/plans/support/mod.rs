//! Common parts of the tests of whole plans.
#![allow(dead_code, reason = "each user needs a part of it")]
#![allow(clippy::unwrap_used, reason = "a broken fixture ends the test")]

pub(crate) mod checker;
#[path = "../../../src/random.rs"]
mod random;
pub(crate) mod scenes;
pub(crate) mod solid;
pub(crate) mod tables;

use manipulation::Robot;
pub(crate) use random::Random;

impl Random {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Returns a file of the reference.
pub(crate) fn fixture(name: &str) -> String {
    let path = format!("{}/../../tests/fixtures/baxter/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns the shipped robot with one arm of six joints.
pub(crate) fn ur5e() -> Robot {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/robots/");
    let read = |name: &str| std::fs::read_to_string(format!("{folder}{name}")).unwrap();
    let description =
        robot_model::Robot::parse(&read("ur5e.urdf"), Some(&read("ur5e.srdf"))).unwrap();
    Robot::from_description(&description).unwrap()
}
