//! One gripper of a Baxter: its command, the confirmation, and its sensors.

use arm_driver::Fingers;
use manipulation::gripper;
use messages::Code;
use messages::robot::{
    Command, EndEffectorCommand, EndEffectorProperties, EndEffectorState, Tristate, UiType,
};
use service::{Span, Time};

/// Interval at which an unconfirmed command is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);
/// Timeout of a calibration, after which it is requested again.
const CALIBRATION_MAX: Span = Span::from_ms(10_000);
/// Timeout of the holding force, after which the fingers move without it: a gripper of another firmware
/// may not confirm `configure`.
const CONFIGURE_MAX: Span = Span::from_ms(2_000);
/// Age beyond which a gripper's state says nothing.
const STALE: Span = Span::from_ms(1_000);
/// Fingers that have not begun to move this long after a command will not.
const SETTLED_AFTER: Span = Span::from_ms(500);
/// Fingers this near to their goal are there, percent: the SDK's dead zone.
const DEAD_ZONE_PERCENT: f64 = 100.0 * gripper::DEAD_ZONE;
/// Force with which held objects are pressed, percent. The SDK's default of 30 carries half of what
/// `whichone check` allows.
const HOLDING_FORCE_PERCENT: f64 = 100.0;
/// Sender named in the commands.
const SENDER: &str = "whichone";

/// One gripper.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Gripper {
    geometry: gripper::Gripper,
    state: Option<(EndEffectorState, Time)>,
    properties: Option<EndEffectorProperties>,
    /// Latest command, and the time when it was first sent.
    command: Option<(Command, EndEffectorCommand, Time)>,
    /// Time of its confirmation.
    handled: Option<Time>,
    sent: Option<Time>,
    sequence: u32,
    /// The holding force was set, or given up.
    configured: bool,
}

/// Condition of a gripper, from the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Condition {
    Ready,
    Uncalibrated,
    /// A fault, or not the electric gripper.
    Faulty,
    /// No report for a while.
    Stale,
    /// No report yet.
    Unheard,
}

impl Gripper {
    /// Returns a gripper before its first report.
    pub(super) fn new(geometry: &gripper::Gripper) -> Self {
        Self {
            geometry: *geometry,
            state: None,
            properties: None,
            command: None,
            handled: None,
            sent: None,
            sequence: 0,
            configured: false,
        }
    }

    pub(super) fn on_state(&mut self, state: &EndEffectorState, now: Time) {
        self.state = Some((*state, now));
        let confirmed = self.command.is_some_and(|(_, message, _)| state.has_handled(&message));
        if confirmed && self.handled.is_none() {
            self.handled = Some(now);
        }
    }

    pub(super) fn on_properties(&mut self, properties: &EndEffectorProperties) {
        self.properties = Some(*properties);
    }

    pub(super) fn condition(&self, now: Time) -> Condition {
        let Some((state, heard)) = &self.state else { return Condition::Unheard };
        let other = self.properties.is_some_and(|p| p.ui_type != UiType::Electric);
        if now.since(*heard) > STALE {
            Condition::Stale
        } else if is(state.error) || other {
            Condition::Faulty
        } else if state.calibrated == Tristate::False {
            Condition::Uncalibrated
        } else {
            Condition::Ready
        }
    }

    /// Width between the fingers, metres.
    pub(super) fn width_m(&self) -> Option<f64> {
        self.state.map(|(state, _)| self.geometry.width_m(f64::from(state.position)))
    }

    /// Returns whether something is between the fingers. Fingers that stopped at nothing wider than the
    /// dead zone have closed on themselves.
    pub(super) fn holding(&self, now: Time) -> Option<bool> {
        let (state, heard) = self.state?;
        if now.since(heard) > STALE || state.calibrated == Tristate::False {
            return None;
        }
        let apart = f64::from(state.position) > DEAD_ZONE_PERCENT;
        match state.gripping.get() {
            Tristate::True => Some(apart),
            Tristate::False => Some(false),
            // A gripper without a sense of its own: closed fingers that stand apart have something
            // between them.
            Tristate::Unknown if !is(state.moving) => {
                let closes = self.command.is_some_and(|(command, ..)| closes(command));
                (closes && self.handled.is_some()).then_some(apart)
            }
            Tristate::Unknown => None,
        }
    }

    pub(super) fn is_moving(&self) -> bool {
        self.state.is_some_and(|(state, _)| is(state.moving))
    }

