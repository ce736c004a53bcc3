//! The arm: fetches the ordered object exactly once, points at objects, and stops when told.
//!
//! [`ArmNode`] is the reducer. Invariant: a motion that belongs to a phase of a pick is commanded
//! only once that phase is durable, and what is to be done next depends on durable facts and
//! sensors alone, so the arm can be killed at any instant and goes on from there. The runtime
//! commits between two ticks and calls at most one tick between two commits; that is what "once
//! durable" rests on: a phase is recorded in one tick and its motion begins in a later one.

mod course;
mod driver;
mod executor;
mod goal;
mod hindered;
mod inspection;
mod motion;
mod orders;
mod program;
mod publish;
pub mod recover;
pub mod shell;
pub mod state;
mod world;

#[cfg(test)]
mod tests;

pub use driver::{
    ArmDriver, BaxterDriver, Command, Fault, Fingers, Grip, KinematicArm, Measured, Order, Source,
    Told,
};

use course::Course;
use executor::Executor;
use goal::Setbacks;
use messages::{
    ArmStatus, Hindrance, JointStates, MotionCommand, RobotAct, TrajectoryView, WorldView,
};
use orders::StandingAct;
use preflight::ArmSetup;
use publish::{Facts, Publisher};
use scene::{ObjectId, Scene};
use service::{Effects, Event, Node, NodeError, Span, Time};
use state::{ArmState, Cause, Record};
use world::World;

/// What arrives.
#[derive(Clone, Debug, PartialEq)]
pub enum In {
    /// From the policy: what to do.
    Act(Box<RobotAct>),
    /// From speech and clients: stop, or go on.
    Motion(MotionCommand),
    /// From the robot, where there is one: what it measures.
    Robot(Told),
}

/// What is published.
#[derive(Clone, Debug, PartialEq)]
pub enum Out {
    /// To policy and speech: how far a pick has come, and what is aimed at.
    Status(ArmStatus),
    /// To clients: where the joints are.
    Joints(Box<JointStates>),
    /// To clients: where the objects are.
    World(Box<WorldView>),
    /// To clients: which way the gripper is going.
    Trajectory(Box<TrajectoryView>),
    /// To the robot, where there is one: what it is to do.
    Robot(Order),
}

type Fx = Effects<Out, Record>;

/// What the arm is configured with.
#[derive(Clone, Debug)]
pub struct Config {
    /// Driver, time scale, grasps, and the simulated world.
    pub arm: config::Arm,
    /// Robot, limb and settings of motions.
    pub setup: ArmSetup,
    /// The objects and their places.
    pub scene: Scene,
}

/// The arm as a reducer.
pub struct ArmNode {
    config: Config,
    world: World,
    state: ArmState,
    driver: Box<dyn ArmDriver>,
    executor: Executor,
    publisher: Publisher,
    course: Course,
    act: StandingAct,
    /// What the gripper aims at, standing still.
    aimed: Option<ObjectId>,
    setbacks: Setbacks,
    /// When the motion was last carried on.
    stepped: Time,
    recorded: Time,
    /// Something is to be done in the next pass, or by the end of this one.
    urgent: bool,
    scene_changed: bool,
    /// What kept the robot from moving in the pass before.
    hindrance: Hindrance,
    ending: bool,
}

/// Longest time between two steps of a motion.
const STEP_EVERY: Span = Span::from_ms(10);

impl Node for ArmNode {
    type Config = Config;
    type In = In;
    type Out = Out;
    type Record = Record;

    fn recover(config: Config, records: Vec<Record>) -> Result<Self, NodeError> {
        let state = recover::state(&config, records)?;
        let driver = match config.arm.driver {
            config::Driver::Kinematic => Box::new(KinematicArm::at(&state)) as Box<dyn ArmDriver>,
            config::Driver::Baxter => Box::new(BaxterDriver::new(&config, &state)),
        };
        Ok(Self::with_driver(config, state, driver))
    }

