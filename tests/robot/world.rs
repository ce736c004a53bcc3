//! The arm and the simulated Baxter, each in a simulated process, and the messages between them.

use arm::state::ArmState;
use arm::{ArmNode, In, Out};
use baxter::BaxterNode;
use baxter::robot::Robot;
use config::Settings;
use messages::WireCode;
use messages::robot::{Drill, DrillKind, JointState, Order, Report};
use messages::{
    ActKind, ArmStatus, MessageRef, MotionInhibit, MotionOrder, PickOutcome, PickPhase, RobotAct,
    Sighting, TableView,
};
use service::stop_socket::{Caller, RESUME_AFTER, StopOrder};
use service::{Span, Time};
use std::path::Path;
use whichone_tests::simulated_group::{Faults, Host};

/// Time step: shorter than any deadline.
const LOOK_EVERY: Span = Span::from_ms(2);

pub(crate) struct World {
    settings: Settings,
    pub(crate) now: Time,
    arm: Host<ArmNode>,
    robot: Host<BaxterNode>,
    to_arm: Vec<In<'static>>,
    act: Option<RobotAct>,
    drills: u64,
    pub(crate) statuses: Vec<ArmStatus>,
    pub(crate) joint_states: Vec<JointState>,
    /// When each limb was commanded its joints, left first.
    pub(crate) commanded: [Vec<Time>; 2],
    pub(crate) orders: Vec<(Time, Order<'static>)>,
    /// Number of grasps that held.
    pub(crate) grasps: u32,
    /// The camera's reports.
    pub(crate) sightings: Vec<Sighting>,
}

impl World {
    pub(crate) fn new(over: &[(&str, &str)]) -> Self {
        let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config"));
        let over: Vec<_> = over.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        let settings = Settings::load(config, Some("baxter"), &over).unwrap();
        let mut world = Self {
            arm: Host::new::<arm::shell::ArmProgram<drivers::Shipped>>(&settings),
            robot: Host::new::<baxter::shell::BaxterProgram>(&settings),
            settings,
            now: Time(1_000_000_000),
            to_arm: Vec::new(),
            act: None,
            drills: 0,
            statuses: Vec::new(),
            joint_states: Vec::new(),
            commanded: [Vec::new(), Vec::new()],
            orders: Vec::new(),
            grasps: 0,
            sightings: Vec::new(),
        };
        world.start_robot();
        world.start_arm();
        world
    }

    pub(crate) fn start_arm(&mut self) {
        let outputs = self.arm.start(self.now, &mut Faults::none());
        self.route_arm(outputs);
    }

    pub(crate) fn kill_arm(&mut self) {
        self.arm.kill();
        self.to_arm.clear();
    }

    pub(crate) fn start_robot(&mut self) {
        let outputs = self.robot.start(self.now, &mut Faults::none());
        self.route_robot(outputs);
    }

    pub(crate) fn kill_robot(&mut self) {
        self.robot.kill();
    }

    pub(crate) fn go(&mut self) {
        self.now = self.now + LOOK_EVERY;
        self.pass_robot(Vec::new());
        let again = self.now.ns() % 250_000_000 < LOOK_EVERY.0;
        self.to_arm.extend(self.act.filter(|_| again).map(|act| In::Act(MessageRef::from(act))));
        let inbox = std::mem::take(&mut self.to_arm);
        let outputs = self.arm.wake(inbox, self.now, &mut Faults::none());
        self.route_arm(outputs);
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        let until = self.now + Span::from_s(seconds);
        while self.now < until {
            self.go();
        }
    }

    pub(crate) fn run_until(&mut self, what: &str, mut holds: impl FnMut(&Self) -> bool) {
        let until = self.now + Span::from_s(90.0);
        while !holds(self) {
            let status = self.statuses.last();
            assert!(self.now < until, "never: {what}; {:?} {status:?}", self.arm_state());
            self.go();
        }
    }

    /// The policy orders a pick.
    pub(crate) fn pick(&mut self, interaction: u64, object: u16) {
        let act = RobotAct {
            act: interaction * 10,
            interaction,
            attempt: 1,
            kind: ActKind::Pick.code(),
            object: object.into(),
            scene_key: self.settings.scene.key(),
            ..RobotAct::default()
        };
        self.act = Some(act);
        self.to_arm.push(In::Act(MessageRef::from(act)));
    }

