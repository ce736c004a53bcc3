//! Planning scene: postures of both arms, obstacles and the held object.

use nalgebra::{Isometry3, UnitQuaternion};

use super::error::PlanError;
use super::held_object::Held;
use super::static_obstacles::{self, Obstacle};
use crate::collision::Cuboid;
use crate::collision::block::Block;
use crate::collision::{ArmShape, Gap};
use crate::kinematics::chain::Chain;
use crate::kinematics::limb::{Joints, Limb};
use crate::kinematics::limits::MotionLimits;
use crate::planning::grasp::ObjectPose;
use crate::robot::{Arm, Robot};
use crate::trajectory::joint_path::{blocking, largest_change, searched, simple};
use crate::trajectory::{Trajectory, refuse_outside};

/// Settings of plans. Lengths in metres, frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSettings {
    /// Share of the joints' greatest velocities and accelerations, above 0 to 1.
    pub speed_ratio: f64,
    /// Height above the grasp from which the gripper comes straight down, and to which it lifts.
    pub hover_m: f64,
    /// Handover position of the left gripper; the right one mirrors y. Where the object or the
    /// hand would touch something there, it lets go up to 12 cm above.
    pub hand_over_xyz_m: [f64; 3],
    /// Height of the table's top. An object that stands lower (in a rack, in a drawer) lowers it.
    pub table_z_m: f64,
    /// Near edge of the table, x in frame `base`. A small arm stands on it.
    pub table_near_m: f64,
    /// Position to which the gripper opens, percent of its range.
    pub open_percent: f64,
    /// Distance from the gripper to the centre of an object that it points at.
    pub standoff_m: f64,
    /// Duration of pointing, seconds.
    pub point_s: f64,
    /// Distance that the arms keep from themselves, each other and the trunk. The capsules that it
    /// is measured between already enclose the arms.
    pub margin_m: f64,
}

impl Default for PlanSettings {
    fn default() -> Self {
        Self {
            // The SDK's default.
            speed_ratio: 0.3,
            hover_m: 0.15,
            hand_over_xyz_m: [0.80, 0.30, 0.22],
            table_z_m: -0.155,
            table_near_m: 0.4,
            open_percent: 100.0,
            standoff_m: 0.25,
            point_s: 1.0,
            margin_m: 0.01,
        }
    }
}

impl PlanSettings {
    /// Returns the handover position of `limb`.
    pub(crate) fn hand_over_m(&self, limb: Limb) -> [f64; 3] {
        let [x, y, z] = self.hand_over_xyz_m;
        [x, limb.side() * y, z]
    }
}

/// One limb among everything that it must not touch, and what it holds.
#[derive(Clone)]
pub(crate) struct PlanningScene<'a> {
    pub(crate) limb: Limb,
    pub(crate) arm: &'a Arm,
    pub(crate) chain: &'a Chain,
    /// Motion limits at the settings' speed.
    pub(crate) limits: MotionLimits,
    /// Present joint positions.
    pub(crate) q: Joints,
    pub(crate) settings: &'a PlanSettings,
    /// The other limb, if there is one.
    other: Option<(&'a Arm, ArmShape<'a>)>,
    pub(crate) surroundings: Vec<Obstacle>,
    /// Number of the board under the object to fetch.
    board: Option<usize>,
    held: Option<Held>,
}

impl<'a> PlanningScene<'a> {
    /// `place_m` is where the arm is to work, and `lowest_z_m` how far down it reaches there.
    ///
    /// # Errors
    /// [`PlanError::Start`] for an arm outside its joint limits.
    pub(crate) fn new(
        robot: &'a Robot,
        limb: Limb,
        arms: &[Joints; 2],
        others: &[Cuboid],
        (place_m, lowest_z_m): ([f64; 3], f64),
        settings: &'a PlanSettings,
    ) -> Result<Self, PlanError> {
        let arm = robot.arm(limb);
        let limb = arm.limb;
        refuse_outside(arm.chain.limits(), &arms[limb])?;
        let mut surroundings = static_obstacles::table(
            (settings.table_near_m, settings.table_z_m),
            place_m,
            lowest_z_m,
        );
        surroundings.extend(static_obstacles::objects(others, settings.table_z_m));
        Ok(Self {
            limb,
            arm,
            chain: &arm.chain,
            limits: arm.limits.at_speed_ratio(settings.speed_ratio),
            q: arms[limb],
            settings,
            other: limb.other().map(|other| {
                let arm = robot.arm(other);
                (arm, ArmShape::at(arm, &arms[other]))
            }),
            surroundings,
            board: None,
            held: None,
        })
    }

    /// Width to which the gripper opens, metres.
    pub(crate) fn open_m(&self) -> f64 {
        self.arm.gripper.width_m(self.settings.open_percent)
    }

    /// Returns the same with one more obstacle.
    pub(crate) fn with_obstacle(&self, obstacle: Obstacle) -> Self {
        let mut scene = self.clone();
        scene.surroundings.push(obstacle);
        scene
    }

