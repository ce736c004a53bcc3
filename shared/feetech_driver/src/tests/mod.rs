//! Driver, session and a simulated bus in a time of their own.

mod faults;
mod handling;
mod jaw;
mod port;
mod protection;

use std::cell::RefCell;
use std::io;
use std::path::PathBuf;
use std::rc::Rc;

use arm_driver::{ArmDriver, Command, Fault, Fingers, Grip, Posture, Start};
use diagnostics::TextFile;
use manipulation::{Joints, Limb, Robot};
use messages::MotionInhibit;
use service::{Span, Time};
use servo_bus::Bus;

use crate::calibration::{Calibrated, Calibration};
use crate::driver::FeetechDriver;
use crate::layout::Layout;
use crate::line::Line;
use crate::session::{Ended, Limits, Session};
use crate::settings::{Feetech, Tolerances, Torques};
use crate::traffic::{Heard, Reading, Told};

/// Id, homing offset and range of six servos, and of the jaw's.
const SERVOS: [(&str, i32, u16, u16); 7] = [
    ("shoulder_pan_joint", -57, 751, 3471),
    ("shoulder_lift_joint", 1105, 812, 3230),
    ("elbow_joint", -964, 869, 3071),
    ("wrist_1_joint", 210, 890, 3228),
    ("wrist_2_joint", -1500, 0, 4095),
    ("wrist_3_joint", 12, 900, 3200),
    ("gripper", 640, 2033, 3490),
];
/// The jaw's place.
const JAW: usize = 6;
/// Time between two passes.
const PASS: Span = Span::from_ms(10);

/// A line to a simulated bus, which waits in the bus's own time.
#[derive(Clone)]
struct SimLine {
    bus: Rc<RefCell<Bus>>,
}

fn seconds(time: Time) -> f64 {
    time.ns() as f64 * 1e-9
}

impl Line for SimLine {
    fn now(&self) -> Time {
        Time((self.bus.borrow().now_s() * 1e9).round() as u64)
    }

    fn wait_until(&mut self, time: Time) {
        self.bus.borrow_mut().advance_to(seconds(time));
    }

    fn discard(&mut self) -> io::Result<()> {
        drop(self.bus.borrow_mut().give());
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut bus = self.bus.borrow_mut();
        let sent_s = bus.now_s() + 10e-6 * bytes.len() as f64;
        bus.advance_to(sent_s);
        bus.take(bytes);
        Ok(())
    }

    fn receive(&mut self, into: &mut Vec<u8>, until: Time) -> io::Result<bool> {
        let mut bus = self.bus.borrow_mut();
        let until_s = seconds(until);
        match bus.next_s() {
            Some(next_s) if next_s <= until_s => bus.advance_to(next_s),
            _ => bus.advance_to(until_s + 1e-9),
        }
        let given = bus.give();
        into.extend_from_slice(&given);
        Ok(!given.is_empty())
    }
}

fn calibration() -> Calibration {
    let servos = SERVOS.iter().zip(1..).map(|((name, homing_offset, range_min, range_max), id)| {
        let (homing_offset, range_min, range_max) = (*homing_offset, *range_min, *range_max);
        ((*name).to_owned(), Calibrated { id, homing_offset, range_min, range_max })
    });
    Calibration { file: PathBuf::from("/arm.json"), servos: servos.collect() }
}

pub(crate) fn settings() -> Feetech {
    Feetech {
        port: PathBuf::from("/dev/null"),
        baud: 1_000_000,
        robot_id: Some("arm".to_owned()),
        calibration: None,
        gripper: "gripper".to_owned(),
        joints: Vec::new(),
        openings: Vec::new(),
        speed_max_rad_s: 1.5,
        torque: Torques { joints_percent: 100.0, grip_percent: 40.0, hold_percent: 20.0 },
        tolerances: Tolerances {
            path_rad: 0.2,
            goal_rad: 0.03,
            goal_time_s: 1.5,
            still_rad_s: 0.05,
            stale_s: 0.15,
        },
    }
}

/// An arm of six joints that turn by half a turn at most.
fn robot() -> Robot {
    let narrow = "\"-1.5\" upper=\"1.5\"";
    let wide = ["6.283185307179586", "3.141592653589793"]
        .map(|most| format!("\"-{most}\" upper=\"{most}\""));
    let postures =
        [("-2.0", "-1.4"), ("2.0", "1.4"), ("-1.8", "-1.4"), ("-1.5708", "-1.4"), ("1.5", "1.4")];
    let value = |text: &str| format!("value=\"{text}\"");
    robot_of("ur5e", &|text| {
        let text = wide.iter().fold(text, |text, wide| text.replace(wide, narrow));
        postures.iter().fold(text, |text, (old, new)| text.replace(&value(old), &value(new)))
    })
}

/// A robot that ships, its files changed.
pub(crate) fn robot_of(name: &str, change: &dyn Fn(String) -> String) -> Robot {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/robots");
    let read = |ending: &str| {
        let text = std::fs::read_to_string(format!("{folder}/{name}.{ending}")).unwrap();
        TextFile::new(format!("{name}.{ending}"), change(text))
    };
    let description = robot_model::Robot::read(&read("urdf"), Some(&read("srdf"))).unwrap();
    Robot::from_description(&description).unwrap()
}

