//! Where arms work: ahead of a table, or on it.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::gripper::Gripper;
use crate::source::Source;
use crate::structure::Arm;
use crate::write::Import;

/// An arm shorter than this that stands on the table has it all around, metres from its first joint to its fingertips.
const SMALL_M: f64 = 0.6;

/// Where an arm works, by its size; metres.
#[derive(Debug, PartialEq)]
pub(crate) struct Site {
    /// Near edge of the table in frame base.
    pub(crate) near_m: f64,
    /// The first places that are looked at, in x, and the distance of neighbours.
    pub(crate) from_m: f64,
    pub(crate) grid_m: f64,
    /// Height of the hover above a grasp, and of a grasp above the table.
    pub(crate) hover_m: f64,
    pub(crate) grasp_m: f64,
    /// Distance from which the gripper points at an object.
    pub(crate) standoff_m: f64,
    /// Heights above the table at which the arm may rest, and of the hand-over.
    pub(crate) rest_m: [f64; 5],
    pub(crate) hand_over_m: [f64; 2],
    /// Distance between the middles of two blocks at least; widths of a small and of a large block at most, and
    /// masses, kilograms.
    pub(crate) apart_m: f64,
    pub(crate) widths_m: [f64; 2],
    pub(crate) masses_kg: [f64; 2],
}

impl Site {
    /// A table ahead of the robot.
    pub(crate) const USUAL: Self = Self {
        near_m: 0.4,
        from_m: 0.45,
        grid_m: 0.06,
        hover_m: 0.15,
        grasp_m: 0.02,
        standoff_m: 0.25,
        rest_m: [0.30, 0.36, 0.25, 0.42, 0.50],
        hand_over_m: [0.25, 0.2],
        apart_m: 0.14,
        widths_m: [0.03, 0.045],
        masses_kg: [0.02, 0.1],
    };

    /// The table on which a small arm stands.
    pub(crate) const SMALL: Self = Self {
        near_m: -0.6,
        from_m: 0.09,
        grid_m: 0.025,
        hover_m: 0.045,
        grasp_m: 0.014,
        standoff_m: 0.12,
        rest_m: [0.075, 0.065, 0.08, 0.055, 0.1],
        hand_over_m: [0.12, 0.09],
        apart_m: 0.075,
        widths_m: [0.02, 0.026],
        masses_kg: [0.01, 0.03],
    };

    pub(crate) fn is_small(&self) -> bool {
        self.near_m < 0.0
    }
}

/// Returns where an arm works, which stands on the table or not.
pub(crate) fn of(import: &Import<'_>, stands: bool) -> &'static Site {
    let at = |link: usize| import.rest[link].translation.vector;
    let joints = import.arm.joints.iter().map(|joint| at(import.source.joints[*joint].child));
    let tip = (import.rest[import.arm.last] * import.gripper.frame).translation.vector;
    let places: Vec<_> = joints.chain([tip]).collect();
    let long_m: f64 = places.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum();
    if stands && long_m < SMALL_M { &Site::SMALL } else { &Site::USUAL }
}

/// Returns the turn about the vertical after which an arm of five joints works ahead of frame base, to a quarter turn.
pub(crate) fn ahead(
    source: &Source,
    arm: &Arm,
    gripper: &Gripper,
    rest: &[Isometry3<f64>],
) -> UnitQuaternion<f64> {
    if arm.joints.len() != 5 {
        return UnitQuaternion::identity();
    }
    let tip = (rest[arm.last] * gripper.frame).translation.vector;
    let out = tip - rest[source.joints[arm.joints[0]].child].translation.vector;
    let quarter = std::f64::consts::FRAC_PI_2;
    UnitQuaternion::from_axis_angle(
        &Vector3::z_axis(),
        (out.y.atan2(out.x) / quarter).round() * quarter,
    )
}
