//! Carries programs out: which step the arm is in and how far, one program at a time.

use crate::driver::{ArmDriver, Command, Fault, Fingers};
use manipulation::{Limb, Trajectory};
use messages::{Hindrance, MotionPhase, PickId, PickPhase};
use scene::ObjectId;
use std::collections::VecDeque;

/// A motion that ends faster than this goes on in the next step, rad/s.
const FLOWS_RAD_S: f64 = 1e-6;

/// What a program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// To fetch what was ordered.
    Pick(PickId),
    /// To aim at an object.
    Aim(ObjectId),
    /// To bring a limb to rest.
    Return,
}

/// Steps of one limb in order, each beginning where the one before ends.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    pub(crate) purpose: Purpose,
    pub(crate) limb: Limb,
    pub(crate) steps: VecDeque<Step>,
}

/// One motion of the arm and its fingers.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// What it is for.
    pub(crate) kind: MotionPhase,
    /// The phase that has to be durable before the step begins, if it belongs to a pick.
    pub(crate) phase: Option<PickPhase>,
    pub(crate) motion: Trajectory,
    pub(crate) fingers: Fingers,
}

/// What the arm does.
#[derive(Clone, Debug, Default)]
pub(crate) enum Executor {
    /// Nothing.
    #[default]
    Standing,
    /// A program, `t_s` seconds into its first step, whose motion ended `late_s` seconds ago.
    Running { program: Program, t_s: f64, late_s: f64 },
    /// It comes to rest, on the path that it was on.
    Halting { limb: Limb, motion: Trajectory, t_s: f64, late_s: f64 },
}

/// What came of a stretch of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Progress {
    /// The time was used up.
    Under,
    /// A step ended with so many seconds left; the next one has not begun.
    Ended(MotionPhase, f64),
    /// A halt ended.
    Halted,
    /// A motion did not end as it should have; nothing is being done any more.
    Failed(Fault),
}

impl Program {
    /// Simulated seconds that its steps take.
    pub(crate) fn duration_s(&self) -> f64 {
        self.steps.iter().map(|step| step.motion.duration_s()).sum()
    }
}

impl Executor {
    pub(crate) fn start(&mut self, program: Program) {
        *self = Self::Running { program, t_s: 0.0, late_s: 0.0 };
    }

    /// What the running program is for.
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

    /// The rest of the program is for something else from here on.
    pub(crate) fn change_purpose(&mut self, to: Purpose) {
        if let Self::Running { program, .. } = self {
            program.purpose = to;
        }
    }

    /// Gives the program up and brings the arm to rest as soon as its limits allow.
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

    /// Gives up what is being done, at once.
    pub(crate) fn stand(&mut self) {
        *self = Self::Standing;
    }

    /// Goes on for `seconds`, at most to the end of the step.
    pub(crate) fn advance(&mut self, seconds: f64, driver: &mut dyn ArmDriver) -> Progress {
        match self {
            Self::Standing => Progress::Under,
            Self::Halting { limb, motion, t_s, late_s } => {
                let how = (*limb, Fingers::Stay);
                let ended = follow(motion, (t_s, late_s), seconds, how, driver);
                let deaf = driver.hindrance() != Hindrance::None && *late_s > 0.0;
                // An arm that was told to stop and hangs on is an arm that stands, and so is one
                // that cannot be felt.
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

    /// Steps of the program that are not over.
    pub(crate) fn steps_left(&self) -> usize {
        self.program().map_or(0, |program| program.steps.len())
    }

    /// Simulated seconds until the program ends.
    pub(crate) fn seconds_left(&self) -> f64 {
        let Self::Running { program, t_s, .. } = self else { return 0.0 };
        (program.duration_s() - t_s).max(0.0)
    }

    /// Simulated seconds until the object is handed over.
    pub(crate) fn seconds_to_hand_over(&self) -> f64 {
        let Self::Running { program, t_s, .. } = self else { return 0.0 };
        let before = program.steps.iter().take_while(|step| step.kind != MotionPhase::Return);
        let total: f64 = before.map(|step| step.motion.duration_s()).sum();
        (total - t_s).max(0.0)
    }
}

/// Follows a motion for `seconds`; it has been followed for `t_s` and should have ended `late_s` ago.
/// How many seconds were left when it ended, none while it has not.
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
    let (q, qd) = motion.sample(*t_s);
    let qdd = motion.acceleration(*t_s);
    let command = Command { limb, q, qd, qdd, t_s: *t_s, fingers };
    driver.command(&command, passed_s);
    if seconds < remaining_s {
        return Ok(None);
    }
    // Where one motion was cut in two the arm does not come to rest between them.
    if qd.iter().any(|v| v.abs() > FLOWS_RAD_S) {
        return Ok(Some(seconds - passed_s));
    }
    *late_s += seconds - passed_s;
    Ok(driver.has_arrived(&command, *late_s)?.then_some(seconds - passed_s))
}