    fn on(&mut self, event: Event<In>, now: Time, fx: &mut Fx) {
        match event {
            Event::Started => self.begin(now, fx),
            Event::Message(In::Motion(command)) => self.obey(&command, now, fx),
            Event::Message(In::Act(act)) => self.hear(&act, now, fx),
            Event::Message(In::Robot(told)) => self.driver.hear(&told, now),
            Event::Tick => self.tick(now, fx),
            Event::Shutdown => {
                self.ending = true;
                self.executor.halt();
                self.urgent = true;
            }
        }
    }

    fn deadline(&self) -> Option<Time> {
        let due = self.publisher.deadline();
        if self.urgent || self.driver.is_fresh() {
            return Some(Time(0));
        }
        let moving = (!self.executor.is_standing()).then_some(STEP_EVERY);
        let beat = self.driver.beat().or(moving);
        Some(beat.map_or(due, |beat| due.min(self.stepped + beat)))
    }

    fn snapshot(&self) -> Option<Vec<Record>> {
        if self.state.open_pick().is_some() || !self.executor.is_standing() {
            return None;
        }
        let state = ArmState { posture: self.driver.measured().posture, ..self.state.clone() };
        Some(vec![Record { cause: Cause::Snapshot, at: self.recorded, state }])
    }
}

impl ArmNode {
    /// The arm in `state` with another driver than the configured one.
    pub fn with_driver(config: Config, state: ArmState, driver: Box<dyn ArmDriver>) -> Self {
        let settled = recover::other_scene(&state, &config.scene);
        let scene_changed = settled.is_some();
        Self {
            world: World::new(&config.setup.robot, &config.scene),
            publisher: Publisher::new(&config.arm),
            course: Course::default(),
            state: settled.unwrap_or(state),
            driver,
            executor: Executor::default(),
            act: StandingAct::default(),
            aimed: None,
            setbacks: Setbacks::default(),
            stepped: Time(0),
            recorded: Time(0),
            urgent: false,
            scene_changed,
            hindrance: Hindrance::None,
            ending: false,
            config,
        }
    }

    /// The state, for tests and simulation.
    pub fn state(&self) -> &ArmState {
        &self.state
    }

    fn begin(&mut self, now: Time, fx: &mut Fx) {
        (self.stepped, self.recorded, self.urgent) = (now, now, true);
        // The monotonic clock begins anew with the machine; an order of its last life must not
        // outrank those of this one.
        if self.state.obeyed > now {
            self.state.obeyed = Time(0);
        }
        if self.scene_changed {
            tracing::warn!("the scene has changed: its objects stand in their places");
            self.record(Cause::SceneChanged, now, fx);
        }
        if let Some(pick) = self.state.open_pick() {
            tracing::info!(pick = ?pick.id, phase = ?pick.phase, "a pick is open; going on with it");
        }
        self.publish(now, fx);
    }

    fn tick(&mut self, now: Time, fx: &mut Fx) {
        self.urgent = false;
        let seconds = self.passed_s(now);
        self.feel(now, fx);
        self.decide(now, fx);
        self.step(seconds, now, fx);
        self.hint(now, fx);
        if self.ending && self.executor.is_standing() {
            self.record(Cause::Shutdown, now, fx);
            fx.exit();
        }
        self.driver.end_pass(now).into_iter().for_each(|order| fx.publish(Out::Robot(order)));
        self.publish(now, fx);
    }

    fn publish(&mut self, now: Time, fx: &mut Fx) {
        let measured = self.driver.measured();
        let aims = self.aimed.is_some() && self.aimed == self.act.aim;
        let facts = Facts {
            state: &self.state,
            measured: &measured,
            executor: &self.executor,
            world: &self.world,
            aimed: aims.then_some(self.act.id),
            hindrance: self.driver.hindrance(),
        };
        self.publisher.tick(&facts, now, fx);
        if let Some(view) = self.course.news(&self.executor, now) {
            fx.publish(Out::Trajectory(Box::new(view)));
        }
    }

    /// Has the state be remembered, with the joints where they are now.
    fn record(&mut self, cause: Cause, at: Time, fx: &mut Fx) {
        self.state.posture = self.driver.measured().posture;
        self.recorded = at;
        fx.append(Record { cause, at, state: self.state.clone() });
    }
}
