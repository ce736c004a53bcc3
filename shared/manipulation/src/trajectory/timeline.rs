//! A plan in time: stages one after another, each a motion of the arm and of the gripper.

use serde::Serialize;

use crate::gripper;
use crate::kinematics::limb::{Joints, Limb};
use crate::trajectory::joint_trajectory::Trajectory;

/// The stages of plans. A pick is `Approach`, `Close`, `Lift`, `HandOver`, `Release`, `Raise`, `Return`;
/// pointing is `Aim`, `Hold`, `Return`; putting back is `Take`, `Close`, `CarryBack`, `Lower`, `Release`,
/// `Raise`, `Return`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// To above the object and straight down to it, fingers opening.
    Approach,
    /// The fingers close.
    Close,
    /// Straight up.
    Lift,
    /// To where the person takes the object.
    HandOver,
    /// The fingers open.
    Release,
    /// To where the gripper looks at the object.
    Aim,
    /// Still, pointing.
    Hold,
    /// To where the user gives the object back, and still there, fingers open.
    Take,
    /// To above the object's place.
    CarryBack,
    /// Straight down to it.
    Lower,
    /// Straight up from its place, or back along the fingers from where it was handed over.
    Raise,
    /// Back to the neutral posture.
    Return,
}

/// One stage of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Purpose of the part.
    pub phase: Phase,
    /// The arm's motion; standing still where only the gripper moves.
    pub motion: Trajectory,
    /// Width between the fingers at the start of the stage, and their goal, metres.
    pub width_m: (f64, f64),
}

/// Stages of one limb in order, each beginning where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    limb: Limb,
    stages: Vec<Stage>,
}

/// The state of a plan at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The stage's phase.
    pub phase: Phase,
    /// Joint positions, radians.
    pub q: Joints,
    /// Joint velocities, rad/s.
    pub qd: Joints,
    /// Width between the fingers, metres.
    pub width_m: f64,
}

impl Timeline {
    /// # Panics
    /// Without a stage.
    pub(crate) fn new(limb: Limb, stages: Vec<Stage>) -> Self {
        assert!(!stages.is_empty(), "a plan has at least one stage");
        Self { limb, stages }
    }

    /// Returns the limb that moves.
    pub fn limb(&self) -> Limb {
        self.limb
    }

    /// Returns the stages in order.
    pub fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// Returns the duration of the plan, seconds.
    pub fn duration_s(&self) -> f64 {
        self.stages.iter().map(|stage| stage.motion.duration_s()).sum()
    }

    /// Returns the start and end of the first stage of `phase`, seconds from the start of the plan.
    pub fn span_s(&self, phase: Phase) -> Option<(f64, f64)> {
        let index = self.stages.iter().position(|stage| stage.phase == phase)?;
        // From plus zero: the sum of no numbers is minus zero.
        let before = self.stages[..index].iter().map(|s| s.motion.duration_s());
        let begin = before.fold(0.0, |sum, seconds| sum + seconds);
        Some((begin, begin + self.stages[index].motion.duration_s()))
    }

    /// Returns the state `t_s` seconds after the start; before it and after the end, those of the
    /// start and the end.
    pub fn at(&self, t_s: f64) -> Moment {
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
    fn stage_at(&self, t_s: f64) -> (&Stage, f64) {
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

impl Stage {
    /// The fingers set out as the stage begins and move at their own speed.
    fn width_at(&self, t_s: f64) -> f64 {
        let (from, to) = self.width_m;
        let seconds = gripper::seconds_between(from, to);
        if t_s >= seconds { to } else { from + (to - from) * (t_s / seconds).max(0.0) }
    }
}
