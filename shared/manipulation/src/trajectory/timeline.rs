//! A plan in time: stages one after another, each a motion of the arm and of the gripper.

use crate::gripper;
use crate::kinematics::limb::{Joints, Limb};
use crate::trajectory::joint_trajectory::Trajectory;

/// One stage of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage<P> {
    /// Purpose of the part.
    pub phase: P,
    /// The arm's motion; standing still where only the gripper moves.
    pub motion: Trajectory,
    /// Width between the fingers at the start of the stage, and their goal, metres.
    pub width_m: (f64, f64),
}

/// Stages of one limb in order, each beginning where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline<P> {
    limb: Limb,
    stages: Vec<Stage<P>>,
}

/// The state of a plan at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<P> {
    /// The stage's phase.
    pub phase: P,
    /// Joint positions, radians.
    pub q: Joints,
    /// Joint velocities, rad/s.
    pub qd: Joints,
    /// Width between the fingers, metres.
    pub width_m: f64,
}

impl<P: Copy + PartialEq> Timeline<P> {
    /// # Panics
    /// Without a stage.
    pub(crate) fn new(limb: Limb, stages: Vec<Stage<P>>) -> Self {
        assert!(!stages.is_empty(), "a plan has at least one stage");
        Self { limb, stages }
    }

    /// Returns the limb that moves.
    pub fn limb(&self) -> Limb {
        self.limb
    }

    /// Returns the stages in order.
    pub fn stages(&self) -> &[Stage<P>] {
        &self.stages
    }

    /// Returns the duration of the plan, seconds.
    pub fn duration_s(&self) -> f64 {
        self.stages.iter().map(|stage| stage.motion.duration_s()).sum()
    }

    /// Returns the start and end of the first stage of `phase`, seconds from the start of the plan.
    pub fn span_s(&self, phase: P) -> Option<(f64, f64)> {
        let index = self.stages.iter().position(|stage| stage.phase == phase)?;
        // From plus zero: the sum of no numbers is minus zero.
        let before = self.stages[..index].iter().map(|s| s.motion.duration_s());
        let begin = before.fold(0.0, |sum, seconds| sum + seconds);
        Some((begin, begin + self.stages[index].motion.duration_s()))
    }

    /// Returns the state `t_s` seconds after the start; before it and after the end, those of the
    /// start and the end.
    pub fn at(&self, t_s: f64) -> Moment<P> {
        let (stage, t_s) = self.stage_at(t_s);
        let (q, qd) = stage.motion.sample(t_s);
        Moment { phase: stage.phase, q, qd, width_m: stage.width_at(t_s) }
    }

    /// Returns the motion stop from the state at `t_s`, along the planned path.
    pub fn halted_at(&self, t_s: f64) -> Trajectory {
        let (stage, t_s) = self.stage_at(t_s);
        stage.motion.halted_at(t_s)
    }

    /// Returns the stage at `t_s` and the seconds since it began.
    fn stage_at(&self, t_s: f64) -> (&Stage<P>, f64) {
        let mut left = if t_s.is_nan() { 0.0 } else { t_s.max(0.0) };
        let (last, others) = self.stages.split_last().expect("a plan has at least one stage");
        for stage in others {
            if left < stage.motion.duration_s() {
                return (stage, left);
            }
            left -= stage.motion.duration_s();
        }
        (last, left)
    }
}

impl<P> Stage<P> {
    /// The fingers set out as the stage begins and move at their own speed.
    fn width_at(&self, t_s: f64) -> f64 {
        let (from, to) = self.width_m;
        let seconds = gripper::seconds_between(from, to);
        if t_s >= seconds { to } else { from + (to - from) * (t_s / seconds).max(0.0) }
    }
}