    /// Adds the board that the object to be fetched stands on, as wide as the hand.
    pub(crate) fn with_board_under(mut self, object: &Cuboid) -> Self {
        let rest_m = self.settings.table_z_m + static_obstacles::THICKNESS_M;
        if self.settings.table_near_m < 0.0 && object.centre[2] - 0.5 * object.size[2] < rest_m {
            // It stands on the table all around.
            return self;
        }
        self.board = Some(self.surroundings.len());
        self.surroundings.push(static_obstacles::board(object, HAND_M));
        self
    }

    /// Returns the same with `object`, given as it stood, in the gripper at `in_gripper`.
    pub(crate) fn carrying(&self, object: &ObjectPose, in_gripper: &Isometry3<f64>) -> Self {
        let mut around = self.surroundings.clone();
        // The hand keeps off a board that may be there; what it holds, off what surely is.
        if let Some(board) = self.board {
            around[board] =
                static_obstacles::board(&object.cuboid(), static_obstacles::NEIGHBOUR_M);
        }
        Self { held: Some(Held::new(object, in_gripper, around)), ..self.clone() }
    }

    /// Returns the error for a missing path to `at`: a collision of the present posture, or what is in
    /// the way of the straight line to `to`.
    pub(crate) fn no_path(&self, at: &'static str, from: &Joints, to: &Joints) -> PlanError {
        let limb = self.limb;
        match self.blocked(&self.q) {
            Some(gap) => PlanError::Blocked { at: "its present posture", limb, gap },
            None => PlanError::NoPath { at, limb, gap: blocking(from, to, &|q| self.blocked(q)) },
        }
    }

    /// Returns the obstacle that the arm at `q`, or what it holds, would come too near to.
    pub(crate) fn blocked(&self, q: &Joints) -> Option<Gap> {
        self.blocked_at(&self.look(q), 0.0)
    }

    pub(crate) fn clear(&self, q: &Joints) -> bool {
        self.blocked(q).is_none()
    }

    /// Returns the gripper's rotation at which what it holds stands upright, turned as it is at
    /// `pose`.
    pub(crate) fn upright(&self, pose: &Isometry3<f64>) -> UnitQuaternion<f64> {
        self.held.as_ref().map_or(pose.rotation, |held| held.upright(pose))
    }

    /// Returns the obstacle, other than the robot, too near to the held object with the gripper at `pose`.
    pub(crate) fn held_blocked(&self, pose: &Isometry3<f64>) -> Option<Gap> {
        let held = self.held.as_ref()?;
        held.near_surroundings(&held.block(pose), 0.0)
    }

    /// Returns the gap between the arm and the other limb, if it is below `within_m`.
    pub(crate) fn other_gap(&self, arm: &ArmShape<'_>, within_m: f64) -> Gap {
        let other = self.other.as_ref();
        other.map_or(Gap::none(within_m), |(_, other)| arm.to_arm(other, within_m))
    }

