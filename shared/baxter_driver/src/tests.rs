//! The driver alone: what it makes of what it hears, and what it then says.

use std::path::Path;

use arm_driver::{ArmDriver, Command, Fault, Fingers, Grip, Posture, Source, Start};
use config::Settings;
use manipulation::{Joints, Limb, Robot};
use messages::MotionInhibit;
use messages::robot::{
    AssemblyState, Command as Word, EndEffectorCommand, EndEffectorProperties, EndEffectorState,
    JointState, Order, Report, Tristate, UiType,
};
use service::{Span, Time};

use crate::BaxterDriver;

fn ready_gripper(now: Time) -> EndEffectorState {
    let yes = Tristate::True.code();
    let (enabled, calibrated, ready) = (yes, yes, yes);
    EndEffectorState { timestamp_ns: now.ns(), enabled, calibrated, ready, ..Default::default() }
}

/// A driver with a scripted robot.
struct Bench {
    driver: BaxterDriver,
    now: Time,
    joints: [Joints; 2],
    assembly: AssemblyState,
    grippers: [EndEffectorState; 2],
}

impl Bench {
    fn new() -> Self {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
        let settings = Settings::load(folder, Some("baxter"), &[]).unwrap().part().unwrap();
        let robot = Robot::baxter();
        let now = Time(5_000_000_000);
        let joints = Limb::BOTH.map(|limb| robot.arm(limb).neutral);
        let width_m = Limb::BOTH.map(|limb| robot.arm(limb).gripper.width_m(100.0));
        let posture = Posture { joints, width_m };
        let driver =
            BaxterDriver::new(settings, &Start { robot, limb: None, posture, holding: None });
        let assembly = AssemblyState { enabled: 1, ready: 1, ..AssemblyState::default() };
        Self { driver, now, joints, assembly, grippers: [ready_gripper(now); 2] }
    }

    /// Returns the robot's joints, last joint first, with the head's among them.
    fn joint_state(&self) -> JointState {
        let mut joints = vec![("head_pan", [0.3; 3])];
        for limb in Limb::BOTH {
            let names = Robot::baxter().arm(limb).joint_names.iter();
            let q = self.joints[limb];
            joints.extend(names.zip(q).map(|(name, q)| (name.as_str(), [q, 0.0, 0.0])));
        }
        joints.reverse();
        JointState::new(self.now.ns(), &joints).unwrap()
    }

    fn report_all(&mut self) {
        self.driver.on_report(&Report::Assembly(self.assembly), self.now);
        for limb in Limb::BOTH {
            let state = Box::new(self.grippers[limb]);
            self.driver.on_report(&Report::Gripper(limb.index(), state.into()), self.now);
        }
        self.driver.on_report(&Report::Joints(self.joint_state().into()), self.now);
    }

    /// A pass 10 ms after the one before, in which the robot is heard.
    fn pass(&mut self, command: Option<Command>) -> Vec<Order<'static>> {
        self.now = self.now + Span::from_ms(10);
        self.report_all();
        self.deaf_pass(command)
    }

    fn deaf_pass(&mut self, command: Option<Command>) -> Vec<Order<'static>> {
        self.driver.begin_pass(self.now, [true; 2]);
        command.into_iter().for_each(|command| self.driver.command(&command, 0.01));
        self.driver.end_pass(self.now)
    }

    fn moving(&self, by_rad: f64, fingers: Fingers) -> Command {
        let mut q = self.joints[0];
        q[3] += by_rad;
        let (qd, qdd) = ([0.1; 7], [0.2; 7]);
        Command { limb: Limb::Left, q, qd, qdd, t_s: 0.5, fingers }
    }
}

fn commanded(orders: &[Order], limb: Limb) -> Option<Vec<f64>> {
    orders.iter().find_map(|order| match order {
        Order::Joints(own, command) if *own == limb.index() => {
            Some(command.joints().unwrap().into_iter().map(|(_, q)| q).collect())
        }
        _ => None,
    })
}

fn word(orders: &[Order]) -> Option<EndEffectorCommand> {
    orders.iter().find_map(|order| match order {
        Order::Gripper(0, message) => Some(**message),
        _ => None,
    })
}

#[test]
fn joints_are_found_by_name_and_fingers_disturb_nothing() {
    let mut bench = Bench::new();
    bench.joints[0][2] = 0.7;
    bench.joints[1][6] = -0.4;
    bench.pass(None);
    assert_eq!(bench.driver.measured().posture.joints, bench.joints);
    let at = bench.driver.measured().at;
    assert_eq!(at, Source::Sensors(bench.now));
    let later = bench.now.ns() + 5_000_000;
    let finger = JointState::new(later, &[("l_gripper_l_finger_joint", [0.01; 3])]).unwrap();
    bench.driver.on_report(&Report::Joints(finger.into()), Time(later));
    assert_eq!(
        (bench.driver.measured().at, bench.driver.measured().posture.joints),
        (at, bench.joints)
    );
}

