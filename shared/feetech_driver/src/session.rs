//! A bus in use: the handshake, and one exchange after the other. Nothing here moves the arm but the goals of orders.

use service::{Span, Time};

use crate::bus::{Bus, Trouble};
use crate::handshake::{self, Servos};
use crate::layout::Layout;
use crate::line::Line;
use crate::plausible::Plausibility;
use crate::registers::{
    ACCELERATION, GOAL, Register, SPEED_LIMIT, STATE, STORED, State, Stored, TARGET, TORQUE,
    TORQUE_LIMIT,
};
use crate::traffic::{Heard, Reading, Servo, Told};

/// Acceleration that the servos are set to, 100 steps/s²: the greatest, since goals accelerate gently by themselves. A
/// servo that has restarted has another one.
const ACCELERATION_SET: u16 = 254;
/// Torque with which a servo begins to hold, 0.1 %.
const SOFT_PERMILLE: u16 = 200;
/// Exchanges after which their numbers repeat: longer than an answer can be late. The torque differs by 1.5 %.
const TURNS: u16 = 16;
/// Time in which it grows to the whole torque.
const SOFT_START: Span = Span::from_ms(500);
/// Attempts at a write that is read back.
const ATTEMPTS: u32 = 5;
/// Readings in a row that fail before each servo is asked whether it is there.
const FAILURES_MAX: u32 = 8;
/// Requests in a row without an answer, after which a servo is missing.
const UNANSWERED_MAX: u32 = 3;
/// Readings in a row in which a servo does not have its goal, before that is reported.
const UNHEEDED_MAX: u32 = 20;
/// Interval between looks at the stored registers.
const STORED_EVERY: Span = Span::from_ms(1_000);
/// How far outside of its range a joint may stand that begins to hold, steps: its servo moves it into the range.
const OUTSIDE_MAX: i32 = 30;
/// A servo that was too hot must be this much below its limit, °C.
const COOLER: u8 = 10;

/// Settings that are written to the servos.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Greatest speed, steps/s.
    pub(crate) speed: u16,
    /// Greatest torque of the joints, 0.1 %.
    pub(crate) joints_permille: u16,
}

/// The end of a session.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct Ended(pub(crate) String);

/// A bus whose servos are those of the calibration.
#[derive(Debug)]
pub(crate) struct Session<L> {
    bus: Bus<L>,
    layout: Layout,
    ids: Vec<u8>,
    limits: Limits,
    servos: Servos,
    /// Goals; empty before the first.
    goals: Vec<u16>,
    /// Goals and limits of torque that were written last; empty before the first.
    written: Vec<(u16, u16)>,
    /// Number of the latest exchange, which the limits of torque carry.
    turn: u16,
    /// Those that hold.
    holds: Vec<bool>,
    /// All of them were told to hold.
    is_on: bool,
    /// Those that were told so last, and when.
    begun: Vec<bool>,
    begun_at: Time,
    grip_permille: u16,
    plausibility: Plausibility,
    failures: u32,
    /// Requests in a row that each servo has not answered.
    unanswered: Vec<u32>,
    unheeded: u32,
    /// Time of the latest look at the stored registers.
    looked: Time,
}

impl<L: Line> Session<L> {
    /// Looks for the servos, and compares them with the calibration. Servos that hold go on.
    ///
    /// # Errors
    /// Servos that are missing, of another model, or calibrated otherwise.
    pub(crate) fn begin(line: L, layout: Layout, limits: Limits) -> Result<Self, Ended> {
        let mut bus = Bus::new(line);
        let servos = handshake::shake(&mut bus, &layout)?;
        let (ids, looked) = (layout.ids(), bus.line.now());
        let servo_count = ids.len();
        let none = vec![false; servo_count];
        let mut session = Self {
            bus,
            layout,
            ids,
            limits,
            servos,
            goals: Vec::new(),
            written: Vec::new(),
            turn: 0,
            holds: none.clone(),
            is_on: false,
            begun: none,
            begun_at: Time(0),
            grip_permille: SOFT_PERMILLE,
            plausibility: Plausibility::default(),
            failures: 0,
            unanswered: vec![0; servo_count],
            unheeded: 0,
            looked,
        };
        let states = session.read_surely()?;
        // An arm's service that was killed has left them so.
        session.holds = states.iter().map(|state| session.has_settings(state)).collect();
        session.is_on = session.holds.iter().all(|holds| *holds);
        session.grip_permille = states.last().map_or(SOFT_PERMILLE, |jaw| jaw.torque_limit);
        Ok(session)
    }

