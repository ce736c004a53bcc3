//! How far the arms are from themselves, each other, the trunk and the surroundings.
//!
//! Enclosing capsules, boxes and balls: numbers from baxter_common 1.2.0, BSD-3-Clause,
//! Copyright (c) 2013-2015 Rethink Robotics. The arm's capsules enclose its visual meshes; the
//! description's own collision cylinders do not.

use nalgebra::Vector3;

use crate::chain::Frame;
use crate::limb::{Joints, Limb};
use crate::shape::{Capsule, Cuboid};

#[cfg(test)]
mod tests;

/// A capsule that moves with a link.
struct Enclosure {
    /// 0 upper shoulder to 6 wrist; the hand moves with the wrist.
    link: usize,
    name: &'static str,
    radius: f64,
    /// The ends of the axis in the description's link frame.
    a: [f64; 3],
    b: [f64; 3],
}

const fn enclosure(
    link: usize,
    name: &'static str,
    radius: f64,
    a: [f64; 3],
    b: [f64; 3],
) -> Enclosure {
    Enclosure { link, name, radius, a, b }
}

/// The arm's capsules, shoulder first.
#[rustfmt::skip]
const CAPSULES: [Enclosure; 15] = [
    enclosure(0, "upper_shoulder", 0.1466, [0.0213, -0.0001, 0.1436], [0.0719, 0.0, 0.3118]),
    enclosure(1, "lower_shoulder", 0.0792, [0.0006, 0.0001, -0.0644], [0.1082, 0.0002, -0.0094]),
    enclosure(1, "lower_shoulder", 0.0771, [0.1013, 0.0, 0.0307], [-0.0019, 0.0001, 0.0649]),
    enclosure(2, "upper_elbow", 0.0931, [0.0001, 0.0, 0.0701], [-0.0051, -0.0005, 0.1802]),
    enclosure(2, "upper_elbow", 0.0880, [-0.0246, 0.0002, 0.2403], [0.0516, 0.0003, 0.2539]),
    enclosure(3, "lower_elbow", 0.0739, [0.0002, 0.0007, -0.0599], [0.0614, -0.0018, -0.0333]),
    enclosure(3, "lower_elbow", 0.0733, [0.0, 0.0, 0.0598], [0.0707, 0.0, 0.0007]),
    enclosure(4, "upper_forearm", 0.0786, [-0.0115, -0.0001, 0.1602], [0.0, -0.0002, 0.023]),
    enclosure(4, "upper_forearm", 0.0555, [0.0017, -0.0089, 0.2574], [0.011, -0.0072, 0.272]),
    enclosure(5, "lower_forearm", 0.0752, [0.0035, -0.001, -0.0321], [0.0013, -0.0009, 0.0322]),
    enclosure(5, "lower_forearm", 0.0841, [0.107, -0.0006, 0.0002], [0.0806, -0.0005, 0.0015]),
    enclosure(6, "wrist", 0.0579, [-0.0001, 0.0, 0.067], [0.0175, -0.0007, 0.0958]),
    enclosure(6, "hand", 0.045, [0.0, 0.0, -0.03], [0.0, 0.0, 0.0]),
    enclosure(6, "hand", 0.060, [0.0, 0.0, 0.015], [0.0, 0.0, 0.075]),
    enclosure(6, "hand", 0.045, [0.0, 0.0, 0.075], [0.0, 0.0, 0.115]),
];

/// From the wrist frame to the hand frame, along z, metres.
const HAND_M: f64 = 0.11355;

/// The first of the arm's capsules that can come near the trunk or the head.
const FIRST_LOOSE: usize = 3;

/// Capsules of links two joints apart that overlap by construction.
const ALWAYS_TOUCHING: [(usize, usize); 2] = [(0, 3), (4, 7)];

