//! A simulated Baxter behind the robot's own topics, for use without the hardware, and for tests of
//! failures of a real one.
//!
//! [`robot::Robot`] is the robot, pure and driven by time; [`BaxterNode`] makes a service of it. Its
//! journal is not the robot's memory but the world: joints, fingers and objects stay
//! where they are while the process is dead.

pub mod assembly;
pub mod camera;
pub mod fault_injection;
pub mod fingers;
pub mod object_world;
mod publish;
pub mod robot;
pub mod servo;
pub mod settings;
pub mod shell;

use std::process::ExitCode;

use camera::CameraSettings;
use config::{Part, Registered};
use messages::robot::{Drill, Order, Report};
use perception::Sighting;
use robot::{Body, Robot};
use scene::Scene;
use serde::{Deserialize, Serialize};
use service::{Effects, Event, Node, NodeError, Span, Time};
use settings::Simulated;

/// The section of the simulation. Its service, `baxter`, is one of the core's, which may have another program.
pub static PART: Part =
    Part { name: "baxter", service: None, sections: &[Registered::of::<Simulated>()] };

/// The program.
pub const PROGRAM: Result<fn() -> ExitCode, &str> = Ok(run);

/// Runs the program: a service of a group, or, with the name of a drill, fault injection into one that runs.
pub fn run() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().and_then(|word| fault_injection::kind(word)) {
        Some(kind) => fault_injection::run(kind, &words[1..]),
        None => service::service_loop::run::<shell::BaxterProgram>(),
    }
}

/// Inputs of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In<'a> {
    /// An order of the arm.
    Order(Order<'a>),
    /// Injected faults and button presses.
    Drill(Drill),
}

/// Outputs of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Out {
    /// What the robot measures.
    Report(Report<'static>),
    /// What the camera above the table sees.
    Sighting(Box<Sighting>),
}

type Fx = Effects<Out, Body>;

/// Configuration of the robot.
#[derive(Clone, Debug)]
pub struct Config {
    /// Its limbs.
    pub robot: manipulation::Robot,
    /// Dynamics and measurement noise of the joints.
    pub simulated: Simulated,
    /// Standard deviation of the objects' offsets across the fingers, metres.
    pub grasp_error_m: f64,
    /// True if users put back the objects that they were handed once the robot rests.
    pub restock: bool,
    /// The camera above the table, if there is one.
    pub camera: Option<CameraSettings>,
    /// Scene around it.
    pub scene: Scene,
}

/// Time between two cycles.
const BEAT: Span = Span::from_ms(10);
/// Interval between journal records of moving joints.
const REMEMBER_EVERY: Span = Span::from_ms(200);
/// A joint that moved less than this has not moved, radians.
const MOVED_RAD: f64 = 1e-3;

/// The robot as a reducer.
#[derive(Debug)]
pub struct BaxterNode {
    robot: Robot,
    beat: u64,
    next: Time,
    /// A cycle was published; changes are journaled before the next one.
    published: bool,
    remembered: (Body, Time),
}

impl Node for BaxterNode {
    type Config = Config;
    type In<'a> = In<'a>;
    type Out = Out;
    type Record = Body;

    fn recover(config: Config, mut records: Vec<Body>) -> Result<Self, NodeError> {
        let robot = Robot::new(config, records.pop());
        let remembered = (robot.body(), Time(0));
        Ok(Self { robot, beat: 0, next: Time(0), published: false, remembered })
    }

    fn on(&mut self, event: Event<In<'_>>, now: Time, fx: &mut Fx) {
        match event {
            Event::SetAside(_) => {}
            Event::Started => self.next = now,
            Event::Message(message) => self.robot.on_message(&message, now),
            Event::Tick => self.tick(now, fx),
            Event::Shutdown => {
                fx.append(self.robot.body());
                fx.exit();
            }
        }
    }

    fn deadline(&self) -> Option<Time> {
        Some(if self.published { Time(0) } else { self.next })
    }

    fn snapshot(&self) -> Option<Vec<Body>> {
        Some(vec![self.robot.body()])
    }
}

impl BaxterNode {
    /// Returns the robot, for tests.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    fn tick(&mut self, now: Time, fx: &mut Fx) {
        self.robot.advance(now);
        // The disk is waited for between two cycles.
        if std::mem::take(&mut self.published) && now < self.next {
            return self.remember(now, fx);
        }
        self.published = true;
        let reports = self.robot.reports(self.beat, now).into_iter().map(Out::Report);
        reports.for_each(|report| fx.publish(report));
        let looks = self.robot.look(now).into_iter();
        looks.for_each(|look| fx.publish(Out::Sighting(Box::new(look))));
        self.beat += 1;
        self.next = self.next + BEAT;
        if self.next <= now {
            self.next = now + BEAT;
        }
    }

    /// Journals changes: the joints at intervals, everything else at once.
    fn remember(&mut self, now: Time, fx: &mut Fx) {
        let body = self.robot.body();
        let (last, at) = &self.remembered;
        let other = body.assembly != last.assembly
            || body.objects != last.objects
            || body.closings != last.closings;
        let moved = body != *last && {
            let joints = body.joints.iter().flatten().zip(last.joints.iter().flatten());
            let fingers = body.fingers != last.fingers;
            fingers || joints.into_iter().any(|(a, b)| (a - b).abs() > MOVED_RAD)
        };
        if other || moved && now.since(*at) >= REMEMBER_EVERY {
            fx.append(body.clone());
            self.remembered = (body, now);
        }
    }
}