    /// Reads the servos, then tells them their goals. In this order, since a new goal ends the overload of a servo.
    ///
    /// # Errors
    /// The device is gone, or what is on it is not the arm any more.
    pub(crate) fn exchange(&mut self, told: &Told) -> Result<Option<Heard>, Ended> {
        if told.switch_on && !self.all_hold() {
            self.switch_on()?;
        }
        let asked = self.bus.line.now();
        let heard = match self.bus.read(STATE, &self.ids, State::of) {
            Ok(states) => {
                self.failures = 0;
                self.unanswered.fill(0);
                self.judge(&states, asked)?
            }
            Err(trouble) => self.failed(&trouble)?,
        };
        if self.is_on && !told.switch_on && told.goals.len() == self.ids.len() {
            let goals = self.layout.members.iter().zip(&told.goals);
            self.goals = goals.map(|(member, value)| member.steps(*value)).collect();
            self.grip_permille = told.grip_permille;
        }
        self.write_targets(asked)?;
        self.look_at_stored()?;
        Ok(heard)
    }

    /// Writes goals and limits to the servos that hold.
    fn write_targets(&mut self, now: Time) -> Result<(), Ended> {
        self.turn = (self.turn + 1) % TURNS;
        let limits = self.torque_limits(now);
        let targets = self.goals.iter().zip(limits);
        self.written =
            targets.map(|(goal, limit)| (*goal, limit.saturating_sub(self.turn))).collect();
        let speed = u64::from(self.limits.speed);
        let value =
            |(goal, limit): (u16, u16)| u64::from(goal) | speed << 32 | u64::from(limit) << 48;
        let targets = self.ids.iter().zip(&self.written).zip(&self.holds);
        let targets: Vec<(u8, u64)> = targets
            .filter(|(_, holds)| **holds)
            .map(|((id, target), _)| (*id, value(*target)))
            .collect();
        if targets.is_empty() { Ok(()) } else { self.write(TARGET, &targets) }
    }

    /// Writes without an answer. Noise on the line is found by the reading that follows.
    fn write(&mut self, register: Register, values: &[(u8, u64)]) -> Result<(), Ended> {
        match self.bus.write(register, values) {
            Err(trouble) if trouble.is_of_device() => Err(Ended(trouble.to_string())),
            _ => Ok(()),
        }
    }

    fn failed(&mut self, trouble: &Trouble) -> Result<Option<Heard>, Ended> {
        if trouble.is_of_device() {
            return Err(Ended(trouble.to_string()));
        }
        self.failures += 1;
        tracing::debug!(%trouble, self.failures, "reading of the servos rejected");
        if self.failures < FAILURES_MAX {
            return Ok(None);
        }
        self.look_for_one()
    }

