//! Choice among the postures that reach a pose: seven joints leave a degree of freedom.
//!
//! The cost of a posture is in seconds: those that the arm takes to it, and what it is worth to stay
//! away from joint limits, from everything that the arm could touch, and with the elbow high. Near
//! its limits an arm has little room to continue; a low elbow sweeps over the table.

use nalgebra::Isometry3;

use super::planning_scene::PlanningScene;
use crate::collision::Gap;
use crate::kinematics::inverse::Unreachable;
use crate::kinematics::limb::Joints;
use crate::trajectory::Timeline;

/// Seconds that a posture at a joint limit is worse than one [`FREE_RAD`] away from all.
const LIMIT_S: f64 = 1.0;

/// Distance to a joint limit beyond which more is worth nothing, radians.
const FREE_RAD: f64 = 0.2;

/// Seconds that a posture that all but touches something is worse than one with room around it.
const CROWDED_S: f64 = 1.0;

/// Clearance beyond which more of it is worth nothing, metres.
const ROOMY_M: f64 = 0.05;

/// Seconds that an elbow on the table would be worse than one [`LOW_M`] above it. More than any way
/// over which it can be avoided takes.
const ELBOW_S: f64 = 6.0;

/// The joints whose links are the elbow. Of seven they are the upper arm's turn and the elbow's own; of six
/// the elbow's, whose link begins there, and the one behind it.
const ELBOW: std::ops::RangeInclusive<usize> = 2..=3;

/// Height above the table from which an elbow is not low, metres.
const LOW_M: f64 = 0.1;

/// Number of postures considered for one pose, and their least distance, radians: neighbours
/// fare alike.
const POSTURES: usize = 12;
const APART_RAD: f64 = 0.3;

impl PlanningScene<'_> {
    /// Returns the cost of `q` from `from`, seconds, without its surroundings.
    pub(crate) fn cost_s(&self, from: &Joints, q: &Joints) -> f64 {
        let margin_rad = self.chain.limits().margin_rad(q);
        let confined = ((FREE_RAD - margin_rad) / FREE_RAD).clamp(0.0, 1.0);
        self.seconds_between(from, q) + LIMIT_S * confined + self.lowness_s(q)
    }

    /// Returns the cost of the surroundings of `q`, seconds, or what the arm would touch there.
    pub(crate) fn crowding_s(&self, q: &Joints) -> Result<f64, Gap> {
        let look = self.look(q);
        if let Some(gap) = self.blocked_at(&look, 0.0) {
            return Err(gap);
        }
        let arm = &look.arm;
        let around = self.surroundings.iter();
        let gap = around
            .map(|(name, cuboid)| arm.to_cuboid(name, cuboid, ROOMY_M))
            .chain([arm.to_itself(ROOMY_M), arm.to_trunk(ROOMY_M)])
            .fold(self.other_gap(arm, ROOMY_M), Gap::min);
        Ok(CROWDED_S * ((ROOMY_M - gap.distance_m) / ROOMY_M))
    }

    /// Returns the cost of the elbow's height at `q`, seconds.
    fn lowness_s(&self, q: &Joints) -> f64 {
        ELBOW_S * ((LOW_M - self.elbow_m(q)) / LOW_M).clamp(0.0, 1.0)
    }

    /// Height of the elbow's lowest point above the table's top, metres.
    fn elbow_m(&self, q: &Joints) -> f64 {
        let frames = self.chain.frames(q);
        let elbow = self.arm.enclosures.iter().filter(|e| ELBOW.contains(&e.joint));
        let lowest = elbow
            .map(|e| {
                let z = |end| frames[e.joint].point(end).z;
                z(&e.capsule.a).min(z(&e.capsule.b)) - e.capsule.radius
            })
            .fold(f64::INFINITY, f64::min);
        lowest - self.settings.table_z_m
    }

    /// Returns the cost of the lowest elbow of a whole plan, seconds.
    pub(crate) fn plan_lowness_s(&self, timeline: &Timeline) -> f64 {
        let looks = (timeline.duration_s() / LOOK_S).ceil() as usize;
        let cost_s = |k: usize| self.lowness_s(&timeline.at(k as f64 * LOOK_S).q);
        // What the arm begins with is not the plan's to choose.
        let begin_s = cost_s(0);
        (1..=looks).map(cost_s).fold(0.0, |worst: f64, s| worst.max(s - begin_s))
    }

    /// Postures that take the gripper to `target`, cheapest from `from` first, each with its cost
    /// but for what is around it.
    ///
    /// # Errors
    /// The nearest miss, if none does.
    pub(crate) fn postures(
        &self,
        target: &Isometry3<f64>,
        from: &Joints,
    ) -> Result<Vec<(f64, Joints)>, Unreachable> {
        let mut all = self.chain.solutions(target);
        if all.is_empty() {
            all.push(self.chain.nearest(target, from)?.q);
        }
        let mut all: Vec<_> = all.into_iter().map(|q| (self.cost_s(from, &q), q)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut chosen: Vec<(f64, Joints)> = Vec::with_capacity(POSTURES);
        for posture in all {
            let apart = |other: &(f64, Joints)| {
                (0..7).any(|j| (other.1[j] - posture.1[j]).abs() > APART_RAD)
            };
            if chosen.len() < POSTURES && chosen.iter().all(apart) {
                chosen.push(posture);
            }
        }
        Ok(chosen)
    }
}

/// Time between two checks of the elbow along a plan, seconds.
const LOOK_S: f64 = 0.1;
