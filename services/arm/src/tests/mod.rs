//! The arm in a simulated process on a robot that outlives it.

mod called_off;
mod fetch;
mod full_disk;
mod grasp;
mod hand_over;
mod kills;
mod one_arm;
mod orders;
mod perceived;
mod planning;
mod point;
mod publish;
mod put_back;
mod robot;
mod set_aside;
mod standing;
mod stop;
mod trajectory_view;

use crate::recover;
use crate::shell::ArmProgram;
use crate::state::Record;
use crate::{ArmNode, Config, In, Out, PlanRequest};
use arm_driver::{ArmDriver, Driver, Drivers};
use config::Settings;
use manipulation::{Joints, Limb};
use messages::WireCode;
use messages::{
    ActKind, ArmStatus, InteractionId, JointStates, MessageRef, MotionOrder, PickId, PickOutcome,
    PickPhase, RobotAct, StopId, TrajectoryView, WorldView,
};
use robot::Robot;
use scene::{ObjectId, Question};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::stop_socket::{Caller, RESUME_AFTER, StopOrder, StopState};
use service::{Effects, Event, Node, Span, Time};
use std::path::Path;
use std::sync::OnceLock;
use vocabulary::Rng;

const OBJECTS: u16 = 6;

/// No driver but the built-in one.
struct ModelAlone;

impl Drivers for ModelAlone {
    const LIST: &'static [&'static Driver] = &[];
}

/// Time that a plan takes, unless a test says otherwise.
const PLANNING: Span = Span::from_ms(5);

/// Returns the shipped configuration, with a profile and overrides.
pub(crate) fn shipped(profile: Option<&str>, over: &[(String, String)]) -> Config {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    let settings = Settings::load(folder, profile, over).unwrap();
    ArmProgram::<ModelAlone>::config(&Environment::nowhere(), &settings).unwrap()
}

/// Returns the shipped configuration with its six bowls, in real time.
fn config() -> Config {
    static SETTINGS: OnceLock<Config> = OnceLock::new();
    SETTINGS.get_or_init(|| shipped(None, &[])).clone()
}

#[test]
fn driver_of_another_program_is_an_error() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    let settings = Settings::load(folder, Some("baxter"), &[]).unwrap();
    let failure = ArmProgram::<ModelAlone>::config(&Environment::nowhere(), &settings).unwrap_err();
    let expected =
        "arm.driver: expected one of kinematic, found `baxter`; help: these are the drivers";
    assert!(failure.message.contains(expected), "{failure}");
}

fn markers() -> scene::Scene {
    shipped(None, &[("group.scene".to_owned(), "markers".to_owned())]).scene
}

/// Returns the same, `time_scale` times as fast.
fn config_at(time_scale: f64) -> Config {
    let mut config = config();
    config.arm.time_scale = time_scale;
    config
}

/// Returns the policy's order of a pick.
fn pick(interaction: u64, object: u16) -> RobotAct {
    RobotAct {
        act: interaction * 10,
        interaction,
        attempt: 1,
        kind: ActKind::Pick.code(),
        object: object.into(),
        ..RobotAct::default()
    }
}

/// Returns the policy's withdrawal of that order.
fn cancel(interaction: u64, object: u16) -> RobotAct {
    let act = interaction * 10 + 1;
    RobotAct { act, kind: ActKind::Cancel.code(), ..pick(interaction, object) }
}

/// Returns the policy's question that points at an object.
fn point(act: u64, object: u16) -> RobotAct {
    let question = Question::Point(ObjectId(object)).into();
    RobotAct { act, kind: ActKind::Ask.code(), question, ..RobotAct::default() }
}

/// The policy says something.
fn say(act: u64) -> RobotAct {
    RobotAct { act, kind: ActKind::Say.code(), ..RobotAct::default() }
}

/// Point of a pass at which the process is killed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Death {
    /// Before the sync: nothing is durable and nothing was seen.
    Unsynced,
    /// After the sync, before anything was seen.
    Unseen,
    /// After everything.
    Seen,
}

/// The process, its journal and what stands outside of it.
struct Machine {
    config: Config,
    robot: Robot,
    node: ArmNode,
    journal: Vec<Record>,
    now: Time,
    /// The policy's standing act, sent again every 250 ms.
    act: Option<RobotAct>,
    waiting: Vec<In<'static>>,
    /// Requested plans, with the times at which they are there.
    planning: Vec<(Time, PlanRequest)>,
    planning_time: Span,
    passes: u64,
    exited: bool,
    joints: Vec<JointStates>,
    statuses: Vec<ArmStatus>,
    worlds: Vec<WorldView>,
    trajectories: Vec<TrajectoryView>,
    stop_states: Vec<StopState>,
    /// Records and outputs that wait for a disk that is slow or full, from its first pass on.
    waiting_for_disk: Option<(Vec<Record>, Vec<Out>)>,
}

