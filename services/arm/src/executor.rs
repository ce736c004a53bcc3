//! Executes one program at a time: the current step and the time within it.

use arm_driver::{ArmDriver, Command, Fault, Fingers};
use manipulation::{Limb, State, Trajectory};
use messages::{MotionInhibit, MotionPhase, PickId, PickPhase};
use scene::ObjectId;
use std::collections::VecDeque;
use std::fmt;

/// A motion that ends faster than this flows into the next step, rad/s.
const FLOWS_RAD_S: f64 = 1e-6;

/// Purpose of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Purpose {
    /// Fetch the ordered object, or put it back.
    Pick(PickId),
    /// Aim at an object.
    Aim(ObjectId),
    /// Bring a limb to rest.
    Return,
}

impl fmt::Display for Purpose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pick(id) => write!(f, "pick {id}"),
            Self::Aim(object) => write!(f, "aim at object {}", object.0),
            Self::Return => f.write_str("return"),
        }
    }
}

/// Steps of one limb in order, each beginning where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Program {
    pub(crate) purpose: Purpose,
    pub(crate) limb: Limb,
    pub(crate) steps: VecDeque<Step>,
}

/// One motion of the arm and its fingers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    pub(crate) kind: MotionPhase,
    /// Phase of a pick that must be durable before the step begins.
    pub(crate) phase: Option<PickPhase>,
    pub(crate) motion: Trajectory,
    pub(crate) fingers: Fingers,
}

/// Execution state.
#[derive(Clone, Debug, Default)]
pub(crate) enum Executor {
    /// Ready.
    #[default]
    Standing,
    /// Running a program, `t_s` seconds into its first step, whose motion ended `late_s` seconds ago.
    Running { program: Program, t_s: f64, late_s: f64 },
    /// Coming to rest on the planned path.
    Halting { limb: Limb, motion: Trajectory, t_s: f64, late_s: f64 },
}

/// Result of advancing in time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Progress {
    /// Still running.
    Under,
    /// A step ended with this many seconds left; the next one has not begun.
    Ended(MotionPhase, f64),
    /// A halt ended.
    Halted,
    /// A motion did not end as commanded; the executor stands.
    Failed(Fault),
}

impl Program {
    /// Returns the duration of its steps, simulated seconds.
    pub(crate) fn duration_s(&self) -> f64 {
        self.steps.iter().map(|step| step.motion.duration_s()).sum()
    }
}

impl Executor {
    pub(crate) fn start(&mut self, program: Program) {
        *self = Self::Running { program, t_s: 0.0, late_s: 0.0 };
    }

    /// Returns the purpose of the running program.
    pub(crate) fn purpose(&self) -> Option<Purpose> {
        self.program().map(|program| program.purpose)
    }

    pub(crate) fn program(&self) -> Option<&Program> {
        match self {
            Self::Running { program, .. } => Some(program),
            _ => None,
        }
    }

    pub(crate) fn is_standing(&self) -> bool {
        matches!(self, Self::Standing)
    }

    /// Returns whether the next step of the program has not begun.
    pub(crate) fn begins_step(&self) -> bool {
        matches!(self, Self::Running { t_s: 0.0, .. })
    }

    /// Changes the purpose of the rest of the program.
    pub(crate) fn change_purpose(&mut self, to: Purpose) {
        if let Self::Running { program, .. } = self {
            program.purpose = to;
        }
    }

    /// Aborts the program and brings the arm to rest as fast as its limits allow.
    pub(crate) fn halt(&mut self) {
        let Self::Running { program, t_s, .. } = self else { return };
        *self = match program.steps.front() {
            None => Self::Standing,
            Some(step) => {
                let motion = step.motion.halted_at(*t_s);
                Self::Halting { limb: program.limb, motion, t_s: 0.0, late_s: 0.0 }
            }
        };
    }

    /// Aborts everything at once.
    pub(crate) fn stand(&mut self) {
        *self = Self::Standing;
    }

    /// Advances by `seconds`, at most to the end of the step.
    pub(crate) fn advance(&mut self, seconds: f64, driver: &mut dyn ArmDriver) -> Progress {
        match self {
            Self::Standing => Progress::Under,
            Self::Halting { limb, motion, t_s, late_s } => {
                let how = (*limb, Fingers::Stay);
                let ended = follow(motion, (t_s, late_s), seconds, how, driver);
                let deaf = driver.inhibit() != MotionInhibit::None && *late_s > 0.0;
                // An arm that does not settle after a stop command counts as standing, and so does one
                // without sensor data.
                if let (Ok(None), false) = (ended, deaf) {
                    return Progress::Under;
                }
                *self = Self::Standing;
                Progress::Halted
            }
            Self::Running { program, t_s, late_s } => {
                let Some(step) = program.steps.front() else {
                    *self = Self::Standing;
                    return Progress::Under;
                };
                let how = (program.limb, step.fingers);
                let left_s = match follow(&step.motion, (t_s, late_s), seconds, how, driver) {
                    Ok(None) => return Progress::Under,
                    Ok(Some(left_s)) => left_s,
                    Err(fault) => {
                        *self = Self::Standing;
                        return Progress::Failed(fault);
                    }
                };
                let kind = step.kind;
                program.steps.pop_front();
                (*t_s, *late_s) = (0.0, 0.0);
                if program.steps.is_empty() {
                    *self = Self::Standing;
                }
                Progress::Ended(kind, left_s)
            }
        }
    }

    /// Returns the number of unfinished steps.
    pub(crate) fn steps_left(&self) -> usize {
        self.program().map_or(0, |program| program.steps.len())
    }

    /// Returns the simulated seconds until the program ends.
    pub(crate) fn seconds_left(&self) -> f64 {
        let Self::Running { program, t_s, .. } = self else { return 0.0 };
        (program.duration_s() - t_s).max(0.0)
    }

    /// Returns the simulated seconds until the object is let go.
    pub(crate) fn seconds_to_release(&self) -> f64 {
        let Self::Running { program, t_s, .. } = self else { return 0.0 };
        let release = program.steps.iter().position(|step| step.kind == MotionPhase::Release);
        let steps = program.steps.iter().take(release.map_or(0, |release| release + 1));
        let total: f64 = steps.map(|step| step.motion.duration_s()).sum();
        (total - t_s).max(0.0)
    }
}

/// Follows a motion from `t_s` on for `seconds`; `late_s` is the time since its planned end.
/// Returns the seconds left when it ended, `None` while it has not.
fn follow(
    motion: &Trajectory,
    (t_s, late_s): (&mut f64, &mut f64),
    seconds: f64,
    (limb, fingers): (Limb, Fingers),
    driver: &mut dyn ArmDriver,
) -> Result<Option<f64>, Fault> {
    let remaining_s = motion.duration_s() - *t_s;
    let passed_s = seconds.min(remaining_s).max(0.0);
    *t_s += passed_s;
    let State { q, qd, qdd } = motion.state(*t_s);
    let command = Command { limb, q, qd, qdd, t_s: *t_s, fingers };
    driver.command(&command, passed_s);
    driver.look_ahead(limb, motion, *t_s);
    if seconds < remaining_s {
        return Ok(None);
    }
    // A motion that was split in two does not come to rest in between.
    if qd.iter().any(|v| v.abs() > FLOWS_RAD_S) {
        return Ok(Some(seconds - passed_s));
    }
    *late_s += seconds - passed_s;
    Ok(driver.has_arrived(&command, *late_s)?.then_some(seconds - passed_s))
}