    /// Asks one servo after the other whether it is there, one in each exchange: goals shall not wait for this.
    fn look_for_one(&mut self) -> Result<Option<Heard>, Ended> {
        let place = self.failures as usize % self.ids.len();
        let answers =
            self.bus.ping(self.ids[place]).map_err(|trouble| Ended(trouble.to_string()))?;
        self.unanswered[place] = if answers { 0 } else { self.unanswered[place] + 1 };
        let all = self.ids.len();
        if self.failures < FAILURES_MAX + UNANSWERED_MAX * all as u32 {
            return Ok(None);
        }
        let missing = self.layout.members.iter().zip(&self.unanswered);
        let missing = missing.filter(|(_, count)| **count >= UNANSWERED_MAX);
        let missing: Vec<String> = missing.map(|(member, _)| member.name()).collect();
        Ok(match missing.len() {
            0 => None,
            some if some == all => Some(Heard::Unusable("no servo answers any more".to_owned())),
            _ => Some(Heard::Unusable(format!("no answer of {}", missing.join(", ")))),
        })
    }

    fn judge(&mut self, states: &[State], asked: Time) -> Result<Option<Heard>, Ended> {
        if let Some(place) = self.disobedient(states) {
            self.unheeded += 1;
            if self.unheeded < UNHEEDED_MAX {
                // What was written was lost, or the answer is one that was late.
                return Ok(None);
            }
            let (name, State { goal, torque_limit, .. }) =
                (self.layout.members[place].name(), states[place]);
            return Err(Ended(format!(
                "{name} does not keep goal and limit of torque: expected {:?}, found {:?}",
                self.written[place],
                (goal, torque_limit)
            )));
        }
        self.unheeded = 0;
        let is_plausible = self.plausibility.accepts(states, asked);
        for (place, state) in states.iter().enumerate() {
            self.holds[place] &= self.has_settings(state);
        }
        let is_ready = self.is_on && self.all_hold() && asked >= self.begun_at + SOFT_START;
        let servos = states.iter().enumerate().map(|(place, state)| self.servo(place, state));
        let reading = Reading { at: asked, is_plausible, is_ready, servos: servos.collect() };
        Ok(Some(Heard::Reading(reading)))
    }

    /// The place of a servo that holds and has not what was written last. The limit of torque changes a little with
    /// every exchange: so an answer of an earlier one is found, which nothing else in it tells.
    fn disobedient(&self, states: &[State]) -> Option<usize> {
        let mut written = states.iter().zip(&self.written).enumerate();
        written.find_map(|(place, (state, written))| {
            let holds = self.holds[place] && self.has_settings(state);
            (holds && (state.goal, state.torque_limit) != *written).then_some(place)
        })
    }

    /// The settings of a servo that holds: those that it was told, which a restart takes away.
    fn has_settings(&self, state: &State) -> bool {
        (u16::from(state.torque), u16::from(state.acceleration)) == (1, ACCELERATION_SET)
    }

    fn all_hold(&self) -> bool {
        self.holds.iter().all(|holds| *holds)
    }

    fn servo(&self, place: usize, state: &State) -> Servo {
        let member = &self.layout.members[place];
        Servo {
            value: member.value(state.position),
            speed: member.speed(state.speed),
            load: f64::from(state.load) / 1000.0,
            volts: f64::from(state.decivolts) / 10.0,
            celsius: state.celsius,
            errors: state.errors,
            holds: self.holds[place],
            has_let_go: self.is_on && !self.holds[place],
            is_cool: state.celsius.saturating_add(COOLER) <= self.servos.heat_limits[place],
        }
    }

    /// Limits of torque at a time: soft at first for those that began to hold.
    fn torque_limits(&self, now: Time) -> Vec<u16> {
        let grown = (now.since(self.begun_at).s() / SOFT_START.s()).min(1.0);
        let jaw = self.ids.len() - 1;
        let of = |place: usize| {
            let whole = if place == jaw { self.grip_permille } else { self.limits.joints_permille };
            let soft = SOFT_PERMILLE.min(whole);
            if self.begun[place] { soft + (grown * f64::from(whole - soft)) as u16 } else { whole }
        };
        (0..self.ids.len()).map(of).collect()
    }

