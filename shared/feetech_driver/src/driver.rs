//! The driver: set points to goals, readings to measurements and faults.

use arm_driver::{ArmDriver, Command, Fault, Fingers, Measured, Source, Start, furthest};
use manipulation::{Joints, Limb, Robot};
use messages::MotionInhibit;
use messages::robot::{Order, Report};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::jaw::Jaw;
use crate::settings::Feetech;
use crate::traffic::{Heard, Reading, Servo, Told};

/// Interval of orders, a little below that of the arm's steps.
const ORDER_EVERY: Span = Span::from_ms(8);
/// Longest time between two passes.
const BEAT: Span = Span::from_ms(10);
/// Goals lie no further ahead of a joint than it moves in this time: the bus has no watchdog, so a servo goes on to its
/// latest goal when this program dies.
const LEAD_S: f64 = 0.1;
/// Time without faults after which servos that have let go shall hold again.
const HEALED: Span = Span::from_ms(1_000);
/// Timeout of a command to the fingers, seconds.
const FINGERS_MAX_S: f64 = 6.0;
/// Greatest torque of an STS3215 at 7.4 V, newton metres, by its data sheet.
const STALL_NM: f64 = 1.9;
/// A joint measured at most this far outside of its limits counts as on them, radians.
const LIMIT_SLACK_RAD: f64 = 0.03;
/// The limb: robots with two have two buses.
const LIMB: Limb = Limb::Only;

/// The driver of one arm on a bus of servos.
#[derive(Clone, Debug)]
pub struct FeetechDriver {
    settings: Feetech,
    robot: Robot,
    /// Number of joints without the jaw.
    joints: usize,
    state: State,
}

/// What a flight has to know.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    measured: Measured,
    /// The latest reading with positions that count.
    reading: Option<Reading>,
    unusable: Option<String>,
    /// The servos have held before.
    was_ready: bool,
    /// The reason of each servo's fault.
    alarms: Vec<Option<String>>,
    /// Part and reason of a fault that has not been taken.
    fault: Option<(String, String)>,
    /// When a servo was last found with a fault, or the bus as unusable.
    alarmed: Option<Time>,
    jaw: Jaw,
    /// Commanded positions; `None`: as measured.
    q: Option<Joints>,
    /// A command came in this pass.
    moves: bool,
    /// And in the one before.
    moved: bool,
    arrived: Option<Joints>,
    sent: Option<Time>,
    now: Time,
    inhibit: MotionInhibit,
    fresh: bool,
}

impl FeetechDriver {
    /// Returns a driver before the first reading: until then, the posture is the one that the journal remembers.
    pub fn new(settings: Feetech, start: &Start<'_>) -> Self {
        let Start { robot, posture, .. } = *start;
        let joints = robot.arm(LIMB).joint_names.len();
        let measured = Measured::remembered(posture, 2.0 * settings.tolerances.goal_rad);
        let state = State {
            measured,
            reading: None,
            unusable: None,
            was_ready: false,
            alarms: vec![None; joints + 1],
            fault: None,
            alarmed: None,
            jaw: Jaw::new(&settings, &robot.arm(LIMB).gripper),
            q: None,
            moves: false,
            moved: false,
            arrived: None,
            sent: None,
            now: Time(0),
            inhibit: MotionInhibit::Unheard,
            fresh: false,
        };
        Self { settings, robot: robot.clone(), joints, state }
    }

    fn joint(&self, place: usize) -> &str {
        let names = &self.robot.arm(LIMB).joint_names;
        names.get(place).map_or(&self.settings.gripper, String::as_str)
    }

    fn q(&self) -> Joints {
        self.state.measured.posture.joints[LIMB]
    }

    fn on_reading(&mut self, reading: Reading, now: Time) {
        if reading.servos.len() != self.joints + 1 {
            return tracing::warn!(servos = reading.servos.len(), "reading of another arm ignored");
        }
        self.state.unusable = None;
        for (place, servo) in reading.servos.iter().enumerate() {
            self.look_for_alarm(place, servo, now);
        }
        if !reading.is_plausible {
            return;
        }
        if reading.is_ready && !self.state.was_ready {
            tracing::info!("the servos hold");
            self.state.was_ready = true;
        }
        self.measure(&reading, now);
        self.state.reading = Some(reading);
        self.state.fresh = true;
    }