/// Torso and pedestal as boxes in `base`.
const TRUNK: [(&str, Cuboid); 7] = [
    ("torso", Cuboid::aligned([-0.008, 0.0, -0.0315], [0.38, 0.41, 0.06])),
    ("torso", Cuboid::aligned([-0.009, 0.0, 0.1185], [0.418, 0.672, 0.24])),
    ("torso", Cuboid::aligned([-0.0475, 0.0, 0.4185], [0.341, 0.452, 0.36])),
    ("torso", Cuboid::aligned([-0.1115, 0.0, 0.6285], [0.145, 0.112, 0.06])),
    ("torso", Cuboid::aligned([-0.006, 0.0, 0.767], [0.296, 0.164, 0.217])),
    ("pedestal", Cuboid::aligned([-0.0425, 0.0, -0.7672], [0.919, 0.832, 0.314])),
    ("pedestal", Cuboid::aligned([0.0, 0.0, -0.3359], [0.324, 0.322, 0.5487])),
];

/// The head, wherever it looks, as two balls in `base`.
const HEAD: [[f64; 3]; 2] = [[0.04, -0.04, 0.75], [0.04, 0.04, 0.75]];
const HEAD_RADIUS_M: f64 = 0.22;

/// The smallest distance between two groups of shapes, and which they are; or, where nothing is
/// nearer than what was asked about, that distance and no names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Signed distance, metres; negative where they overlap.
    pub distance_m: f64,
    /// The link of the arm.
    pub link: &'static str,
    /// What it is near to.
    pub other: &'static str,
}

/// One arm's enclosing capsules at one posture, in `base`.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmShape {
    capsules: [Capsule; 15],
    /// A ball round each capsule.
    balls: [Ball; 15],
}

/// A ball that encloses a shape: two shapes are no nearer than their balls.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball {
    centre: Vector3<f64>,
    radius: f64,
}

impl Ball {
    fn round_capsule(capsule: &Capsule) -> Self {
        let half = (capsule.b - capsule.a) * 0.5;
        Self { centre: capsule.a + half, radius: half.norm() + capsule.radius }
    }

    fn round_cuboid(cuboid: &Cuboid) -> Self {
        let radius = 0.5 * Vector3::from(cuboid.size).norm();
        Self { centre: Vector3::from(cuboid.centre), radius }
    }

    /// Whether the shapes in two balls may be nearer than `distance_m`.
    #[inline]
    fn may_be_nearer(&self, other: &Self, distance_m: f64) -> bool {
        let reach = self.radius + other.radius + distance_m;
        reach > 0.0 && (self.centre - other.centre).norm_squared() < reach * reach
    }
}

impl Gap {
    /// Nothing is nearer than `distance_m`.
    pub const fn none(distance_m: f64) -> Self {
        Self { distance_m, link: "", other: "" }
    }

    /// Whether something was found.
    pub fn is_some(&self) -> bool {
        !self.link.is_empty()
    }

    /// The smaller of two gaps.
    pub fn min(self, other: Self) -> Self {
        if other.distance_m < self.distance_m { other } else { self }
    }

    fn at(distance_m: f64, capsule: usize, other: &'static str) -> Self {
        Self { distance_m, link: CAPSULES[capsule].name, other }
    }
}

impl ArmShape {
    /// The arm at joint positions `q`.
    pub fn at(limb: Limb, q: &Joints) -> Self {
        let frames = limb.chain().frames(q);
        let capsules = CAPSULES.map(|Enclosure { link, name, radius, a, b }| {
            let lift = if name == "hand" { HAND_M } else { 0.0 };
            let end = |p: [f64; 3]| placed(&frames[link], link, [p[0], p[1], p[2] + lift]);
            Capsule { a: end(a), b: end(b), radius }
        });
        let balls = std::array::from_fn(|i| Ball::round_capsule(&capsules[i]));
        Self { capsules, balls }
    }

    /// The enclosing capsules, shoulder first.
    pub fn capsules(&self) -> &[Capsule] {
        &self.capsules
    }

    /// Gap between links of this arm that are at least two joints apart, if it is below `within_m`.
    pub fn to_itself(&self, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        for (i, own) in CAPSULES.iter().enumerate() {
            for (j, other) in CAPSULES.iter().enumerate().skip(i + 1) {
                if other.link >= own.link + 2
                    && !ALWAYS_TOUCHING.contains(&(i, j))
                    && self.balls[i].may_be_nearer(&self.balls[j], gap.distance_m)
                {
                    let distance = self.capsules[i].to_capsule(&self.capsules[j]);
                    gap = gap.min(Gap::at(distance, i, other.name));
                }
            }
        }
        gap
    }