impl Machine {
    fn new(config: Config) -> Self {
        let first = recover::state(&config, Vec::new()).unwrap();
        let robot = Robot::at(&first, &config);
        let node = ArmNode::with_driver(config.clone(), first, Box::new(robot.clone()));
        let mut machine = Self {
            config,
            robot,
            node,
            journal: Vec::new(),
            now: Time(1_000_000_000),
            act: None,
            waiting: Vec::new(),
            planning: Vec::new(),
            planning_time: PLANNING,
            passes: 0,
            exited: false,
            joints: Vec::new(),
            statuses: Vec::new(),
            worlds: Vec::new(),
            trajectories: Vec::new(),
            stop_states: Vec::new(),
            waiting_for_disk: None,
        };
        machine.pass(vec![Event::Started], None);
        machine
    }

    /// The process starts again, on the robot as it stands now.
    fn restart(&mut self) {
        self.waiting_for_disk = None;
        self.planning.clear();
        self.robot.stand_still();
        let state = recover::state(&self.config, self.journal.clone()).unwrap();
        let driver = Box::new(self.robot.clone());
        self.node = ArmNode::with_driver(self.config.clone(), state, driver);
        self.exited = false;
        self.pass(vec![Event::Started], None);
    }

    /// The process starts again, on the model of a robot that the journal describes.
    fn restart_from_journal(&mut self) {
        let state = recover::state(&self.config, self.journal.clone()).unwrap();
        self.robot = Robot::at(&state, &self.config);
        self.restart();
    }

    /// From here on nothing becomes durable, until the disk is back.
    fn disk_fails(&mut self) {
        self.waiting_for_disk.get_or_insert_default();
    }

    /// What has waited becomes durable, and then visible.
    fn disk_is_back(&mut self) {
        let Some((records, outputs)) = self.waiting_for_disk.take() else { return };
        self.becomes_durable(records);
        self.publish(outputs);
    }

    fn becomes_durable(&mut self, records: Vec<Record>) {
        self.journal.extend(records);
        self.robot.set_durable(self.journal.last().and_then(|record| record.state.pick));
        self.node.on_durable();
    }

    /// One pass of the main loop, in the order of the runtime.
    fn pass(&mut self, events: Vec<Event<In<'static>>>, death: Option<Death>) {
        let mut effects = Effects::default();
        for event in events {
            self.node.on(event, self.now, &mut effects);
        }
        if self.node.deadline().is_some_and(|deadline| deadline <= self.now) {
            self.node.on(Event::Tick, self.now, &mut effects);
        }
        self.exited |= effects.exits();
        self.publish(effects.take_urgent());
        if death == Some(Death::Unsynced) {
            return;
        }
        let (records, outputs) = (effects.take_records(), effects.take_outputs());
        if let Some((all_records, all_outputs)) = &mut self.waiting_for_disk {
            all_records.extend(records);
            all_outputs.extend(outputs);
            return;
        }
        self.becomes_durable(records);
        if death != Some(Death::Unseen) {
            self.publish(outputs);
        }
    }

    fn publish(&mut self, outputs: Vec<Out>) {
        for output in outputs {
            match output {
                Out::Status(status) => self.statuses.push(status),
                Out::Joints(joints) => self.joints.push(*joints),
                Out::World(world) => self.worlds.push(*world),
                Out::Trajectory(view) => self.trajectories.push(*view),
                Out::StopState(_, state) => self.stop_states.push(state),
                Out::Plan(request) => {
                    self.planning.push((self.now + self.planning_time, *request));
                }
                Out::Robot(order) => panic!("a model gets no orders: {order:?}"),
            }
        }
    }

    /// The loop wakes at its deadline, or after 10 ms, with what has arrived until then.
    fn go(&mut self, death: Option<Death>) {
        let deadline = self.node.deadline().unwrap_or(Time(u64::MAX));
        self.now = deadline.clamp(self.now + Span(300_000), self.now + Span::from_ms(10));
        self.passes += 1;
        if self.passes.is_multiple_of(25) {
            self.waiting.extend(self.act.iter().map(|act| In::Act(MessageRef::from(*act))));
        }
        let now = self.now;
        let planned = self.planning.extract_if(.., |(ready, _)| *ready <= now);
        self.waiting.extend(planned.map(|(_, request)| In::Planned(Box::new(request.solve()))));
        let events = self.waiting.drain(..).map(Event::Message).collect();
        self.pass(events, death);
    }

