//! The arm service: fetches the ordered object exactly once, or puts it back, points at objects, and
//! stops on request.
//!
//! [`ArmNode`] is the reducer. Invariant: a motion that belongs to a phase of a pick is commanded
//! only once that phase is durable, and the next action depends on durable facts and
//! sensors alone, so the arm can be killed at any instant and resumes from there: a phase is recorded
//! in one tick, and its motion begins in a tick after [`Node::on_durable`]. A motion that has begun
//! and a halt wait for no disk. Motions are planned elsewhere ([`PlanRequest`]), so nothing waits for a
//! plan but the motion itself.

mod checkpoint;
mod executor;
mod goal;
mod inspection;
mod journal_record;
mod kinematic;
mod motion;
mod motion_inhibit;
mod orders;
mod perceived;
mod plan;
mod program;
mod publish;
pub mod recover;
pub mod shell;
pub mod state;
mod trajectory_view;
mod world;

#[cfg(test)]
mod tests;

pub use kinematic::KinematicArm;
pub use plan::{PlanRequest, Planned};

use arm_driver::{ArmDriver, Configured, Drivers, Start};
use executor::Executor;
use goal::PlanFailures;
use messages::pick::Pick;
use messages::robot::{Order, Report};
use messages::{
    ArmStatus, JointStates, MessageRef, MotionInhibit, PickOutcome, PickPhase, RobotAct, TableView,
    TrajectoryView, WorldView,
};
use orders::StandingAct;
use plan::Planning;
use preflight::ArmSetup;
use publish::{Activity, Facts, Publisher};
use scene::{ObjectId, Scene};
use serde::{Deserialize, Serialize};
use service::stop_socket::{Caller, StopOrder, StopState};
use service::{Effects, Event, Node, NodeError, SetAside, Span, Time};
use state::{ArmState, Cause, Record};
use std::process::ExitCode;
use std::sync::Arc;
use trajectory_view::MotionView;
use world::World;

/// Runs the program with these drivers: a service of a group, or an inspection of its records.
pub fn run<D: Drivers>() -> ExitCode {
    service::service_loop::run::<shell::ArmProgram<D>>()
}

/// Inputs of the arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In<'a> {
    /// Act of the policy.
    Act(MessageRef<'a, RobotAct>),
    /// Stop or release, from a client that is answered.
    StopOrder(StopOrder, Caller),
    /// Report of a real robot.
    Robot(Report<'a>),
    /// Result of a [`PlanRequest`].
    Planned(Box<Planned>),
    /// The objects on the table, where they come from perception.
    Table(Box<TableView>),
}

/// Outputs of the arm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Out {
    /// Progress of a pick and the object aimed at, to policy and speech.
    Status(ArmStatus),
    /// Joint states, to clients.
    Joints(Box<JointStates>),
    /// Poses of the objects, to clients.
    World(Box<WorldView>),
    /// Planned path of the gripper, to clients.
    Trajectory(Box<TrajectoryView>),
    /// Command to a real robot.
    Robot(Order<'static>),
    /// A motion to be planned; its result is awaited as [`In::Planned`].
    Plan(Box<PlanRequest>),
    /// Answer to an order to the motion stop.
    StopState(Caller, StopState),
}

type Fx = Effects<Out, Record>;

/// Configuration of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Time scale, grasps, and the simulated world.
    pub arm: config::Arm,
    /// The driver.
    pub driver: Configured,
    /// Robot, limb and settings of motions.
    pub setup: ArmSetup,
    /// Objects and their places.
    pub scene: Scene,
    /// Whether objects and places come from perception; the scene's are then what they may be.
    pub perceives: bool,
}

impl Config {
    /// Starts the driver of an arm in this state.
    fn open(&self, state: &ArmState) -> Box<dyn ArmDriver> {
        self.driver.open(&self.start(state))
    }

    /// What a driver knows of an arm in this state.
    fn start(&self, state: &ArmState) -> Start<'_> {
        let ArmSetup { robot, limb, .. } = &self.setup;
        let holding = state.held.map(|held| held.limb);
        Start { robot, limb: *limb, posture: state.posture, holding }
    }
}

