//! One gripper of a Baxter: what it was told, whether it has understood, and what it feels.

use super::super::Fingers;
use manipulation::gripper;
use messages::Code;
use messages::robot::{
    Command, EndEffectorCommand, EndEffectorProperties, EndEffectorState, Tristate, UiType,
};
use service::{Span, Time};

/// How often a command is sent again that the gripper has not confirmed.
const RESEND_EVERY: Span = Span::from_ms(250);
/// How long a calibration may take before it is asked for anew.
const CALIBRATION_MAX: Span = Span::from_ms(10_000);
/// Age beyond which a gripper's state says nothing.
const STALE: Span = Span::from_ms(1_000);
/// Fingers that have not begun to move this long after a command will not.
const SETTLED_AFTER: Span = Span::from_ms(500);
/// Fingers this near to their goal are there, percent: the SDK's dead zone.
const DEAD_ZONE_PERCENT: f64 = 100.0 * gripper::DEAD_ZONE;
/// Who the commands come from.
const SENDER: &str = "whichone";

/// One gripper.
#[derive(Clone, Debug, Default)]
pub(super) struct Gripper {
    state: Option<(EndEffectorState, Time)>,
    properties: Option<EndEffectorProperties>,
    /// What it was told last, and when first.
    told: Option<(Command, EndEffectorCommand, Time)>,
    /// When it confirmed that.
    handled: Option<Time>,
    sent: Option<Time>,
    sequence: u32,
}

/// What a gripper keeps the robot from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Condition {
    /// Nothing.
    Ready,
    /// Not heard yet.
    Unheard,
    /// Not heard for a while.
    Stale,
    /// A fault, or not the electric gripper.
    Faulty,
    /// It has to be calibrated.
    Uncalibrated,
}

impl Gripper {
    pub(super) fn hear_state(&mut self, state: &EndEffectorState, now: Time) {
        self.state = Some((*state, now));
        let confirmed = self.told.is_some_and(|(_, message, _)| state.has_handled(&message));
        if confirmed && self.handled.is_none() {
            self.handled = Some(now);
        }
    }

    pub(super) fn hear_properties(&mut self, properties: &EndEffectorProperties) {
        self.properties = Some(*properties);
    }

    pub(super) fn condition(&self, now: Time) -> Condition {
        let Some((state, heard)) = &self.state else { return Condition::Unheard };
        let other = self.properties.is_some_and(|p| p.ui_type != UiType::Electric.code());
        if now.since(*heard) > STALE {
            Condition::Stale
        } else if is(state.error) || other {
            Condition::Faulty
        } else if state.calibrated == Tristate::False.code() {
            Condition::Uncalibrated
        } else {
            Condition::Ready
        }
    }

    /// Width between the fingers, metres.
    pub(super) fn width_m(&self) -> Option<f64> {
        self.state.map(|(state, _)| gripper::width_m(f64::from(state.position)))
    }

    /// Whether something is between the fingers. Fingers that stopped at nothing wider than the
    /// dead zone have closed on themselves.
    pub(super) fn holding(&self, now: Time) -> Option<bool> {
        let (state, heard) = self.state?;
        if now.since(heard) > STALE || state.calibrated == Tristate::False.code() {
            return None;
        }
        let apart = f64::from(state.position) > DEAD_ZONE_PERCENT;
        match Tristate::from_code(state.gripping).ok()? {
            Tristate::True => Some(apart),
            Tristate::False => Some(false),
            // A gripper without a sense of its own: closed fingers that stand apart have something
            // between them.
            Tristate::Unknown if !is(state.moving) => {
                let closes = self.told.is_some_and(|(command, ..)| closes(command));
                (closes && self.handled.is_some()).then_some(apart)
            }
            Tristate::Unknown => None,
        }
    }

    pub(super) fn is_moving(&self) -> bool {
        self.state.is_some_and(|(state, _)| is(state.moving))
    }

    /// Whether the fingers have done what they were told.
    pub(super) fn has_settled(&self, now: Time) -> bool {
        let Some((command, ..)) = self.told else { return !self.is_moving() };
        let (Some((state, _)), Some(handled)) = (self.state, self.handled) else { return false };
        let position = f64::from(state.position);
        let done = match command {
            Command::Go(goal) if !closes(command) => (position - goal).abs() <= DEAD_ZONE_PERCENT,
            Command::Go(_) | Command::Grip => is(state.gripping) || is(state.missed),
            Command::Calibrate => is(state.calibrated),
            Command::Release | Command::Stop => false,
        };
        !is(state.moving) && (done || now.since(handled) > SETTLED_AFTER && !waits(command))
    }

    /// Has the fingers do what a motion wants of them.
    pub(super) fn want(&mut self, fingers: Fingers, now: Time) {
        let controls_grip = self.properties.is_some_and(|p| p.controls_grip != 0);
        let controls_position = self.properties.is_none_or(|p| p.controls_position != 0);
        match fingers {
            Fingers::Stay if self.is_moving() => self.tell(Command::Stop, now),
            Fingers::Stay => {}
            Fingers::Open(width_m) if controls_position => {
                self.tell(Command::Go(gripper::percent(width_m)), now);
            }
            Fingers::Open(_) => self.tell(Command::Release, now),
            Fingers::Grip(_) if controls_grip => self.tell(Command::Grip, now),
            Fingers::Grip(_) => self.tell(Command::Go(0.0), now),
        }
    }

    /// Has it calibrated; again where that does not come to an end.
    pub(super) fn calibrate(&mut self, now: Time) {
        let told = self.told.filter(|(command, ..)| *command == Command::Calibrate);
        if told.is_some_and(|(.., since)| now.since(since) > CALIBRATION_MAX) {
            tracing::warn!("the gripper has not calibrated; it is told once more");
            self.told = None;
        }
        self.tell(Command::Calibrate, now);
    }

    /// The command that is to be sent now.
    pub(super) fn due(&mut self, now: Time) -> Option<EndEffectorCommand> {
        let (_, mut message, _) = self.told.filter(|_| self.handled.is_none())?;
        if self.sent.is_some_and(|sent| now.since(sent) < RESEND_EVERY) {
            return None;
        }
        message.id = self.state?.0.id;
        self.sent = Some(now);
        Some(message)
    }

    /// Forgets what it was told, so that it is told anew.
    pub(super) fn forget(&mut self) {
        (self.told, self.handled, self.sent) = (None, None, None);
    }

    fn tell(&mut self, command: Command, now: Time) {
        if self.told.is_some_and(|(before, ..)| before == command) {
            return;
        }
        // A number that a process before this one cannot have used.
        let clock = (now.ns() / 1_000_000) as u32 & 0x3fff_ffff;
        self.sequence = if self.sequence == 0 { clock.max(1) } else { self.sequence + 1 };
        let id = self.state.map_or(0, |(state, _)| state.id);
        let message = EndEffectorCommand::new(id, command, SENDER, self.sequence);
        (self.told, self.handled, self.sent) = (Some((command, message, now)), None, None);
    }
}

fn is(tristate: Code<Tristate>) -> bool {
    tristate == Tristate::True
}

/// Whether the command closes the fingers, so that it ends where they meet something or each other.
fn closes(command: Command) -> bool {
    matches!(command, Command::Grip) || matches!(command, Command::Go(goal) if goal <= 0.0)
}

/// Whether the command's end is seen in the state, and not only in that nothing moves any more.
fn waits(command: Command) -> bool {
    matches!(command, Command::Calibrate)
}
