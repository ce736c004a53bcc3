//! Samples for tests: random postures and the reference rows.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::kinematics::limb::{Joints, Limb};
use crate::kinematics::limits::MotionLimits;
use crate::robot::{Arm, Robot};

pub(crate) use crate::random::Random;

impl Random {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn limb(&mut self) -> Limb {
        if self.unit() < 0.5 { Limb::Left } else { Limb::Right }
    }

    /// Returns a posture within the limits; now and then a joint is exactly at one.
    pub(crate) fn posture(&mut self) -> Joints {
        full().position.0.map(|(lower, upper)| match self.unit() {
            x if x < 0.01 => lower,
            x if x > 0.99 => upper,
            _ => self.between(lower, upper),
        })
    }
}

/// Returns the robot of the tests.
pub(crate) fn robot() -> &'static Robot {
    Robot::baxter()
}

pub(crate) fn arm(limb: Limb) -> &'static Arm {
    robot().arm(limb)
}

/// Motion limits of its joints.
pub(crate) fn full() -> MotionLimits {
    arm(Limb::Left).limits
}

/// Returns the limb at rest.
pub(crate) fn neutral() -> Joints {
    arm(Limb::Left).neutral
}

/// Returns a posture by its name in the description.
pub(crate) fn named(limb: Limb, name: &str) -> Joints {
    let description = robot().description();
    let posture = description.posture(&format!("{limb}_arm"), name).expect("a described posture");
    let names = &arm(limb).joint_names;
    std::array::from_fn(|i| {
        let joint = description.joint(&names[i]).expect("a joint");
        posture.position(joint.child - 1).expect("its position")
    })
}

/// Returns a file of the reference.
pub(crate) fn fixture(name: &str) -> String {
    let path = format!("{}/../../tests/fixtures/baxter/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Column names and rows of a CSV fixture.
pub(crate) fn table(name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fixture(name);
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (lines.next().expect("a header"), lines.collect())
}

pub(crate) fn numbers(fields: &[String]) -> Vec<f64> {
    fields.iter().map(|field| field.parse().unwrap()).collect()
}

/// x y z, then the quaternion x y z w.
pub(crate) fn pose(n: &[f64]) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(n[0], n[1], n[2]),
        UnitQuaternion::new_normalize(Quaternion::new(n[6], n[3], n[4], n[5])),
    )
}

pub(crate) fn joints(numbers: &[f64]) -> Joints {
    numbers.try_into().expect("seven numbers")
}

/// Returns the greatest difference of any number of two poses, quaternions compared as they are.
pub(crate) fn difference(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    let translation = (a.translation.vector - b.translation.vector).amax();
    translation.max((a.rotation.coords - b.rotation.coords).amax())
}