    /// Compares the stored registers once a second.
    fn look_at_stored(&mut self) -> Result<(), Ended> {
        let now = self.bus.line.now();
        if now.since(self.looked) < STORED_EVERY {
            return Ok(());
        }
        self.looked = now;
        match self.bus.read(STORED, &self.ids, Stored::of) {
            Ok(stored) => handshake::compare(&stored, &self.layout).map_err(Ended),
            Err(trouble) if trouble.is_of_device() => Err(Ended(trouble.to_string())),
            Err(_) => Ok(()),
        }
    }

    /// Has every servo hold that does not: where it is, softly at first. Those that hold keep their goals.
    fn switch_on(&mut self) -> Result<(), Ended> {
        let stored = handshake::read_surely(&mut self.bus, STORED, &self.ids, Stored::of)?;
        handshake::compare(&stored, &self.layout).map_err(Ended)?;
        let states = self.read_surely()?;
        self.begun = states.iter().map(|state| !self.has_settings(state)).collect();
        self.begun_at = self.bus.line.now();
        self.goals = states.iter().map(|state| self.present(state)).collect::<Result<_, _>>()?;
        let speed = self.limits.speed;
        let settings =
            [(ACCELERATION, ACCELERATION_SET), (SPEED_LIMIT, speed), (TORQUE_LIMIT, SOFT_PERMILLE)];
        for (register, value) in settings {
            self.write_surely(register, &vec![value; self.ids.len()])?;
        }
        let goals = self.goals.clone();
        self.write_surely(GOAL, &goals)?;
        self.write_surely(TORQUE, &vec![1; self.ids.len()])?;
        (self.holds, self.is_on) = (vec![true; self.ids.len()], true);
        (self.begun_at, self.plausibility) = (self.bus.line.now(), Plausibility::default());
        // The next reading has what is written with the next goals.
        self.written.clear();
        Ok(())
    }

    /// The goal of a servo that is to hold where it is; one that holds already keeps its own.
    fn present(&self, state: &State) -> Result<u16, Ended> {
        if self.has_settings(state) {
            return Ok(state.goal);
        }
        let member = self.layout.members.iter().find(|member| member.id() == state.id);
        let member = member.ok_or_else(|| Ended(format!("no servo {}", state.id)))?;
        let range = [member.calibrated.range_min, member.calibrated.range_max].map(i32::from);
        let within = state.position.clamp(range[0], range[1]);
        if (within - state.position).abs() > OUTSIDE_MAX {
            return Err(Ended(format!(
                "{} stands at step {}, outside of its range {} to {}; help: move the joint into it by hand",
                member.name(),
                state.position,
                range[0],
                range[1]
            )));
        }
        Ok(within as u16)
    }

    /// Writes a register of those servos that begin to hold, and reads it back.
    fn write_surely(&mut self, register: Register, values: &[u16]) -> Result<(), Ended> {
        for _ in 0..ATTEMPTS {
            let of = |place: &usize| self.begun[*place];
            let places: Vec<usize> = (0..self.ids.len()).filter(of).collect();
            let written: Vec<(u8, u16)> =
                places.iter().map(|place| (self.ids[*place], values[*place])).collect();
            let values: Vec<(u8, u64)> =
                written.iter().map(|(id, value)| (*id, u64::from(*value))).collect();
            self.write(register, &values)?;
            let ids: Vec<u8> = written.iter().map(|(id, _)| *id).collect();
            let found = handshake::read_surely(&mut self.bus, register, &ids, number)?;
            if found.iter().zip(&written).all(|(found, (_, value))| found == value) {
                return Ok(());
            }
        }
        Err(Ended(format!("register {} of a servo does not take its value", register.0)))
    }

    fn read_surely(&mut self) -> Result<Vec<State>, Ended> {
        handshake::read_surely(&mut self.bus, STATE, &self.ids, State::of)
    }
}

/// The number in an answer of one or two bytes.
pub(crate) fn number(answer: &crate::packet::Answer<'_>) -> u16 {
    answer.data.iter().rev().fold(0, |number, byte| number << 8 | u16::from(*byte))
}