    fn run(&mut self, seconds: f64) {
        let until = self.now + Span::from_s(seconds);
        while self.now < until {
            self.go(None);
        }
    }

    fn run_until(&mut self, what: &str, mut holds: impl FnMut(&Self) -> bool) {
        let until = self.now + Span::from_s(120.0);
        while !holds(self) {
            assert!(self.now < until, "never: {what}; {:?}", self.node.state());
            self.go(None);
        }
    }

    /// Returns a machine whose first order, that object, is in that phase.
    fn picking(config: Config, object: u16, phase: PickPhase) -> Self {
        let mut machine = Self::new(config);
        machine.act(pick(1, object));
        machine.reaches(phase);
        machine
    }

    fn reaches(&mut self, phase: PickPhase) {
        self.run_until("in the phase", |m| m.phase() == phase);
    }

    /// Runs until the pick is carried out, once and as it should be.
    fn delivers(&mut self, interaction: u64, object: u16) {
        self.run_until("delivered", |m| {
            m.outcome() == PickOutcome::Delivered
                && m.node.state().pick.is_some_and(|pick| pick.id.interaction.0 == interaction)
        });
        self.assert_delivered(interaction, object);
    }

    /// The policy decides; about the arm's own scene, where `act` names none.
    fn act(&mut self, act: RobotAct) {
        let own = self.config.scene.key();
        let scene_key = if act.scene_key == 0 { own } else { act.scene_key };
        let act = RobotAct { scene_key, ..act };
        self.act = Some(act);
        self.waiting.push(In::Act(MessageRef::from(act)));
    }

    fn motion(&mut self, order: MotionOrder) {
        if order == MotionOrder::Resume {
            self.awaits_release();
        }
        self.order(order, self.now.ns());
    }

    /// Runs until a release counts.
    fn awaits_release(&mut self) {
        self.go(None);
        let (stopped, obeyed) = (self.node.state().stopped, self.node.state().obeyed);
        while stopped && obeyed > Time(0) && self.now < obeyed + RESUME_AFTER {
            self.go(None);
        }
    }

    /// Receives an order that was given at that time.
    fn order(&mut self, order: MotionOrder, given_ns: u64) {
        self.receive(StopOrder::new(order, Time(given_ns)));
    }

    fn receive(&mut self, order: StopOrder) {
        self.waiting.push(In::StopOrder(order, Caller::named(b"a client")));
    }

    fn phase(&self) -> PickPhase {
        self.node.state().pick.map_or(PickPhase::Idle, |pick| pick.phase)
    }

    fn outcome(&self) -> PickOutcome {
        self.node.state().pick.map_or(PickOutcome::Pending, |pick| pick.outcome)
    }

    fn rests(&self) -> bool {
        let (measured, robot) = (self.robot.measured(), &self.config.setup.robot);
        robot.limbs().iter().all(|limb| measured.is_at_rest(robot, *limb))
    }

    fn tip(&self, limb: Limb) -> nalgebra::Isometry3<f64> {
        self.config.setup.robot.arm(limb).chain.forward(&self.joints_of(limb))
    }

    fn joints_of(&self, limb: Limb) -> Joints {
        self.robot.posture().joints[limb]
    }

    fn status(&self) -> ArmStatus {
        *self.statuses.last().unwrap()
    }

    /// Returns the number of times that a pick entered a phase, by the journal.
    fn entered(&self, id: PickId, phase: PickPhase) -> usize {
        let mut last = PickPhase::Idle;
        let mut count = 0;
        for pick in self.journal.iter().filter_map(|record| record.state.pick) {
            let is = if pick.id == id { pick.phase } else { PickPhase::Idle };
            count += usize::from(is == phase && last != phase);
            last = is;
        }
        count
    }

    /// The pick of that interaction was carried out, once, and nothing was done that must not be.
    fn assert_delivered(&self, interaction: u64, object: u16) {
        let id = PickId { interaction: InteractionId(interaction), attempt: 1 };
        assert_eq!(self.entered(id, PickPhase::Holding), 1, "one grasp that holds");
        assert_eq!(self.entered(id, PickPhase::Done), 1, "one end");
        let mut ends = self.journal.iter().filter_map(|r| r.state.pick).filter(|p| p.id == id);
        let last = ends.next_back().unwrap();
        assert_eq!((last.object, last.outcome), (ObjectId(object), PickOutcome::Delivered));
        self.robot.assert_well_behaved();
    }
}