    fn measure(&mut self, reading: &Reading, now: Time) {
        let (jaw, measured) = (&mut self.state.jaw, &mut self.state.measured);
        let limits = self.robot.arm(LIMB).limits.position;
        for (place, servo) in reading.servos[..self.joints].iter().enumerate() {
            measured.posture.joints[LIMB][place] = on_limit(servo.value, limits.0[place]);
            measured.velocity[LIMB][place] = servo.speed;
            measured.effort[LIMB][place] = servo.load * STALL_NM;
        }
        let jaw_servo = &reading.servos[self.joints];
        if !jaw_servo.holds {
            jaw.let_go();
        }
        jaw.on_servo(jaw_servo, now);
        if let Some(width_m) = jaw.width_m() {
            measured.posture.width_m[LIMB] = width_m;
        }
        measured.at = Source::Sensors(reading.at.min(now));
        // The arm of a robot with one limb has both places.
        measured.posture.joints[1] = measured.posture.joints[0];
        measured.posture.width_m[1] = measured.posture.width_m[0];
    }

    /// Notes the fault of a servo when it begins.
    fn look_for_alarm(&mut self, place: usize, servo: &Servo, now: Time) {
        let let_go = servo
            .has_let_go
            .then_some("has let go, or has restarted: its torque is off or its settings are lost");
        let Some(reason) = servo.errors.reason().or(let_go) else {
            self.state.alarms[place] = None;
            return;
        };
        if servo.errors.any() {
            self.state.alarmed = Some(now);
        }
        let before = &self.state.alarms[place];
        // A servo that was too hot has let go as well.
        if before.as_deref() == Some(reason) || before.is_some() && !servo.errors.any() {
            return;
        }
        (self.state.alarms[place], self.state.alarmed) = (Some(reason.to_owned()), Some(now));
        let Servo { load, volts, celsius, errors, .. } = *servo;
        let joint = self.joint(place).to_owned();
        tracing::error!(
            joint,
            reason,
            load,
            volts,
            celsius,
            errors = errors.0,
            "a servo protects itself"
        );
        self.state.fault.get_or_insert((
            joint,
            format!("{reason} ({celsius} °C, {volts:.1} V, load {:.0} %)", 100.0 * load),
        ));
    }

    fn on_unusable(&mut self, reason: String, now: Time) {
        if self.state.was_ready {
            self.state.alarmed = Some(now);
        }
        if self.state.unusable.as_ref() == Some(&reason) {
            return;
        }
        tracing::warn!(reason, "the servos cannot be used");
        // What holds now was not seen for a while: somebody may have moved it.
        if self.state.was_ready && self.state.unusable.is_none() {
            self.state.fault.get_or_insert(("servo bus".to_owned(), reason.clone()));
        }
        self.state.unusable = Some(reason);
    }

    fn find_inhibit(&self, now: Time) -> MotionInhibit {
        let State { reading, unusable, alarms, was_ready, .. } = &self.state;
        let (Some(reading), None) = (reading, unusable) else { return MotionInhibit::Unheard };
        if alarms.iter().any(Option::is_some) {
            return MotionInhibit::Error;
        }
        if !was_ready {
            return MotionInhibit::Unheard;
        }
        if now.since(reading.at) > Span::from_s(self.settings.tolerances.stale_s) {
            return MotionInhibit::Stale;
        }
        if reading.is_ready { MotionInhibit::None } else { MotionInhibit::Error }
    }

    /// Returns whether servos that do not hold shall do so: none has a fault, and none is hot.
    fn shall_hold(&self, now: Time) -> bool {
        let Some(reading) = &self.state.reading else { return false };
        let is_sound =
            |servo: &Servo| !servo.errors.any() && (servo.is_cool || !self.state.was_ready);
        let rested = self.state.alarmed.is_none_or(|alarmed| now.since(alarmed) >= HEALED);
        !reading.is_ready && rested && reading.servos.iter().all(is_sound)
    }

    /// A posture with the joints that do not hold where they are: their servos begin to hold there.
    fn with_loose(&self, mut q: Joints) -> Joints {
        let (here, State { reading, was_ready, .. }) = (self.q(), &self.state);
        for (j, servo) in
            reading.iter().flat_map(|reading| &reading.servos[..self.joints]).enumerate()
        {
            if !servo.holds || !was_ready {
                q[j] = here[j];
            }
        }
        q
    }

    /// Goals of the joints: at most a tenth of a second ahead.
    fn goals(&self, q: &Joints) -> Vec<f64> {
        let (here, limits) = (self.q(), &self.robot.arm(LIMB).limits);
        let lead = |j: usize| LEAD_S * limits.velocity[j].min(self.settings.speed_max_rad_s);
        (0..self.joints).map(|j| q[j].clamp(here[j] - lead(j), here[j] + lead(j))).collect()
    }

    fn stands(&self) -> bool {
        self.state.measured.velocity[LIMB]
            .iter()
            .all(|v| v.abs() < self.settings.tolerances.still_rad_s)
    }
}

impl ArmDriver for FeetechDriver {
    fn checkpoint(&self) -> Option<Vec<u8>> {
        postcard::to_stdvec(&self.state).ok()
    }