    /// Gap to the other arm, if it is below `within_m`.
    pub fn to_arm(&self, other: &Self, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        for (i, (own, ball)) in self.capsules.iter().zip(&self.balls).enumerate() {
            for (j, theirs) in other.capsules.iter().enumerate() {
                if ball.may_be_nearer(&other.balls[j], gap.distance_m) {
                    gap = gap.min(Gap::at(own.to_capsule(theirs), i, CAPSULES[j].name));
                }
            }
        }
        gap
    }

    /// Gap to torso, pedestal and head, if it is below `within_m`.
    pub fn to_trunk(&self, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        for (name, cuboid) in &TRUNK {
            gap = gap.min(self.to_cuboid_from(FIRST_LOOSE, name, cuboid, gap.distance_m));
        }
        for (i, own) in self.capsules.iter().enumerate().skip(FIRST_LOOSE) {
            for centre in HEAD {
                let distance = own.to_ball(&Vector3::from(centre), HEAD_RADIUS_M);
                gap = gap.min(Gap::at(distance, i, "head"));
            }
        }
        gap
    }

    /// Gap between the whole arm and a box of the surroundings, if it is below `within_m`.
    pub fn to_cuboid(&self, name: &'static str, cuboid: &Cuboid, within_m: f64) -> Gap {
        self.to_cuboid_from(0, name, cuboid, within_m)
    }

    fn to_cuboid_from(
        &self,
        first: usize,
        name: &'static str,
        cuboid: &Cuboid,
        within_m: f64,
    ) -> Gap {
        let round = Ball::round_cuboid(cuboid);
        let mut gap = Gap::none(within_m);
        for (i, own) in self.capsules.iter().enumerate().skip(first) {
            if self.balls[i].may_be_nearer(&round, gap.distance_m) {
                gap = gap.min(Gap::at(own.to_cuboid(cuboid), i, name));
            }
        }
        gap
    }
}

/// A point of a description link frame in `base`. The frames of the odd joints are permuted: see
/// [`crate::Chain::frames`].
fn placed(frame: &Frame, link: usize, [x, y, z]: [f64; 3]) -> Vector3<f64> {
    frame.point(if link % 2 == 1 { [y, z, x] } else { [x, y, z] })
}

/// Both arms' clearances by group, metres, negative where shapes overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Arm to arm.
    pub left_right: Gap,
    /// Left arm to torso, pedestal and head.
    pub left_body: Gap,
    /// Right arm to torso, pedestal and head.
    pub right_body: Gap,
    /// Left arm to itself.
    pub left_self: Gap,
    /// Right arm to itself.
    pub right_self: Gap,
    /// Left arm to the nearest of the surroundings.
    pub left_surroundings: Gap,
    /// Right arm to the nearest of the surroundings.
    pub right_surroundings: Gap,
}

impl Clearance {
    /// Clearances with the arms at `left` and `right` among `surroundings`.
    pub fn of(left: &Joints, right: &Joints, surroundings: &[Cuboid]) -> Self {
        let (left, right) = (ArmShape::at(Limb::Left, left), ArmShape::at(Limb::Right, right));
        let around = |arm: &ArmShape| {
            surroundings.iter().fold(Gap::none(f64::INFINITY), |gap, cuboid| {
                gap.min(arm.to_cuboid("surroundings", cuboid, gap.distance_m))
            })
        };
        Self {
            left_right: left.to_arm(&right, f64::INFINITY),
            left_body: left.to_trunk(f64::INFINITY),
            right_body: right.to_trunk(f64::INFINITY),
            left_self: left.to_itself(f64::INFINITY),
            right_self: right.to_itself(f64::INFINITY),
            left_surroundings: around(&left),
            right_surroundings: around(&right),
        }
    }

    /// The smallest gap within the robot.
    pub fn robot(&self) -> Gap {
        [self.left_body, self.right_body, self.left_self, self.right_self]
            .into_iter()
            .fold(self.left_right, Gap::min)
    }
}
