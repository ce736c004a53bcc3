//! Which way the gripper is going, for people to see.

use crate::Config;
use crate::executor::{Executor, Program, Purpose};
use crate::state::side;
use manipulation::{Arm, Trajectory};
use messages::{PhaseWay, TRAJECTORY_POINTS_MAX, TrajectoryView};
use scene::ObjectId;
use service::{Span, Time};

/// Points of a moving phase at most: one each few centimetres of the longest way.
const PHASE_POINTS_MAX: usize = 48;
/// Joints that turn less between two ends stand still, radians.
const STILL_RAD: f64 = 1e-9;

/// The way of the motion under way, and what of it was told.
#[derive(Debug, Default)]
pub(crate) struct Course {
    view: TrajectoryView,
    /// Seconds that the whole takes by the clock.
    duration_s: f64,
    /// Simulated seconds per second.
    time_scale: f64,
    /// Steps that were left when it was told last; none: it has to be told.
    told: Option<usize>,
}

impl Course {
    /// A program begins, for `object` where it is for one.
    pub(crate) fn begin(&mut self, program: &Program, object: Option<ObjectId>, config: &Config) {
        let pick = match program.purpose {
            Purpose::Pick(id) => Some(id),
            Purpose::Aim(_) | Purpose::Return => None,
        };
        self.time_scale = config.arm.time_scale;
        self.duration_s = program.duration_s() / config.arm.time_scale;
        self.told = None;
        self.view = TrajectoryView {
            interaction: pick.map_or(0, |id| id.interaction.0),
            attempt: pick.map_or(0, |id| id.attempt),
            object: object.map(|object| object.0),
            limb: side(program.limb) as u8,
            began_ns: 0,
            phases: phases(program, config.setup.robot.arm(program.limb), config.arm.time_scale),
        };
    }

    /// What is to be told now: the way as a motion begins or enters its next step, an empty one as
    /// it ends, nothing while nothing has changed.
    pub(crate) fn news(&mut self, executor: &Executor, now: Time) -> Option<TrajectoryView> {
        let left = executor.steps_left();
        if self.told.replace(left) == Some(left) {
            return None;
        }
        if left == 0 {
            return Some(TrajectoryView::default());
        }
        let passed_s = self.duration_s - executor.seconds_left() / self.time_scale;
        let began = now.ns().saturating_sub(Span::from_s(passed_s.max(0.0)).0);
        Some(TrajectoryView { began_ns: began, ..self.view.clone() })
    }
}

/// The gripper's way in each step, evenly in time.
fn phases(program: &Program, arm: &Arm, time_scale: f64) -> Vec<PhaseWay> {
    let most = (TRAJECTORY_POINTS_MAX / program.steps.len().max(1)).clamp(2, PHASE_POINTS_MAX);
    let mut begin_s = 0.0;
    let mut way = |step: &crate::executor::Step| {
        let (motion, seconds) = (&step.motion, step.motion.duration_s());
        let last = if stands(motion) { 1 } else { most - 1 };
        let times = || (0..=last).map(move |n| seconds * n as f64 / last as f64);
        let tip = |t_s: f64| arm.chain.forward(&motion.sample(t_s).0).translation.vector.into();
        let points_m = times().map(tip).collect();
        let t_s = times().map(|t_s| (begin_s + t_s) / time_scale).collect();
        begin_s += seconds;
        PhaseWay { phase: step.kind, points_m, t_s }
    };
    program.steps.iter().take(TRAJECTORY_POINTS_MAX / 2).map(&mut way).collect()
}

/// Whether the arm is where it began all along.
fn stands(motion: &Trajectory) -> bool {
    let at = |share: f64| motion.sample(share * motion.duration_s()).0;
    let first = at(0.0);
    [0.5, 1.0]
        .into_iter()
        .all(|share| at(share).iter().zip(&first).all(|(q, first)| (q - first).abs() < STILL_RAD))
}