    fn resume(&mut self, checkpoint: &[u8]) -> Option<()> {
        self.state = postcard::from_bytes(checkpoint).ok()?;
        Some(())
    }

    fn measured(&self) -> Measured {
        self.state.measured
    }

    fn command(&mut self, command: &Command, _: f64) {
        if matches!(self.state.inhibit, MotionInhibit::None | MotionInhibit::Stale) {
            (self.state.q, self.state.moves) = (Some(command.q), true);
            self.state.jaw.want(command.fingers, self.state.now);
        }
    }

    fn on_report(&mut self, report: &Report<'_>, now: Time) {
        match Heard::of(report) {
            Some(Heard::Reading(reading)) => self.on_reading(reading, now),
            Some(Heard::Unusable(reason)) => self.on_unusable(reason, now),
            None => {}
        }
    }

    fn begin_pass(&mut self, now: Time, _: [bool; 2]) {
        (self.state.now, self.state.fresh) = (now, false);
        self.state.inhibit = self.find_inhibit(now);
        self.state.measured.holding[LIMB] = self.state.jaw.holding();
    }

    fn end_pass(&mut self, now: Time) -> Vec<Order<'static>> {
        let here = self.q();
        let moves = std::mem::take(&mut self.state.moves);
        self.state.moved = moves;
        let held = self.state.q.unwrap_or(here);
        // A person has moved an arm at rest: it keeps its new posture.
        let was_pushed = !moves
            && furthest(&self.robot, LIMB, &held, &here).1 > self.settings.tolerances.path_rad;
        let q = if was_pushed { here } else { self.with_loose(held) };
        let is_heard = self.state.reading.is_some() && self.state.unusable.is_none();
        if self.state.sent.is_some_and(|sent| now.since(sent) < ORDER_EVERY) || !is_heard {
            return Vec::new();
        }
        let Some((jaw, grip_permille)) = self.state.jaw.advance(now) else { return Vec::new() };
        (self.state.q, self.state.sent) = (Some(q), Some(now));
        let mut goals = self.goals(&q);
        goals.push(jaw);
        vec![Told { goals, grip_permille, switch_on: self.shall_hold(now) }.into_order()]
    }

    fn inhibit(&self) -> MotionInhibit {
        self.state.inhibit
    }

    fn remedy_for_silence(&self) -> &'static str {
        "switch on the servos' supply and look at the plugs: whichone robot servos"
    }

    fn fault(&self) -> Option<Fault> {
        if let Some((part, reason)) = self.state.fault.clone() {
            return Some(Fault::Part { part, reason });
        }
        let (joint, error_rad) = furthest(&self.robot, LIMB, &self.state.q?, &self.q());
        let tolerance_rad = self.settings.tolerances.path_rad;
        let left = self.state.moved && error_rad > tolerance_rad;
        let setting = "arm.feetech.path_tolerance_rad";
        left.then(|| Fault::Path { joint: joint.to_owned(), error_rad, tolerance_rad, setting })
    }

    fn has_arrived(&mut self, command: &Command, late_s: f64) -> Result<bool, Fault> {
        let (joint, error_rad) = furthest(&self.robot, LIMB, &command.q, &self.q());
        let tolerance_rad = self.settings.tolerances.goal_rad;
        // Once it has arrived only the fingers are waited for: noise takes nothing back.
        let is_there = error_rad <= tolerance_rad && self.stands();
        let there = is_there || self.state.arrived == Some(command.q);
        self.state.arrived = there.then_some(command.q);
        if !there && late_s > self.settings.tolerances.goal_time_s {
            let settings = "arm.feetech.goal_tolerance_rad, goal_time_s";
            let joint = joint.to_owned();
            return Err(Fault::Goal { joint, error_rad, tolerance_rad, late_s, settings });
        }
        let done = command.fingers == Fingers::Stay || self.state.jaw.has_settled(self.state.now);
        if there && !done && late_s > FINGERS_MAX_S {
            return Err(Fault::Fingers { limb: LIMB, late_s });
        }
        Ok(there && done)
    }

    fn is_still(&self) -> bool {
        self.stands() && !self.state.jaw.is_moving()
    }

    fn hold_here(&mut self) {
        (self.state.q, self.state.moves, self.state.moved, self.state.fault) =
            (None, false, false, None);
        self.state.jaw.hold_here();
    }

    fn is_fresh(&self) -> bool {
        self.state.fresh
    }

    fn beat(&self) -> Option<Span> {
        Some(BEAT)
    }
}

/// Returns a position on the limit if it is a little beyond that.
fn on_limit(position: f64, (lower, upper): (f64, f64)) -> f64 {
    let within = position.clamp(lower, upper);
    if (within - position).abs() <= LIMIT_SLACK_RAD { within } else { position }
}
