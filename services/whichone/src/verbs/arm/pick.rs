//! A planned pick, and where everything is while it is carried out.

use evaluation::charts::Ink;
use manipulation::{
    Arms, Limb, ObjectPose, PickPhase, PickPlan, PlanSettings, Robot, attached_pose, gripper,
};
use nalgebra::{Isometry3, Vector3};
use robot_model::Joint;
use scene::Scene;

/// What is drawn.
pub(super) struct Pick<'a> {
    pub(super) scene: &'a Scene,
    pub(super) robot: &'a Robot,
    pub(super) settings: &'a PlanSettings,
    /// Of every object.
    pub(super) places: Vec<ObjectPose>,
    /// The one that is fetched.
    pub(super) object: usize,
    pub(super) plan: PickPlan,
}

/// The phases that are told apart, with their names and the numbers of their colours.
pub(super) const PHASES: [(PickPhase, &str, usize); 6] = [
    (PickPhase::Approach, "approach", 0),
    (PickPhase::Close, "close", 3),
    (PickPhase::Lift, "lift", 2),
    (PickPhase::HandOver, "hand over", 1),
    (PickPhase::Release, "release", 5),
    (PickPhase::Return, "return", 6),
];

/// The colour of a phase.
pub(super) fn ink(phase: PickPhase) -> Ink {
    let known = PHASES.iter().find(|(known, ..)| *known == phase);
    evaluation::charts::colour(known.map_or(0, |(.., colour)| *colour))
}

impl Pick<'_> {
    /// Where every link of the robot is, that many seconds after the start.
    pub(super) fn links(&self, t_s: f64) -> Vec<Isometry3<f64>> {
        let moment = self.plan.at(t_s);
        let mut arms: Arms = self.robot.neutral();
        *arms.of_mut(self.plan.limb()) = moment.q;
        self.robot.description().poses(|joint| {
            let held = Limb::BOTH.iter().find_map(|limb| {
                let names = &self.robot.arm(*limb).joint_names;
                let place = names.iter().position(|name| *name == joint.name)?;
                Some(arms.of(*limb)[place])
            });
            held.unwrap_or_else(|| self.finger(joint, moment.width_m))
        })
    }

    /// The position of a joint that is no arm's: fingers are at half the width to either side.
    fn finger(&self, joint: &Joint, width_m: f64) -> f64 {
        let limits = joint.limits.map(|limits| (limits.lower, limits.upper));
        let Some((lower, upper)) = limits.filter(|_| joint.name.contains("finger")) else {
            return 0.0;
        };
        let moving = self.moves_with_limb(joint.child);
        let open = if moving { width_m / gripper::STROKE_M } else { 0.0 };
        lower + (upper - lower) * open.clamp(0.0, 1.0)
    }

    /// Whether a link hangs on a joint of the limb that fetches.
    pub(super) fn moves_with_limb(&self, link: usize) -> bool {
        let names = &self.robot.arm(self.plan.limb()).joint_names;
        let mut carrier = self.robot.description().carrier(link);
        while let Some(joint) = carrier {
            if names.contains(&joint.name) {
                return true;
            }
            carrier = self.robot.description().carrier(joint.parent);
        }
        false
    }

    /// Where the point between the finger tips is.
    pub(super) fn tip(&self, links: &[Isometry3<f64>]) -> Isometry3<f64> {
        let name = format!("{}_gripper", self.plan.limb());
        let index = self.robot.description().link_index(&name);
        index.map_or_else(Isometry3::identity, |index| links[index])
    }

    /// Where the fetched object is: in its place, in the gripper, or where it was let go.
    pub(super) fn object_at(&self, t_s: f64) -> Isometry3<f64> {
        let span = |phase| self.plan.timeline.span_s(phase).unwrap_or_default();
        let (taken_s, given_s) = (span(PickPhase::Lift).0, span(PickPhase::HandOver).1);
        if t_s <= taken_s {
            return self.places[self.object].isometry();
        }
        let tip = self.tip(&self.links(t_s.min(given_s)));
        attached_pose(&tip, &self.plan.object_in_gripper)
    }

    /// The way of the gripper's tip in each phase.
    pub(super) fn ways(&self) -> Vec<(PickPhase, Vec<Vector3<f64>>)> {
        const POINTS: usize = 60;
        let way = |phase: PickPhase| {
            let (begin_s, end_s) = self.plan.timeline.span_s(phase)?;
            let at = |n: usize| begin_s + (end_s - begin_s) * n as f64 / POINTS as f64;
            let tip = |n: usize| self.tip(&self.links(at(n))).translation.vector;
            Some((phase, (0..=POINTS).map(tip).collect()))
        };
        PHASES.iter().filter_map(|(phase, ..)| way(*phase)).collect()
    }
}