/// The arm as a reducer.
pub struct ArmNode {
    config: Arc<Config>,
    world: Arc<World>,
    /// The world of the running plan.
    planned_world: Arc<World>,
    /// Since when the ordered object is not on the table that the arm knows.
    unknown_since: Option<Time>,
    state: ArmState,
    driver: Box<dyn ArmDriver>,
    executor: Executor,
    publisher: Publisher,
    motion_view: MotionView,
    act: StandingAct,
    /// Object that the gripper aims at, standing still.
    aimed: Option<ObjectId>,
    planning: Planning,
    plan_failures: PlanFailures,
    /// Time of the last motion step.
    stepped: Time,
    recorded: Time,
    /// Requests another pass at once.
    urgent: bool,
    scene_changed: bool,
    /// Reason why the robot could not move in the previous pass.
    inhibit: MotionInhibit,
    ending: bool,
    /// True if a record is not durable yet.
    unsynced: bool,
    /// True if one of them begins or ends a phase: no step begins before it is durable.
    phase_unsynced: bool,
    /// Clients that wait for the state of the motion stop, with their orders' times.
    callers: Vec<(Caller, u64)>,
}

/// Longest time between two steps of a motion.
const STEP_EVERY: Span = Span::from_ms(10);

impl Node for ArmNode {
    type Config = Config;
    type In<'a> = In<'a>;
    type Out = Out;
    type Record = Record;

    fn recover(config: Config, records: Vec<Record>) -> Result<Self, NodeError> {
        let state = recover::state(&config, records)?;
        let driver = config.open(&state);
        Ok(Self::with_driver(config, state, driver))
    }

    fn on(&mut self, event: Event<In<'_>>, now: Time, fx: &mut Fx) {
        match event {
            Event::SetAside(set_aside) => self.set_aside(set_aside, now, fx),
            Event::Started => self.begin(now, fx),
            Event::Message(In::StopOrder(order, caller)) => {
                self.on_stop_order(&order, now, fx);
                self.callers.push((caller, order.given_ns));
                self.urgent = true;
            }
            Event::Message(In::Act(act)) => self.on_act(&act, now, fx),
            Event::Message(In::Robot(report)) => self.driver.on_report(&report, now),
            Event::Message(In::Planned(planned)) => {
                self.urgent |= self.planning.on_planned(*planned, &self.config);
            }
            Event::Message(In::Table(table)) => self.lay(&table),
            Event::Tick => self.tick(now, fx),
            Event::Shutdown => {
                self.ending = true;
                self.executor.halt();
                self.urgent = true;
            }
        }
    }

    fn on_durable(&mut self) {
        // What waited for the records happens in the next tick.
        self.urgent |= self.unsynced;
        (self.unsynced, self.phase_unsynced) = (false, false);
    }

    fn deadline(&self) -> Option<Time> {
        let due = self.publisher.deadline(self.activity(), self.unsynced);
        if self.urgent || self.driver.is_fresh() {
            return Some(Time(0));
        }
        let moving = (!self.executor.is_standing()).then_some(STEP_EVERY);
        let beat = self.driver.beat().or(moving);
        Some(beat.map_or(due, |beat| due.min(self.stepped + beat)))
    }

    fn pending_since(&self) -> Option<Time> {
        self.planning.requested()
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        self.whole_state()
    }

