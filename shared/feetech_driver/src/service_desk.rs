//! What a person does with the servos while no arm runs: look, write a calibration, switch them off.

use std::path::Path;

use config::Settings;
use diagnostics::{Diagnostic, Diagnostics, Report};
use manipulation::Robot;
use serde::Serialize;

use crate::bus::Bus;
use crate::handshake;
use crate::layout::{Layout, Member};
use crate::line::{Line, PortProblem, SerialLine};
use crate::registers::{
    LOCK, OFFSET, RANGE_MAX, RANGE_MIN, Register, STATE, STORED, State, Stored, TORQUE, with_sign,
};
use crate::session::{Ended, number};

/// Attempts at each servo.
const ATTEMPTS: u32 = 5;

/// The bus of a configured arm, used by this process alone.
#[derive(Debug)]
pub struct ServiceDesk {
    bus: Bus<SerialLine>,
    layout: Layout,
}

/// A servo as it is found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// Its number on the bus.
    pub id: u8,
    /// Its joint.
    pub joint: String,
    /// Its condition; `None` if it does not answer.
    pub state: Option<Condition>,
}

/// Condition of a servo.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// Radians; of the jaw percent.
    pub position: f64,
    /// The same, steps.
    pub steps: i32,
    /// It holds.
    pub holds: bool,
    /// Volts.
    pub volts: f64,
    /// °C.
    pub celsius: u8,
    /// Version of its firmware.
    pub firmware: String,
    /// What it reports.
    pub error: Option<String>,
    /// Registers that differ from the calibration.
    pub differences: Vec<String>,
}

/// What became of a servo.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Done {
    /// Its joint.
    pub joint: String,
    /// The reason why it was not done; `None` if it was.
    pub problem: Option<String>,
}

impl ServiceDesk {
    /// Opens the port of the configured arm.
    ///
    /// # Errors
    /// Another driver is configured, the calibration is missing, or the port cannot be used.
    pub fn open(settings: &Settings, robot: &Robot) -> Result<Self, Diagnostics> {
        if settings.arm.driver != crate::NAME {
            let what = format!("expected `{}`, found `{}`", crate::NAME, settings.arm.driver);
            let help = "name the profile of an arm on a bus of servos, `--profile NAME`, or `--set arm.driver=feetech`";
            return Err(settings.diagnostic(&["arm", "driver"], what, help).into());
        }
        let with = crate::setup::with(settings, robot).map_err(all)?;
        let line = SerialLine::open(&with.port, with.baud);
        let line = line.map_err(|problem| port_problem(settings, &with.port, &problem))?;
        Ok(Self { bus: Bus::new(line), layout: with.layout })
    }

    /// Returns every servo as it is.
    pub fn look(&mut self) -> Vec<Found> {
        let members = self.layout.members.clone();
        members.iter().map(|member| look(&mut self.bus, member)).collect()
    }

    /// Writes the calibration to the servos, so that it outlasts a loss of power.
    ///
    /// # Errors
    /// A servo holds: its joint would move, as its position would mean another one.
    pub fn write_calibration(&mut self) -> Result<Vec<Done>, String> {
        let found = self.look();
        let holding: Vec<&str> =
            found.iter().filter(|it| it.holds()).map(|it| it.joint.as_str()).collect();
        if !holding.is_empty() {
            return Err(format!(
                "expected servos without torque, found {} holding; help: support the arm, then `whichone robot servos \
                 --release`",
                holding.join(", ")
            ));
        }
        let members = self.layout.members.clone();
        Ok(each(&members, |member| write_one(&mut self.bus, member)))
    }

    /// Switches the torque of every servo off, also of those behind one that refuses.
    pub fn release(&mut self) -> Vec<Done> {
        let members = self.layout.members.clone();
        each(&members, |member| set(&mut self.bus, member.id(), TORQUE, 0))
    }
}

impl Found {
    fn holds(&self) -> bool {
        self.state.as_ref().is_some_and(|state| state.holds)
    }
}

fn each(members: &[Member], mut work: impl FnMut(&Member) -> Result<(), Ended>) -> Vec<Done> {
    let done = |member: &Member| Done {
        joint: member.joint.clone(),
        problem: work(member).err().map(|Ended(reason)| reason),
    };
    members.iter().map(done).collect()
}

fn look<L: Line>(bus: &mut Bus<L>, member: &Member) -> Found {
    let ids = [member.id()];
    let mut read = || {
        let stored = handshake::read_surely(bus, STORED, &ids, Stored::of).ok()?;
        let states = handshake::read_surely(bus, STATE, &ids, State::of).ok()?;
        let (stored, state) = (*stored.first()?, *states.first()?);
        let alone = Layout { members: vec![member.clone()] };
        Some(Condition {
            position: member.value(state.position),
            steps: state.position,
            holds: state.torque == 1,
            volts: f64::from(state.decivolts) / 10.0,
            celsius: state.celsius,
            firmware: format!("{}.{}", stored.firmware[0], stored.firmware[1]),
            error: state.errors.reason().map(str::to_owned),
            differences: handshake::differences(&[stored], &alone).collect(),
        })
    };
    let state = read();
    Found { id: member.id(), joint: member.joint.clone(), state }
}

/// Writes the calibration of one servo with the lock open, reads it back, and closes the lock.
fn write_one<L: Line>(bus: &mut Bus<L>, member: &Member) -> Result<(), Ended> {
    let (id, own) = (member.id(), member.calibrated);
    set(bus, id, LOCK, 0)?;
    let values = [
        (RANGE_MIN, own.range_min),
        (RANGE_MAX, own.range_max),
        (OFFSET, with_sign(own.homing_offset, 11)),
    ];
    let written =
        values.into_iter().try_for_each(|(register, value)| set(bus, id, register, value));
    let locked = set(bus, id, LOCK, 1);
    written.and(locked)
}

/// Writes a register of one servo until it is read back.
fn set<L: Line>(bus: &mut Bus<L>, id: u8, register: Register, value: u16) -> Result<(), Ended> {
    for _ in 0..ATTEMPTS {
        bus.write(register, &[(id, u64::from(value))])
            .map_err(|trouble| Ended(trouble.to_string()))?;
        if handshake::read_surely(bus, register, &[id], number)? == [value] {
            return Ok(());
        }
    }
    Err(Ended(format!("register {} does not take {value}", register.0)))
}

fn all(problems: Vec<Diagnostic>) -> Diagnostics {
    let mut report = Report::default();
    problems.into_iter().for_each(|problem| report.add(problem));
    match report.verdict(None::<()>) {
        Err(problems) => problems,
        Ok(()) => unreachable!("there is no value"),
    }
}

fn port_problem(settings: &Settings, port: &Path, problem: &PortProblem) -> Diagnostics {
    crate::setup::port_diagnostic(settings, port, problem).into()
}