/// The arm as a group has it, without its service.
struct Rig {
    bus: Rc<RefCell<Bus>>,
    session: Result<Session<SimLine>, Ended>,
    driver: FeetechDriver,
    told: Told,
    /// The latest reading, plausible or not.
    reading: Option<Reading>,
    /// Faults that the driver reported, with their times.
    faults: Vec<(f64, Fault)>,
    /// The pose of each joint at the start of a motion.
    from: Joints,
    began_s: f64,
}

impl Rig {
    /// A calibrated arm in the middle of its ranges, without torque.
    fn new() -> Self {
        let mut bus = Bus::new(7);
        for (servo, (_, offset, least, most)) in bus.servos.iter_mut().zip(SERVOS) {
            servo.calibrate(offset, (least, most));
            servo.stand_at(0.5 * (f64::from(least) + f64::from(most)));
        }
        Self::on(bus)
    }

    fn on(bus: Bus) -> Self {
        let bus = Rc::new(RefCell::new(bus));
        let session = Self::session(&bus);
        let robot = robot();
        let posture = Posture { joints: [[0.0; 7]; 2], width_m: [0.0; 2] };
        let start = Start { robot: &robot, limb: None, posture, holding: None };
        let driver = FeetechDriver::new(settings(), &start);
        Self {
            bus,
            session,
            driver,
            told: Told::default(),
            reading: None,
            faults: Vec::new(),
            from: [0.0; 7],
            began_s: 0.0,
        }
    }

    fn session(bus: &Rc<RefCell<Bus>>) -> Result<Session<SimLine>, Ended> {
        let layout = Layout::new(&settings(), &robot(), &calibration()).unwrap();
        let limits = Limits { speed: 978, joints_permille: 1000 };
        Session::begin(SimLine { bus: Rc::clone(bus) }, layout, limits)
    }

    fn now(&self) -> Time {
        SimLine { bus: Rc::clone(&self.bus) }.now()
    }

    fn now_s(&self) -> f64 {
        self.bus.borrow().now_s()
    }

    /// A pass of the arm, with a command or none, and an exchange with the servos.
    fn pass(&mut self, command: Option<Command>) {
        let now = self.now();
        self.driver.begin_pass(now, [true; 2]);
        if let Some(fault) = self.driver.fault() {
            self.faults.push((self.now_s(), fault));
            self.driver.hold_here();
        }
        command.into_iter().for_each(|command| self.driver.command(&command, PASS.s()));
        for order in self.driver.end_pass(now) {
            self.told = Told::of(&order).unwrap();
        }
        self.exchange();
        let mut line = SimLine { bus: Rc::clone(&self.bus) };
        line.wait_until(now + PASS);
    }

    fn exchange(&mut self) {
        let heard = match &mut self.session {
            Ok(session) => session.exchange(&self.told),
            Err(Ended(reason)) => Err(Ended(reason.clone())),
        };
        let heard = heard.unwrap_or_else(|Ended(reason)| {
            // The thread opens the port again after a second.
            let next = self.now() + Span::from_ms(1_000);
            SimLine { bus: Rc::clone(&self.bus) }.wait_until(next);
            (self.session, self.told) = (Self::session(&self.bus), Told::default());
            Some(Heard::Unusable(reason))
        });
        let Some(heard) = heard else { return };
        if let Heard::Reading(reading) = &heard {
            self.reading = Some(reading.clone());
        }
        self.driver.on_report(&heard.into_report(), self.now());
    }

    /// Passes until the driver is ready, at most for so many seconds.
    fn until_ready(&mut self, longest_s: f64) {
        let end_s = self.now_s() + longest_s;
        while self.driver.inhibit() != MotionInhibit::None {
            assert!(
                self.now_s() < end_s,
                "not ready: {:?}, {:?}",
                self.driver.inhibit(),
                self.session.as_ref().err()
            );
            self.pass(None);
        }
        (self.from, self.began_s) = (self.driver.measured().posture.joints[0], self.now_s());
    }

    /// Passes for so many seconds without a command.
    fn rest(&mut self, longest_s: f64) {
        let end_s = self.now_s() + longest_s;
        while self.now_s() < end_s {
            self.pass(None);
        }
    }

    /// All joints swing about where they were, by 0.16 rad.
    fn swing(&self, fingers: Fingers) -> Command {
        let t_s = self.now_s() - self.began_s;
        // Twice a second, from rest.
        let (w, mut q) = (4.0 * std::f64::consts::PI, self.from);
        q[..6].iter_mut().for_each(|q| *q += 0.08 * (1.0 - (w * t_s).cos()));
        let qd = [0.08 * w * (w * t_s).sin(); 7];
        Command { limb: Limb::Only, q, qd, qdd: [0.0; 7], t_s, fingers }
    }

    /// Stay where they were, with this command to the fingers.
    fn stay(&self, fingers: Fingers) -> Command {
        Command { limb: Limb::Only, q: self.from, qd: [0.0; 7], qdd: [0.0; 7], t_s: 1.0, fingers }
    }

    fn steps(&self, place: usize) -> f64 {
        self.bus.borrow().servos[place].shown()
    }

    fn speeds(&self) -> Vec<f64> {
        self.bus.borrow().servos.iter().map(|servo| servo.speed).collect()
    }
}

const GRIP: Fingers = Fingers::Grip(Grip { object_m: 0.02, offset_m: 0.0 });
