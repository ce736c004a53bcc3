//! What a plan starts from: where both arms are, and what stands around.

use super::error::PlanError;
use super::furniture::{self, Obstacle};
use crate::baxter::DEFAULT_SPEED_RATIO;
use crate::chain::Chain;
use crate::clearance::{ArmShape, Gap};
use crate::limb::{Joints, Limb};
use crate::limits::MotionLimits;
use crate::robot::{Arm, Robot};
use crate::route::{searched, simple};
use crate::shape::Cuboid;
use crate::trajectory::Trajectory;

/// Joint positions of both arms, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arms {
    /// The left arm's.
    pub left: Joints,
    /// The right arm's.
    pub right: Joints,
}

impl Arms {
    /// One arm's joint positions.
    pub fn of(&self, limb: Limb) -> &Joints {
        match limb {
            Limb::Left => &self.left,
            Limb::Right => &self.right,
        }
    }

    /// One arm's joint positions, to be changed.
    pub fn of_mut(&mut self, limb: Limb) -> &mut Joints {
        match limb {
            Limb::Left => &mut self.left,
            Limb::Right => &mut self.right,
        }
    }
}

/// How the arm goes about its work. Lengths in metres, frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSettings {
    /// Share of the joints' greatest velocities and accelerations, above 0 to 1.
    pub speed_ratio: f64,
    /// Height above the grasp from which the gripper comes straight down, and to which it lifts.
    pub hover_m: f64,
    /// Where the left gripper lets go of an object; the right one mirrors y.
    pub hand_over_xyz_m: [f64; 3],
    /// Height of the table's top. An object that stands lower (in a rack, in a drawer) lowers it.
    pub table_z_m: f64,
    /// Width to which the gripper opens, metres.
    pub open_width_m: f64,
    /// Distance from the gripper to the centre of an object that it points at.
    pub standoff_m: f64,
    /// How long the arm points, seconds.
    pub point_s: f64,
    /// Distance that the arms keep from themselves, each other and the trunk. The capsules that it
    /// is measured between already enclose the arms.
    pub margin_m: f64,
}

impl Default for PlanSettings {
    fn default() -> Self {
        Self {
            speed_ratio: DEFAULT_SPEED_RATIO,
            hover_m: 0.15,
            hand_over_xyz_m: [0.80, 0.35, 0.15],
            table_z_m: -0.155,
            open_width_m: crate::gripper::STROKE_M,
            standoff_m: 0.25,
            point_s: 1.0,
            margin_m: 0.01,
        }
    }
}

impl PlanSettings {
    /// Where `limb` hands over.
    pub(crate) fn hand_over_m(&self, limb: Limb) -> [f64; 3] {
        let [x, y, z] = self.hand_over_xyz_m;
        [x, limb.side() * y, z]
    }
}

/// One limb among everything that it must not touch.
pub(crate) struct Situation<'a> {
    pub(crate) limb: Limb,
    pub(crate) arm: &'a Arm,
    pub(crate) chain: &'a Chain,
    /// What its joints may do at the settings' speed.
    pub(crate) limits: MotionLimits,
    /// Where the limb is now.
    pub(crate) q: Joints,
    pub(crate) settings: &'a PlanSettings,
    other: ArmShape<'a>,
    surroundings: Vec<Obstacle>,
}

impl<'a> Situation<'a> {
    /// `place_m` is where the arm is to work, and `lowest_z_m` how far down it reaches there.
    pub(crate) fn new(
        robot: &'a Robot,
        limb: Limb,
        arms: &Arms,
        others: &[Cuboid],
        (place_m, lowest_z_m): ([f64; 3], f64),
        settings: &'a PlanSettings,
    ) -> Self {
        let mut surroundings = furniture::table(settings.table_z_m, place_m, lowest_z_m);
        surroundings.extend(furniture::objects(others, settings.table_z_m));
        let arm = robot.arm(limb);
        Self {
            limb,
            arm,
            chain: &arm.chain,
            limits: arm.limits.at_speed_ratio(settings.speed_ratio),
            q: *arms.of(limb),
            settings,
            other: ArmShape::at(robot.arm(limb.other()), arms.of(limb.other())),
            surroundings,
        }
    }