    /// Returns whether the fingers have completed their command.
    pub(super) fn has_settled(&self, now: Time) -> bool {
        let Some((command, ..)) = self.command else { return !self.is_moving() };
        let (Some((state, _)), Some(handled)) = (self.state, self.handled) else { return false };
        let position = f64::from(state.position);
        let done = match command {
            Command::Go(goal) if !closes(command) => (position - goal).abs() <= DEAD_ZONE_PERCENT,
            Command::Go(_) | Command::Grip => is(state.gripping) || is(state.missed),
            Command::Calibrate => is(state.calibrated),
            Command::Release | Command::Stop | Command::Configure(_) => false,
        };
        !is(state.moving) && (done || now.since(handled) > SETTLED_AFTER && !waits(command))
    }

    /// Commands the fingers of a motion.
    pub(super) fn want(&mut self, fingers: Fingers, now: Time) {
        let controls_grip = self.properties.is_some_and(|p| p.controls_grip != 0);
        if fingers != Fingers::Stay && !self.configure(now) {
            return;
        }
        let controls_position = self.properties.is_none_or(|p| p.controls_position != 0);
        match fingers {
            Fingers::Stay if self.is_moving() => self.send(Command::Stop, now),
            Fingers::Stay => {}
            Fingers::Open(width_m) if controls_position => {
                self.send(Command::Go(self.geometry.percent(width_m)), now);
            }
            Fingers::Open(_) => self.send(Command::Release, now),
            Fingers::Grip(_) if controls_grip => self.send(Command::Grip, now),
            Fingers::Grip(_) => self.send(Command::Go(0.0), now),
        }
    }

    /// Sets the holding force before the first motion of the fingers. Returns whether they may move: it is
    /// set, the gripper has no such parameter, or it has not confirmed it in time.
    fn configure(&mut self, now: Time) -> bool {
        let command = Command::Configure(HOLDING_FORCE_PERCENT);
        let sent = self.command.filter(|(before, ..)| *before == command).map(|(.., since)| since);
        self.configured |= sent.is_some() && self.handled.is_some();
        if self.configured || self.properties.is_none_or(|p| p.controls_force == 0) {
            return true;
        }
        if sent.is_some_and(|since| now.since(since) > CONFIGURE_MAX) {
            tracing::warn!(
                "the gripper has not confirmed its holding force ({HOLDING_FORCE_PERCENT} %) within 2 s and \
                 keeps its own, 30 % by default; help: heavy objects may slip, see docs/baxter.md"
            );
            self.configured = true;
            return true;
        }
        self.send(command, now);
        false
    }

    /// Starts calibration, again after a timeout.
    pub(super) fn calibrate(&mut self, now: Time) {
        let sent = self.command.filter(|(command, ..)| *command == Command::Calibrate);
        if sent.is_some_and(|(.., since)| now.since(since) > CALIBRATION_MAX) {
            tracing::warn!("gripper calibration timed out; retrying");
            self.command = None;
        }
        self.send(Command::Calibrate, now);
    }

    /// Returns the command to send now.
    pub(super) fn due(&mut self, now: Time) -> Option<EndEffectorCommand> {
        let (_, mut message, _) = self.command.filter(|_| self.handled.is_none())?;
        if self.sent.is_some_and(|sent| now.since(sent) < RESEND_EVERY) {
            return None;
        }
        message.id = self.state?.0.id;
        self.sent = Some(now);
        Some(message)
    }

    /// Forgets the latest command, so that the next one is sent.
    pub(super) fn forget(&mut self) {
        (self.command, self.handled, self.sent) = (None, None, None);
    }

    fn send(&mut self, command: Command, now: Time) {
        if self.command.is_some_and(|(before, ..)| before == command) {
            return;
        }
        // A number that a process before this one cannot have used.
        let clock = (now.ns() / 1_000_000) as u32 & 0x3fff_ffff;
        self.sequence = if self.sequence == 0 { clock.max(1) } else { self.sequence + 1 };
        let id = self.state.map_or(0, |(state, _)| state.id);
        let message = EndEffectorCommand::new(id, command, SENDER, self.sequence);
        (self.command, self.handled, self.sent) = (Some((command, message, now)), None, None);
    }
}

fn is(tristate: Code<Tristate>) -> bool {
    tristate == Tristate::True
}

/// Returns whether the command closes the fingers, so that it ends where they meet something or each other.
fn closes(command: Command) -> bool {
    matches!(command, Command::Grip) || matches!(command, Command::Go(goal) if goal <= 0.0)
}

/// Returns whether the end of the command shows in the state, not only in the end of motion.
fn waits(command: Command) -> bool {
    matches!(command, Command::Calibrate)
}