    /// Returns the arm and what it holds at one posture.
    pub(crate) fn look(&self, q: &Joints) -> Look<'a> {
        let block = self.held.as_ref().map(|held| held.block(&self.chain.forward(q)));
        Look { arm: ArmShape::at(self.arm, q), block }
    }

    /// Returns the obstacle too near if the next check is only after a motion of `moved_m`.
    pub(crate) fn blocked_at(&self, Look { arm, block }: &Look<'_>, moved_m: f64) -> Option<Gap> {
        let near_m = 0.5 * moved_m;
        let margin_m = self.settings.margin_m.max(near_m);
        let held = || {
            let (held, block) = (self.held.as_ref()?, block.as_ref()?);
            held.near_surroundings(block, moved_m).or_else(|| {
                let other = self.other.as_ref().map(|(arm, shape)| (*arm, shape));
                held.near_robot(block, (self.arm, arm), other, margin_m)
            })
        };
        let around = self.surroundings.iter();
        around
            .map(|(name, cuboid)| arm.to_cuboid(name, cuboid, near_m))
            .chain([arm.to_itself(margin_m)])
            .chain(std::iter::once_with(|| arm.to_trunk(margin_m)))
            .chain(std::iter::once_with(|| self.other_gap(arm, margin_m)))
            .find(Gap::is_some)
            .or_else(held)
    }

    /// Returns the first of `waypoints` that would touch something.
    pub(crate) fn blocked_along(&self, waypoints: &[Joints]) -> Option<Gap> {
        // Waypoints of a line are 5 mm apart; every second is enough, and the last.
        waypoints.iter().rev().step_by(2).find_map(|q| self.blocked(q))
    }

    /// Returns a collision-free joint path: the direct line, or over one of the arm's
    /// via postures; with `search` also paths found by random trees. One with room for a fast motion
    /// before any other.
    pub(crate) fn way(&self, from: &Joints, to: &Joints, search: Search) -> Option<Vec<Joints>> {
        let roomy = |q: &Joints| {
            let at_end = [from, to].iter().any(|end| largest_change(q, end) < END_RAD);
            self.blocked_at(&self.look(q), if at_end { 0.0 } else { ROUTE_M }).is_none()
        };
        let clear = |q: &Joints| self.clear(q);
        let (via_postures, limits) = (&self.arm.via_postures, self.chain.limits());
        let known = simple(from, to, via_postures, &roomy)
            .or_else(|| simple(from, to, via_postures, &clear));
        known.or_else(|| match search {
            Search::No => None,
            Search::Yes => {
                searched(from, to, limits, &roomy).or_else(|| searched(from, to, limits, &clear))
            }
        })
    }

    /// Returns the motion through `waypoints`, its whole length checked. Where a fast one with wide
    /// corners would come too near to something, one with stops at its corners, and then a slow
    /// one, which needs less room.
    pub(crate) fn motion(
        &self,
        at: &'static str,
        waypoints: &[Joints],
    ) -> Result<Trajectory, PlanError> {
        self.motion_in(&MANNERS, at, waypoints)
    }

    /// As [`PlanningScene::motion`], at a tenth of the speed, where that is better than no motion at all.
    pub(crate) fn creeping(
        &self,
        at: &'static str,
        waypoints: &[Joints],
    ) -> Result<Trajectory, PlanError> {
        self.motion_in(&[CREEPING], at, waypoints)
    }

    fn motion_in(
        &self,
        manners: &[(f64, f64)],
        at: &'static str,
        waypoints: &[Joints],
    ) -> Result<Trajectory, PlanError> {
        let limb = self.limb;
        let mut gap = None;
        for &(blend_rad, speed_ratio) in manners {
            let limits = self.limits.at_speed_ratio(speed_ratio);
            let motion = Trajectory::through(waypoints, blend_rad, &limits)?;
            gap = self.blocked_during(&motion);
            if gap.is_none() {
                return Ok(motion);
            }
        }
        Err(gap.map_or(PlanError::NoPath { at, limb, gap }, |gap| PlanError::Blocked {
            at,
            limb,
            gap,
        }))
    }

    /// Returns the obstacle too near during a motion. It is checked at intervals of [`CHECK_S`]; what moves
    /// between two checks is never further from one of them than half of its way.
    pub(crate) fn blocked_during(&self, motion: &Trajectory) -> Option<Gap> {
        let checks = (motion.duration_s() / CHECK_S).ceil() as usize;
        let at = |k: usize| self.look(&motion.sample(k as f64 * CHECK_S).0);
        let (mut now, mut before_m) = (at(0), 0.0);
        for k in 1..=checks + 1 {
            let next = at(k);
            let moved_m = now.moved_m(&next);
            if let Some(gap) = self.blocked_at(&now, f64::max(before_m, moved_m)) {
                return Some(gap);
            }
            (now, before_m) = (next, moved_m);
        }
        None
    }

    /// Least seconds from one posture to another at the settings' speed: a bound, for choosing.
    pub(crate) fn seconds_between(&self, from: &Joints, to: &Joints) -> f64 {
        let limits = &self.limits;
        (0..7)
            .map(|j| {
                let (v, a) = (limits.velocity[j], limits.acceleration[j]);
                let way = (from[j] - to[j]).abs();
                // A trapezoidal velocity profile, or a triangular one if too short to reach the limit.
                if way > v * v / a { way / v + v / a } else { 2.0 * (way / a).sqrt() }
            })
            .fold(0.0, f64::max)
    }
}

/// The arm and what it holds at one posture.
pub(crate) struct Look<'a> {
    pub(crate) arm: ArmShape<'a>,
    block: Option<Block>,
}

impl Look<'_> {
    /// Returns the furthest that any point is from where it is in another look, metres.
    fn moved_m(&self, other: &Self) -> f64 {
        let arm = self.arm.capsules().iter().zip(other.arm.capsules());
        let arm = arm.map(|(a, b)| (a.a - b.a).norm().max((a.b - b.b).norm()));
        let corners = |look: &Self| look.block.into_iter().flat_map(Block::corners);
        let held = corners(self).zip(corners(other)).map(|(a, b)| (a - b).norm());
        arm.chain(held).fold(0.0, f64::max)
    }
}

/// Variants of a motion: distance of a corner's ends from its waypoint, radians of
/// joint distance, at so large a share of the speed. Wide ones are passed without a stop; at sharp
/// ones the arm all but stops.
const MANNERS: [(f64, f64); 3] = [(0.15, 1.0), (0.005, 1.0), (0.005, 0.35)];
/// The variant of the last resort: it needs the least room, and ten times as long.
const CREEPING: (f64, f64) = (0.005, 0.1);

/// Room that a fast motion needs around it, twice over, metres.
const ROUTE_M: f64 = 0.03;

/// So near to its ends a way needs none: the largest joint's change, radians.
const END_RAD: f64 = 0.25;

/// Radius of the hand around the gripper's axis, with some margin, metres.
const HAND_M: f64 = 0.1;

/// Time between two checks of a motion, seconds.
const CHECK_S: f64 = 0.02;

/// Permission for random trees to search for a path.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// Direct lines and via postures only: microseconds to milliseconds.
    No,
    /// Random trees as well: up to some tenths of a second.
    Yes,
}
