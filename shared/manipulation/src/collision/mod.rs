//! Collision checking: distances of the arms from themselves, each other, the body and obstacles.

use nalgebra::Vector3;

use crate::kinematics::limb::{Joints, Limb};
use crate::robot::{Arm, Robot};
pub use shape::{Capsule, Cuboid};

pub(crate) mod block;
mod shape;
#[cfg(test)]
mod tests;

/// The smallest distance between two groups of shapes, and which they are; or, where nothing is
/// nearer than what was asked about, that distance and no names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Signed distance, metres; negative where they overlap.
    pub distance_m: f64,
    /// The link of the arm.
    pub link: &'static str,
    /// The nearest shape.
    pub other: &'static str,
}

/// One arm's enclosing capsules at one posture, in `base`.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmShape<'a> {
    arm: &'a Arm,
    capsules: Vec<Capsule>,
    /// A ball round each capsule.
    balls: Vec<Ball>,
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

    /// Returns whether the shapes in two balls may be nearer than `distance_m`.
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

    /// Returns whether something was found.
    pub fn is_some(&self) -> bool {
        !self.link.is_empty()
    }

    /// Returns the smaller of two gaps.
    pub fn min(self, other: Self) -> Self {
        if other.distance_m < self.distance_m { other } else { self }
    }
}

impl<'a> ArmShape<'a> {
    /// Returns the arm at joint positions `q`.
    pub fn at(arm: &'a Arm, q: &Joints) -> Self {
        let capsules = arm.capsules(q);
        let balls = capsules.iter().map(Ball::round_capsule).collect();
        Self { arm, capsules, balls }
    }

    /// Returns the enclosing capsules, shoulder first.
    pub fn capsules(&self) -> &[Capsule] {
        &self.capsules
    }

    /// Gap between links of this arm that are at least two joints apart, if it is below `within_m`.
    pub fn to_itself(&self, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        for (i, j) in &self.arm.pairs {
            if self.balls[*i].may_be_nearer(&self.balls[*j], gap.distance_m) {
                let distance = self.capsules[*i].to_capsule(&self.capsules[*j]);
                gap = gap.min(self.gap(distance, *i, self.arm.enclosures[*j].link));
            }
        }
        gap
    }

    /// Gap to the other arm, if it is below `within_m`.
    pub fn to_arm(&self, other: &ArmShape<'_>, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        for (i, (own, ball)) in self.capsules.iter().zip(&self.balls).enumerate() {
            for (j, theirs) in other.capsules.iter().enumerate() {
                if ball.may_be_nearer(&other.balls[j], gap.distance_m) {
                    let link = other.arm.enclosures[j].link;
                    gap = gap.min(self.gap(own.to_capsule(theirs), i, link));
                }
            }
        }
        gap
    }

    /// Gap to torso, pedestal and head, if it is below `within_m`.
    pub fn to_trunk(&self, within_m: f64) -> Gap {
        let mut gap = Gap::none(within_m);
        let (body, loose) = (&self.arm.body, &self.arm.loose);
        for ((name, cuboid), loose) in body.cuboids.iter().zip(&loose.cuboids) {
            gap = gap.min(self.some_to_cuboid(loose.iter().copied(), name, cuboid, gap.distance_m));
        }
        for ((name, capsule), loose) in body.capsules.iter().zip(&loose.capsules) {
            let round = Ball::round_capsule(capsule);
            for &i in loose {
                if self.balls[i].may_be_nearer(&round, gap.distance_m) {
                    gap = gap.min(self.gap(self.capsules[i].to_capsule(capsule), i, name));
                }
            }
        }
        gap
    }

    /// Gap between the whole arm and a box of the surroundings, if it is below `within_m`. The link of the first joint,
    /// which turns in place, may touch what the arm stands on.
    pub fn to_cuboid(&self, name: &'static str, cuboid: &Cuboid, within_m: f64) -> Gap {
        let first = usize::from(cuboid.is_below(&self.arm.chain.shoulder()));
        let all = 0..self.capsules.len();
        self.some_to_cuboid(
            all.filter(|i| self.arm.enclosures[*i].joint >= first),
            name,
            cuboid,
            within_m,
        )
    }

    fn some_to_cuboid(
        &self,
        enclosures: impl Iterator<Item = usize>,
        name: &'static str,
        cuboid: &Cuboid,
        within_m: f64,
    ) -> Gap {
        let round = Ball::round_cuboid(cuboid);
        let mut gap = Gap::none(within_m);
        for i in enclosures {
            if self.balls[i].may_be_nearer(&round, gap.distance_m) {
                gap = gap.min(self.gap(self.capsules[i].to_cuboid(cuboid), i, name));
            }
        }
        gap
    }

    fn gap(&self, distance_m: f64, capsule: usize, other: &'static str) -> Gap {
        Gap { distance_m, link: self.arm.enclosures[capsule].link, other }
    }
}

/// The arms' clearances by group, metres, negative where shapes overlap; pairs are left and right, or
/// the only arm twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Arm to arm.
    pub arms: Gap,
    /// Each arm to torso, pedestal and head.
    pub body: [Gap; 2],
    /// Each arm to itself.
    pub own: [Gap; 2],
    /// Each arm to the nearest of the surroundings.
    pub surroundings: [Gap; 2],
}

impl Clearance {
    /// Clearances with the arms at `q` among `surroundings`.
    pub fn of(robot: &Robot, q: &[Joints; 2], surroundings: &[Cuboid]) -> Self {
        let arms = Limb::BOTH.map(|limb| ArmShape::at(robot.arm(limb), &q[limb]));
        let apart = || arms[0].to_arm(&arms[1], f64::INFINITY);
        let two = robot.limbs().len() == 2;
        let around = |arm: &ArmShape<'_>| {
            surroundings.iter().fold(Gap::none(f64::INFINITY), |gap, cuboid| {
                gap.min(arm.to_cuboid("surroundings", cuboid, gap.distance_m))
            })
        };
        Self {
            arms: if two { apart() } else { Gap::none(f64::INFINITY) },
            body: arms.each_ref().map(|arm| arm.to_trunk(f64::INFINITY)),
            own: arms.each_ref().map(|arm| arm.to_itself(f64::INFINITY)),
            surroundings: arms.each_ref().map(around),
        }
    }

    /// Returns the smallest gap within the robot.
    pub fn robot(&self) -> Gap {
        self.body.into_iter().chain(self.own).fold(self.arms, Gap::min)
    }
}