#[test]
fn stationary_limb_is_held_and_displaced_limb_keeps_its_position() {
    let mut bench = Bench::new();
    let held = bench.joints[0].to_vec();
    assert_eq!(commanded(&bench.pass(None), Limb::Left), Some(held.clone()));
    bench.joints[0][0] += 0.006;
    assert_eq!(commanded(&bench.pass(None), Limb::Left), Some(held), "noise moves nothing");
    bench.joints[0][0] += 0.5;
    let there = bench.joints[0].to_vec();
    assert_eq!(commanded(&bench.pass(None), Limb::Left), Some(there));
}

#[test]
fn baxter_driver_sends_no_commands_while_inhibited() {
    let off = AssemblyState { enabled: 0, ..AssemblyState::default() };
    for (assembly, inhibit) in [
        (off, MotionInhibit::Disabled),
        (AssemblyState { error: 1, ..off }, MotionInhibit::Error),
        (AssemblyState { error: 1, stopped: 1, ..off }, MotionInhibit::Stopped),
    ] {
        let mut bench = Bench::new();
        bench.pass(None);
        let command = bench.moving(0.05, Fingers::Open(0.02));
        assert!(commanded(&bench.pass(Some(command)), Limb::Left).is_some());
        bench.assembly = assembly;
        assert_eq!(bench.pass(Some(command)), []);
        assert_eq!(bench.driver.inhibit(), inhibit);
        bench.assembly = AssemblyState { enabled: 1, ..AssemblyState::default() };
        let here = bench.joints[0].to_vec();
        assert_eq!(commanded(&bench.pass(None), Limb::Left), Some(here), "held where it is");
    }
}

#[test]
fn silence_is_noticed_after_its_time_and_stamps_of_another_clock_do_not_hide_it() {
    let mut bench = Bench::new();
    assert_eq!(bench.driver.inhibit(), MotionInhibit::Unheard);
    let mut future = bench.joint_state();
    future.stamp_ns = u64::MAX;
    bench.pass(None);
    bench.driver.on_report(&Report::Joints(future.into()), bench.now);
    let heard = bench.now;
    for (after_ms, inhibit) in [(140, MotionInhibit::None), (160, MotionInhibit::Stale)] {
        bench.now = heard + Span::from_ms(after_ms);
        bench.deaf_pass(None);
        assert_eq!(bench.driver.inhibit(), inhibit);
    }
}

#[test]
fn baxter_driver_ignores_an_invalid_joint_state() {
    let mut bench = Bench::new();
    bench.pass(None);
    bench.joints[0][0] = f64::NAN;
    let state = bench.joint_state();
    bench.driver.on_report(&Report::Joints(state.into()), bench.now);
    assert!(bench.driver.measured().posture.joints[0][0].is_finite());
}

#[test]
fn joints_a_hair_beyond_their_limits_stand_on_them() {
    let mut bench = Bench::new();
    let limits = Robot::baxter().arm(Limb::Left).limits.position;
    bench.joints[0] = limits.at(&[1.0; 7]);
    bench.joints[0][0] += 0.002;
    bench.pass(None);
    assert!(limits.within(&bench.driver.measured().posture.joints[0]));
}

#[test]
fn baxter_driver_reports_a_joint_off_its_path() {
    let mut bench = Bench::new();
    bench.pass(None);
    bench.pass(Some(bench.moving(0.1, Fingers::Stay)));
    bench.pass(Some(bench.moving(0.3, Fingers::Stay)));
    bench.driver.begin_pass(bench.now, [true; 2]);
    let fault = bench.driver.fault().unwrap();
    assert!(matches!(&fault, Fault::Path { joint, .. } if joint == "left_e1"), "{fault}");
    bench.driver.hold_here();
    bench.pass(None);
    assert_eq!(bench.driver.fault(), None);
}

#[test]
fn velocities_and_accelerations_are_fed_forward_while_a_limb_moves() {
    let mut bench = Bench::new();
    let feeds = |orders: &[Order]| {
        orders.iter().any(|o| matches!(o, Order::FeedForward(0, p) if p.velocities == [0.1; 7]))
    };
    assert!(!feeds(&bench.pass(None)));
    assert!(feeds(&bench.pass(Some(bench.moving(0.01, Fingers::Stay)))));
}

#[test]
fn baxter_driver_reports_a_goal_reached_or_late() {
    let mut bench = Bench::new();
    bench.pass(None);
    let near = bench.moving(0.008, Fingers::Stay);
    assert_eq!(bench.driver.has_arrived(&near, 0.0), Ok(true));
    let far = bench.moving(0.01, Fingers::Stay);
    assert_eq!(bench.driver.has_arrived(&far, 0.9), Ok(false));
    let late = bench.driver.has_arrived(&far, 1.1);
    assert!(matches!(&late, Err(Fault::Goal { joint, .. }) if joint == "left_e1"), "{late:?}");
}

