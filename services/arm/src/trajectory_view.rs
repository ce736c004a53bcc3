//! View of the planned trajectory of the gripper, for clients.

use crate::Config;
use crate::executor::{Executor, Program, Purpose};
use manipulation::{Arm, Trajectory};
use messages::{PhaseWay, TRAJECTORY_POINTS_MAX, TrajectoryView};
use scene::ObjectId;
use service::{Span, Time};

/// Most points of a moving phase: one every few centimetres of the longest path.
const PHASE_POINTS_MAX: usize = 48;
/// Largest change of a joint that counts as standing still, radians.
const STILL_RAD: f64 = 1e-9;

/// Trajectory of the current motion, and what of it was published.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct MotionView {
    view: TrajectoryView,
    /// Duration of the whole, seconds of real time.
    duration_s: f64,
    /// Simulated seconds per second.
    time_scale: f64,
    /// Steps left when it was last published; `None` before the first time.
    published: Option<usize>,
}

impl MotionView {
    /// Starts the view of a program, with its object if it has one.
    pub(crate) fn begin(&mut self, program: &Program, object: Option<ObjectId>, config: &Config) {
        let pick = match program.purpose {
            Purpose::Pick(id) => Some(id),
            Purpose::Aim(_) | Purpose::Return => None,
        };
        self.time_scale = config.arm.time_scale;
        self.duration_s = program.duration_s() / config.arm.time_scale;
        self.published = None;
        self.view = TrajectoryView {
            interaction: pick.map_or(0, |id| id.interaction.0),
            attempt: pick.map_or(0, |id| id.attempt),
            object: object.map(|object| object.0),
            limb: program.limb.index() as u8,
            began_ns: 0,
            phases: phases(program, config.setup.robot.arm(program.limb), config.arm.time_scale),
        };
    }

    /// Returns the view to publish: the trajectory when a motion starts or enters its next step, an
    /// empty one when it ends, `None` while nothing has changed.
    pub(crate) fn update(&mut self, executor: &Executor, now: Time) -> Option<TrajectoryView> {
        let left = executor.steps_left();
        if self.published.replace(left) == Some(left) {
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

/// Samples the gripper's path in each step, evenly in time.
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

/// Returns whether the arm stands still for the whole motion.
fn stands(motion: &Trajectory) -> bool {
    let at = |share: f64| motion.sample(share * motion.duration_s()).0;
    let first = at(0.0);
    [0.5, 1.0]
        .into_iter()
        .all(|share| at(share).iter().zip(&first).all(|(q, first)| (q - first).abs() < STILL_RAD))
}