    pub(crate) fn motion(&mut self, order: MotionOrder) {
        if order == MotionOrder::Resume {
            self.run(RESUME_AFTER.s());
        }
        let order = StopOrder::new(order, self.now);
        self.to_arm.push(In::StopOrder(order, Caller::named(b"a client")));
    }

    /// Injects a fault into the robot.
    pub(crate) fn drill(&mut self, kind: DrillKind, amount: f64) {
        self.inject(Drill { amount, kind: kind.code(), ..Drill::default() });
    }

    /// A person puts an object at a place, or takes it.
    pub(crate) fn by_hand(&mut self, kind: DrillKind, object: u16, place: [f64; 4]) {
        let scene_key = self.settings.scene.key();
        self.inject(Drill { scene_key, object, place, kind: kind.code(), ..Drill::default() });
    }

    fn inject(&mut self, drill: Drill) {
        self.drills += 1;
        self.pass_robot(vec![baxter::In::Drill(Drill { key: self.drills, ..drill })]);
    }

    /// The arm is given the objects on the table.
    pub(crate) fn table(&mut self, table: TableView) {
        self.to_arm.push(In::Table(Box::new(table)));
    }

    /// The scene file.
    pub(crate) fn scene(&self) -> &scene::Scene {
        &self.settings.scene
    }

    pub(crate) fn arm_state(&self) -> Option<&ArmState> {
        self.arm.node().map(ArmNode::state)
    }

    pub(crate) fn phase(&self) -> PickPhase {
        let pick = self.arm_state().and_then(|state| state.pick);
        pick.map_or(PickPhase::Idle, |pick| pick.phase)
    }

    pub(crate) fn outcome(&self) -> PickOutcome {
        let pick = self.arm_state().and_then(|state| state.pick);
        pick.map_or(PickOutcome::Pending, |pick| pick.outcome)
    }

    pub(crate) fn status(&self) -> ArmStatus {
        *self.statuses.last().unwrap()
    }

    pub(crate) fn hindrance(&self) -> MotionInhibit {
        self.status().hindrance.get()
    }

    /// The pick's object was brought, after one grasp that held.
    pub(crate) fn assert_delivered_once(&self) {
        assert_eq!(self.outcome(), PickOutcome::Delivered);
        assert_eq!(self.grasps, 1, "one grasp that holds");
        let picks = self.arm.journal().iter().filter_map(|record| record.state.pick);
        let phases: Vec<PickPhase> = picks.map(|pick| pick.phase).collect();
        assert!(phases.is_sorted(), "a phase was taken back");
    }

    fn route_arm(&mut self, outputs: Vec<Out>) {
        let mut commands = Vec::new();
        for output in outputs {
            match output {
                Out::Status(status) => self.statuses.push(status),
                Out::Robot(order) => {
                    if let Order::Joints(limb, _) = &order {
                        self.commanded[*limb].push(self.now);
                    }
                    self.orders.push((self.now, order.clone()));
                    commands.push(baxter::In::Order(order));
                }
                Out::Plan(request) => {
                    self.to_arm.push(In::Planned(Box::new(request.solve())));
                }
                Out::Joints(_) | Out::World(_) | Out::Trajectory(_) | Out::StopState(..) => {}
            }
        }
        self.pass_robot(commands);
    }

    fn pass_robot(&mut self, inbox: Vec<baxter::In<'static>>) {
        use manipulation::Limb;
        let limbs = [Limb::Left, Limb::Right, Limb::Only];
        let held = |robot: &Robot| limbs.map(|limb| robot.objects().held(limb).is_some());
        let before = self.robot.node().map(|node| held(node.robot()));
        let outputs = self.robot.wake(inbox, self.now, &mut Faults::none());
        let after = self.robot.node().map(|node| held(node.robot()));
        let limbs = after.into_iter().flatten().zip(before.into_iter().flatten());
        self.grasps += limbs.filter(|(after, before)| *after && !before).count() as u32;
        self.route_robot(outputs);
    }

    fn route_robot(&mut self, outputs: Vec<baxter::Out>) {
        for output in outputs {
            let output = match output {
                baxter::Out::Report(report) => report,
                baxter::Out::Sighting(sighting) => {
                    self.sightings.push(*sighting);
                    continue;
                }
            };
            if let Report::Joints(state) = &output
                && state.len > 1
            {
                self.joint_states.push(**state);
            }
            if self.arm.is_up() {
                self.to_arm.push(In::Robot(output));
            }
        }
    }
}