    /// Adds the board that the object to be fetched stands on, as wide as the hand.
    pub(crate) fn with_board_under(mut self, object: &Cuboid) -> Self {
        self.surroundings.push(furniture::board(object, HAND_M));
        self
    }

    /// Why there is no way to `at`: the arm is in something's way where it stands, or it is lost.
    pub(crate) fn no_way(&self, at: &'static str) -> PlanError {
        let limb = self.limb;
        match self.blocked(&self.q) {
            Some(gap) => PlanError::Blocked { at: "its present posture", limb, gap },
            None => PlanError::NoWay { at, limb },
        }
    }

    /// What the arm at `q` would come too near to.
    pub(crate) fn blocked(&self, q: &Joints) -> Option<Gap> {
        let arm = ArmShape::at(self.arm, q);
        let margin_m = self.settings.margin_m;
        let around =
            self.surroundings.iter().map(|(name, cuboid)| arm.to_cuboid(name, cuboid, 0.0));
        around
            .chain([arm.to_itself(margin_m)])
            .chain(std::iter::once_with(|| arm.to_trunk(margin_m)))
            .chain(std::iter::once_with(|| arm.to_arm(&self.other, margin_m)))
            .find(Gap::is_some)
    }

    pub(crate) fn clear(&self, q: &Joints) -> bool {
        self.blocked(q).is_none()
    }

    /// The first of `waypoints` that would touch something.
    pub(crate) fn blocked_along(&self, waypoints: &[Joints]) -> Option<Gap> {
        // Waypoints of a line are 5 mm apart; every second is enough, and the last.
        waypoints.iter().rev().step_by(2).find_map(|q| self.blocked(q))
    }

    /// A way through joint space that touches nothing: the direct line, or over the neutral or the
    /// untucked posture; with `search` also whatever random trees find.
    pub(crate) fn way(&self, from: &Joints, to: &Joints, search: Search) -> Option<Vec<Joints>> {
        let clear = |q: &Joints| self.clear(q);
        simple(from, to, &self.arm.stations, &clear).or_else(|| match search {
            Search::No => None,
            Search::Yes => searched(from, to, self.chain.limits(), &clear),
        })
    }

    /// The motion through `waypoints`, its whole length checked; with stops at the corners if a
    /// rounded one would touch something.
    pub(crate) fn motion(
        &self,
        at: &'static str,
        waypoints: &[Joints],
    ) -> Result<Trajectory, PlanError> {
        let limb = self.limb;
        let mut gap = None;
        for blend_rad in [BLEND_RAD, SHARP_RAD] {
            let motion = Trajectory::through(waypoints, blend_rad, &self.limits)?;
            gap = self.blocked_during(&motion);
            if gap.is_none() {
                return Ok(motion);
            }
        }
        Err(gap.map_or(PlanError::NoWay { at, limb }, |gap| PlanError::Blocked { at, limb, gap }))
    }

    fn blocked_during(&self, motion: &Trajectory) -> Option<Gap> {
        let checks = (motion.duration_s() / CHECK_S).ceil() as usize;
        (0..=checks).find_map(|k| self.blocked(&motion.sample(k as f64 * CHECK_S).0))
    }

    /// Least seconds from one posture to another at the settings' speed: a bound, for choosing.
    pub(crate) fn seconds_between(&self, from: &Joints, to: &Joints) -> f64 {
        let limits = &self.limits;
        (0..7)
            .map(|j| {
                let (v, a) = (limits.velocity[j], limits.acceleration[j]);
                let way = (from[j] - to[j]).abs();
                // A trapezoid of speed, or a triangle where there is no time to reach the limit.
                if way > v * v / a { way / v + v / a } else { 2.0 * (way / a).sqrt() }
            })
            .fold(0.0, f64::max)
    }
}

/// Corners between motions begin this far before and end this far after a waypoint, radians of
/// joint distance: enough to pass without a stop.
const BLEND_RAD: f64 = 0.15;

/// The same where a wide corner would touch something: the arm all but stops there.
const SHARP_RAD: f64 = 0.005;

/// How far the hand reaches round the gripper's axis, and some, metres.
const HAND_M: f64 = 0.1;

/// Time between two checks of a motion, seconds.
const CHECK_S: f64 = 0.02;

/// Whether a way may be searched for at length.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// Direct lines and known stations only: microseconds to milliseconds.
    No,
    /// Random trees as well: up to some tenths of a second.
    Yes,
}