    fn resume(config: Config, checkpoint: &[u8]) -> Result<Self, NodeError> {
        Self::with_whole_state(config, checkpoint)
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
    /// Returns the arm in `state` with another driver than the configured one.
    pub fn with_driver(config: Config, state: ArmState, driver: Box<dyn ArmDriver>) -> Self {
        let settled = recover::other_scene(&state, &config.scene);
        let scene_changed = settled.is_some();
        let world = Arc::new(match config.perceives {
            true => World::unknown(&config.setup.robot),
            false => World::new(&config.setup.robot, &config.scene),
        });
        Self {
            planned_world: Arc::clone(&world),
            unknown_since: None,
            world,
            publisher: Publisher::new(&config.arm, &config.setup.robot),
            motion_view: MotionView::default(),
            state: settled.unwrap_or(state),
            driver,
            executor: Executor::default(),
            act: StandingAct::default(),
            aimed: None,
            planning: Planning::default(),
            plan_failures: PlanFailures::default(),
            stepped: Time(0),
            recorded: Time(0),
            urgent: false,
            scene_changed,
            inhibit: MotionInhibit::None,
            ending: false,
            unsynced: false,
            phase_unsynced: false,
            callers: Vec::new(),
            config: Arc::new(config),
        }
    }

    /// Returns the state, for tests and simulation.
    pub fn state(&self) -> &ArmState {
        &self.state
    }

    fn begin(&mut self, now: Time, fx: &mut Fx) {
        (self.stepped, self.recorded, self.urgent) = (now, now, true);
        // The monotonic clock restarts with the machine; an order of the previous boot must not
        // outrank those of this boot.
        if self.state.obeyed > now {
            self.state.obeyed = Time(0);
        }
        if self.scene_changed {
            tracing::warn!("the scene has changed: its objects stand in their places");
            self.record(Cause::SceneChanged, now, fx);
        }
        if let Some(pick) = self.state.open_pick() {
            tracing::info!(pick = ?pick.id, phase = ?pick.phase, "resuming an open pick");
        }
        self.publish(now, fx);
    }

    /// Handles a journal that was set aside: an object that is not grasped yet is left, and an arm
    /// without its own memory, which may hold one or have been stopped, waits for a person.
    fn set_aside(&mut self, SetAside { over, is_own }: SetAside, now: Time, fx: &mut Fx) {
        if is_own {
            tracing::warn!("the arm's journal is new: look, then `whichone resume-motion`");
            self.latch_stop(now, fx);
        }
        let is_over = |pick: &&Pick| pick.id.interaction.0 <= over;
        let phase = self.state.open_pick().filter(is_over).map(|pick| pick.phase);
        if matches!(phase, Some(PickPhase::Accepted | PickPhase::Moving)) {
            self.end(PickOutcome::Cancelled, now, fx);
        }
    }

    fn tick(&mut self, now: Time, fx: &mut Fx) {
        self.urgent = false;
        let seconds = self.passed_s(now);
        self.read_sensors(now, fx);
        self.watch_target(now, fx);
        self.decide(now, fx);
        self.step(seconds, now, fx);
        self.record_progress(now, fx);
        if self.ending && self.executor.is_standing() {
            self.record(Cause::Shutdown, now, fx);
            self.publisher.hurry_joints();
            fx.exit();
        }
        // Set-points depend on durable records alone, so they wait for none.
        self.driver
            .end_pass(now)
            .into_iter()
            .for_each(|order| fx.publish_urgent(Out::Robot(order)));
        self.answer_callers(fx);
        self.publish(now, fx);
    }

    /// Returns whether no motion is commanded and joints and fingers are measured to stand still.
    fn is_at_rest(&self) -> bool {
        self.executor.is_standing() && self.driver.is_still()
    }

    fn answer_callers(&mut self, fx: &mut Fx) {
        for (caller, given_ns) in std::mem::take(&mut self.callers) {
            let state = StopState {
                given_ns,
                in_force_ns: self.state.obeyed.ns(),
                stopped: self.state.stopped,
                at_rest: self.is_at_rest(),
                durable: !self.unsynced,
                inhibit: self.driver.inhibit(),
                stop: self.state.stop(),
            };
            fx.publish_urgent(Out::StopState(caller, state));
        }
    }

    fn activity(&self) -> Activity {
        let is_busy = !self.executor.is_standing()
            || self.state.open_pick().is_some()
            || self.planning.requested().is_some();
        if is_busy { Activity::Busy } else { Activity::AtRest }
    }

    fn publish(&mut self, now: Time, fx: &mut Fx) {
        let measured = self.driver.measured();
        let aims = self.aimed.is_some() && self.aimed == self.act.aim;
        let facts = Facts {
            state: &self.state,
            measured: &measured,
            executor: &self.executor,
            is_at_rest: self.is_at_rest(),
            world: &self.world,
            aimed: aims.then_some(self.act.id),
            inhibit: self.driver.inhibit(),
        };
        self.publisher.publish_joints(facts.measured, self.activity(), now, fx);
        // What tells of a record waits until it is durable.
        if self.unsynced {
            return;
        }
        self.publisher.tick(&facts, now, fx);
        if let Some(view) = self.motion_view.update(&self.executor, now) {
            fx.publish(Out::Trajectory(Box::new(view)));
        }
    }

    /// Appends the state to the journal, with the present joint positions.
    fn record(&mut self, cause: Cause, at: Time, fx: &mut Fx) {
        self.state.posture = self.driver.measured().posture;
        (self.recorded, self.unsynced) = (at, true);
        self.phase_unsynced |= cause.is_of_phase();
        let record = Record { cause, at, state: self.state.clone() };
        match cause {
            Cause::Motion(_) => fx.append_vital(record),
            _ => fx.append(record),
        }
    }
}