#[test]
fn gripper_command_is_resent_until_confirmed() {
    let mut bench = Bench::new();
    bench.pass(None);
    let close = bench.moving(0.0, Fingers::Grip(Grip { object_m: 0.004, offset_m: 0.0 }));
    let message = word(&bench.pass(Some(close))).unwrap();
    assert_eq!(message.read(), Ok(Word::Go(0.0)), "no properties yet: the SDK's way to close");
    let again = (0..30).filter_map(|_| word(&bench.pass(Some(close)))).collect::<Vec<_>>();
    assert_eq!(again, [message], "the same number, four times a second");
    let [no, yes] = [Tristate::False, Tristate::True].map(Tristate::code);
    let heard = |state: EndEffectorState| EndEffectorState {
        command_sender: message.sender,
        command_sequence: message.sequence,
        ..state
    };
    let moving =
        EndEffectorState { moving: Tristate::True.code(), position: 60.0, ..bench.grippers[0] };
    bench.grippers[0] = heard(moving);
    assert!((0..60).all(|_| word(&bench.pass(Some(close))).is_none()));
    assert_eq!(bench.driver.has_arrived(&close, 0.5), Ok(false), "the fingers move");
    bench.grippers[0] =
        heard(EndEffectorState { moving: no, gripping: yes, position: 10.0, ..bench.grippers[0] });
    bench.pass(Some(close));
    assert_eq!(bench.driver.has_arrived(&close, 0.5), Ok(true));
    assert_eq!(bench.driver.measured().holds(Limb::Left), Some(true));
}

/// A bench whose left gripper has a holding force, and its first command: to set it.
fn unconfigured() -> (Bench, Command, EndEffectorCommand) {
    let mut bench = Bench::new();
    let own = EndEffectorProperties {
        ui_type: UiType::Electric.code(),
        controls_force: 1,
        controls_position: 1,
        ..EndEffectorProperties::default()
    };
    bench.driver.on_report(&Report::Properties(0, own.into()), bench.now);
    bench.pass(None);
    let open = bench.moving(0.0, Fingers::Open(0.02));
    let message = word(&bench.pass(Some(open))).unwrap();
    assert_eq!(message.read(), Ok(Word::Configure(100.0)));
    (bench, open, message)
}

#[test]
fn holding_force_is_set_before_the_fingers_first_move() {
    let (mut bench, open, message) = unconfigured();
    assert!((0..10).all(|_| word(&bench.pass(Some(open))).is_none()), "it is not confirmed yet");
    bench.grippers[0].command_sender = message.sender;
    bench.grippers[0].command_sequence = message.sequence;
    let next = word(&bench.pass(Some(open))).unwrap();
    assert!(matches!(next.read(), Ok(Word::Go(percent)) if percent > 0.0), "{next:?}");
}

#[test]
fn fingers_move_with_the_force_they_have_if_none_is_confirmed() {
    let (mut bench, open, _) = unconfigured();
    let begin = bench.now;
    let moves = |bench: &mut Bench| {
        let sent = word(&bench.pass(Some(open)));
        sent.filter(|message| message.read() != Ok(Word::Configure(100.0)))
    };
    let next = (0..1_000).find_map(|_| moves(&mut bench)).expect("a command to the fingers");
    assert!(matches!(next.read(), Ok(Word::Go(percent)) if percent > 0.0), "{next:?}");
    let waited = bench.now.since(begin);
    assert!((Span::from_ms(1_900)..Span::from_ms(2_200)).contains(&waited), "{waited:?}");
}

#[test]
fn gripper_judges_a_grasp_by_sensor_and_position() {
    let [no, yes, unknown] =
        [Tristate::False, Tristate::True, Tristate::Unknown].map(Tristate::code);
    for (gripping, missed, position, holding) in [
        (yes, no, 30.0, Some(true)),
        (yes, no, 2.0, Some(false)),
        (no, yes, 0.0, Some(false)),
        (unknown, unknown, 30.0, Some(true)),
        (unknown, unknown, 1.0, Some(false)),
    ] {
        let mut bench = Bench::new();
        bench.pass(None);
        let close = bench.moving(0.0, Fingers::Grip(Grip { object_m: 0.01, offset_m: 0.0 }));
        let message = word(&bench.pass(Some(close))).unwrap();
        bench.grippers[0] = EndEffectorState {
            gripping,
            missed,
            position,
            command_sender: message.sender,
            command_sequence: message.sequence,
            ..bench.grippers[0]
        };
        bench.pass(Some(close));
        bench.driver.begin_pass(bench.now, [true; 2]);
        assert_eq!(bench.driver.measured().holds(Limb::Left), holding, "{gripping:?} {position}");
    }
}

#[test]
fn uncalibrated_gripper_is_calibrated_unless_it_may_hold_an_object() {
    let mut bench = Bench::new();
    bench.grippers[0].calibrated = Tristate::False.code();
    let message = word(&bench.pass(None)).unwrap();
    assert_eq!(message.read(), Ok(Word::Calibrate));
    assert_eq!(bench.driver.inhibit(), MotionInhibit::Calibrating);
    let mut bench = Bench::new();
    bench.grippers[0].calibrated = Tristate::False.code();
    bench.now = bench.now + Span::from_ms(10);
    bench.report_all();
    bench.driver.begin_pass(bench.now, [false, true]);
    assert_eq!(word(&bench.driver.end_pass(bench.now)), None);
}
