//! The driver alone: which windows it makes of a motion, and what it does with what it hears.

use std::path::Path;

use arm_driver::{ArmDriver, Command, Fault, Fingers, Grip, Posture, Start};
use config::Settings;
use manipulation::{Joints, Limb, Robot, State, Trajectory};
use messages::MotionInhibit;
use messages::robot::{Order, Report};
use service::{Span, Time};

use crate::window::{EVERY_S, LEAD_S, PATH_S, part};
use crate::{
    ArmOrder, Condition, ControllerReport, Controllers, Ending, FingerEnd, JointMeasurement,
    Motion, TrajectoryDriver, Window,
};

mod fingers;
mod names;

const LIMB: Limb = Limb::Left;
const PASS_S: f64 = 0.01;

fn settings() -> Controllers {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    Settings::load(folder, None, &[]).unwrap().part().unwrap()
}

/// A motion of one joint by so much, from rest to rest.
fn motion(by_rad: f64) -> Trajectory {
    let arm = Robot::baxter().arm(LIMB);
    let rest = |q| State { q, qd: [0.0; 7], qdd: [0.0; 7] };
    let (from, mut to) = (arm.neutral, arm.neutral);
    to[0] += by_rad;
    Trajectory::between(&rest(from), &rest(to), &arm.limits).unwrap()
}

/// A driver with a scripted bridge, and an arm that is where its window wants it.
struct Bench {
    driver: TrajectoryDriver,
    now: Time,
    q: Joints,
    qd: Joints,
    report: ControllerReport,
    order: ArmOrder,
    /// Every window, once.
    windows: Vec<Window>,
    follows: bool,
    accepts: bool,
}

impl Bench {
    fn new() -> Self {
        let robot = Robot::baxter();
        let joints = Limb::BOTH.map(|limb| robot.arm(limb).neutral);
        let width_m = Limb::BOTH.map(|limb| robot.arm(limb).gripper.width_m(100.0));
        let posture = Posture { joints, width_m };
        let start = Start { robot, limb: Some(LIMB), posture, holding: None };
        let mut bench = Self {
            driver: TrajectoryDriver::new(settings(), &start),
            now: Time(5_000_000_000),
            q: joints[0],
            qd: [0.0; 7],
            report: ControllerReport { condition: Condition::Ready, ..Default::default() },
            order: ArmOrder::default(),
            windows: Vec::new(),
            follows: true,
            accepts: true,
        };
        bench.pass(None);
        bench
    }

    fn number(&self) -> u64 {
        self.windows.last().map_or(0, |window| window.number)
    }

    /// Where the newest window wants the arm.
    fn follow(&mut self) {
        let Some(window) = self.windows.last().filter(|_| self.follows) else { return };
        let t_s = self.now.since(Time(window.begin_ns)).s();
        let next = window.points.iter().position(|point| point.t_s > t_s);
        let k = next.unwrap_or(window.points.len() - 1).max(1);
        let (a, b) = (&window.points[k - 1], &window.points[k]);
        let u = ((t_s - a.t_s) / (b.t_s - a.t_s)).clamp(0.0, 1.0);
        if t_s < window.points[0].t_s && self.windows.len() == 1 {
            return;
        }
        self.q = std::array::from_fn(|j| a.q[j] + u * (b.q[j] - a.q[j]));
        self.qd = std::array::from_fn(|j| if next.is_some() { b.qd[j] } else { 0.0 });
    }

    fn hear(&mut self) {
        if self.accepts {
            self.report.accepted = self.number();
        }
        let fingers = self.report.joints.as_ref().and_then(|joints| joints.fingers);
        self.report.joints = Some(JointMeasurement {
            at_ns: self.now.ns(),
            q: self.q.to_vec(),
            qd: self.qd.to_vec(),
            effort: vec![0.0; 7],
            fingers,
        });
        self.tell();
    }

    fn tell(&mut self) {
        let bytes = postcard::to_stdvec(&self.report).unwrap();
        self.driver.on_report(&Report::Own(bytes), self.now);
    }

    /// A pass in which the arm is heard and, with a motion, `t_s` seconds of it are commanded.
    fn pass(&mut self, motion: Option<(&Trajectory, f64)>) {
        self.now = self.now + Span::from_s(PASS_S);
        self.follow();
        self.hear();
        self.deaf_pass(motion);
    }

    fn deaf_pass(&mut self, motion: Option<(&Trajectory, f64)>) {
        self.driver.begin_pass(self.now, [true; 2]);
        if let Some((motion, t_s)) = motion {
            self.driver.command(&command(motion, t_s, Fingers::Stay), PASS_S);
            self.driver.look_ahead(LIMB, motion, t_s);
        }
        self.take_orders();
    }

    fn take_orders(&mut self) {
        for order in self.driver.end_pass(self.now) {
            let Order::Own(bytes) = order else { panic!("{order:?}") };
            self.order = postcard::from_bytes(&bytes).unwrap();
            if let Motion::Follow(window) = &self.order.motion
                && window.number > self.number()
            {
                self.windows.push(window.clone());
            }
        }
    }

    /// The motion from `from_s` to `to_s`.
    fn run(&mut self, motion: &Trajectory, from_s: f64, to_s: f64) {
        for n in 1..=((to_s - from_s) / PASS_S).round() as usize {
            self.pass(Some((motion, from_s + n as f64 * PASS_S)));
        }
    }

    fn arrives(&mut self, motion: &Trajectory, late_s: f64) -> Result<bool, Fault> {
        self.driver.has_arrived(&command(motion, motion.duration_s(), Fingers::Stay), late_s)
    }
}

fn command(motion: &Trajectory, t_s: f64, fingers: Fingers) -> Command {
    let State { q, qd, qdd } = motion.state(t_s);
    Command { limb: LIMB, q, qd, qdd, t_s, fingers }
}

#[test]
fn window_is_on_the_path_and_ends_at_rest_within_its_bound() {
    let motion = motion(1.2);
    let whole = motion.duration_s();
    for n in 0..=100 {
        let from_s = whole * f64::from(n) / 100.0;
        let part = part(&motion, (from_s, PATH_S), 7);
        let (first, last) = (&part.points[0], part.points.last().unwrap());
        assert!(part.points.windows(2).all(|two| two[1].t_s > two[0].t_s + 0.009), "{part:?}");
        assert!((first.t_s - LEAD_S).abs() < 1e-9 || part.points.len() == 1);
        assert!((first.q[0] - motion.state(from_s).q[0]).abs() < 1e-6);
        assert_eq!(last.qd, [0.0; 7]);
        let at_rest = motion.halted_at(from_s + part.path_s);
        assert!(last.t_s <= 0.55 + 1e-9 || part.path_s <= 0.25 + 1e-9, "{} s", last.t_s);
        assert!((last.q[0] - at_rest.end()[0]).abs() < 1e-6, "the ramp stays on the path");
        assert_eq!(part.is_last, from_s + part.path_s >= whole - 1e-9);
        // Between its points a controller interpolates cubically: never beyond the motion's own speed.
        let fastest = part
            .points
            .windows(2)
            .map(|two| (two[1].q[0] - two[0].q[0]).abs() / (two[1].t_s - two[0].t_s));
        let limit = Robot::baxter().arm(LIMB).limits.velocity[0];
        assert!(fastest.fold(0.0, f64::max) <= limit * 1.01);
    }
}

#[test]
fn windows_replace_one_another_ten_times_a_second_and_go_on_where_the_last_one_is() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, motion.duration_s());
    let windows = bench.windows.clone();
    let seconds = motion.duration_s();
    let expected = (seconds - 0.4) / EVERY_S;
    assert!((windows.len() as f64 - expected).abs() < 4.0, "{} in {seconds} s", windows.len());
    for two in windows.windows(2) {
        let passed_s = (two[1].begin_ns - two[0].begin_ns) as f64 * 1e-9;
        // Where the first point of the new window lies on the old one.
        let at_s = two[1].points[0].t_s + passed_s;
        let k = two[0].points.iter().position(|point| point.t_s >= at_s - 1e-9).unwrap();
        let (a, b) = (&two[0].points[k.max(1) - 1], &two[0].points[k.max(1)]);
        let u = (at_s - a.t_s) / (b.t_s - a.t_s);
        let there = a.q[0] + u * (b.q[0] - a.q[0]);
        assert!((two[1].points[0].q[0] - there).abs() < 0.01, "{} {there}", two[1].points[0].q[0]);
    }
    let goal = windows.last().unwrap().points.last().unwrap().q[0];
    assert!((goal - motion.end()[0]).abs() < 1e-6);
    // The controller's own word is needed, and the joints.
    assert_eq!(bench.arrives(&motion, 0.1), Ok(false));
    bench.report.accepted = bench.number();
    bench.report.ended = Some((bench.number(), Ending::Succeeded));
    (0..60).for_each(|_| bench.pass(Some((&motion, seconds))));
    assert_eq!(bench.arrives(&motion, 0.7), Ok(true));
    bench.pass(None);
    assert_eq!(bench.order.motion, Motion::Rest);
}

#[test]
fn windows_never_go_back_after_an_arm_that_was_held_up() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.6);
    let before = bench.windows.last().unwrap().clone();
    // 150 ms pass, of which the arm counts 50.
    bench.now = bench.now + Span::from_ms(140);
    bench.pass(Some((&motion, 0.65)));
    let after = bench.windows.last().unwrap();
    assert!(after.number > before.number);
    let at_s = (after.begin_ns - before.begin_ns) as f64 * 1e-9 + after.points[0].t_s;
    let there = before.points.iter().rfind(|point| point.t_s <= at_s).unwrap().q[0];
    assert!(after.points[0].q[0] >= there - 1e-6, "{} {there}", after.points[0].q[0]);
}

#[test]
fn arm_that_was_held_up_for_longer_than_its_windows_stops_and_waits_for_rest() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.6);
    bench.now = bench.now + Span::from_ms(700);
    bench.pass(Some((&motion, 0.65)));
    bench.pass(Some((&motion, 0.66)));
    let Motion::Stop(number) = bench.order.motion else { panic!("{:?}", bench.order) };
    assert!(!bench.driver.is_still());
    bench.report.stopped = number;
    bench.pass(None);
    assert_eq!(bench.driver.inhibit(), MotionInhibit::None);
    assert!(bench.driver.is_still(), "{:?}", bench.qd);
}

#[test]
fn windows_that_are_not_accepted_are_not_followed_by_others_that_the_arm_would_have_to_catch_up() {
    // From the first one on, and in the middle.
    for (accepted_s, at_most) in [(0.0, 1), (0.5, 3)] {
        let (mut bench, motion) = (Bench::new(), motion(1.2));
        bench.accepts = accepted_s > 0.0;
        bench.run(&motion, 0.0, f64::max(accepted_s, 0.1));
        let before = if bench.accepts { bench.windows.len() } else { 0 };
        bench.accepts = false;
        bench.run(&motion, f64::max(accepted_s, 0.1), accepted_s + 0.5);
        assert!(bench.windows.len() - before <= at_most, "{} {before}", bench.windows.len());
        assert!(matches!(bench.order.motion, Motion::Stop(_)), "{:?}", bench.order.motion);
    }
}

#[test]
fn stop_is_ordered_until_the_joints_are_measured_at_rest() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.5);
    assert!(bench.driver.stop(), "the bridge stops it");
    // The halt that the arm would command moves nothing, nor does another motion.
    let halt = motion.halted_at(0.5);
    let windows = bench.windows.len();
    (1..20).for_each(|n| bench.pass(Some((&halt, f64::from(n) * PASS_S))));
    let Motion::Stop(number) = bench.order.motion else { panic!("{:?}", bench.order) };
    assert_eq!(bench.windows.len(), windows);
    // The controller has answered; the joints have not.
    (bench.follows, bench.qd[0]) = (false, 0.3);
    bench.pass(None);
    assert!(!bench.driver.is_still());
    (bench.report.stopped, bench.qd) = (number, [0.0; 7]);
    bench.pass(None);
    assert!(bench.driver.is_still());
    assert_eq!(bench.order.motion, Motion::Rest);
    // Ends of cancelled windows are no faults of the next motion.
    bench.report.ended = Some((bench.number(), Ending::Cancelled));
    bench.pass(None);
    assert_eq!(bench.driver.fault(), None);
}

#[test]
fn stale_joint_states_a_silent_controller_and_another_client_stop_a_motion() {
    for (name, spoil, inhibit) in [
        ("stale", None, MotionInhibit::Stale),
        ("silent", Some(Condition::Silent), MotionInhibit::Stale),
        ("foreign", Some(Condition::Foreign), MotionInhibit::Error),
    ] {
        let (mut bench, motion) = (Bench::new(), motion(1.2));
        bench.run(&motion, 0.0, 0.5);
        for n in 0..20 {
            bench.now = bench.now + Span::from_s(PASS_S);
            if let Some(condition) = spoil {
                bench.report.condition = condition;
                bench.hear();
            }
            bench.deaf_pass(Some((&motion, 0.5 + f64::from(n) * PASS_S)));
        }
        assert_eq!(bench.driver.inhibit(), inhibit, "{name}");
        assert!(matches!(bench.order.motion, Motion::Stop(_)), "{name}: {:?}", bench.order.motion);
        assert!(!bench.driver.is_still(), "{name}");
    }
}

#[test]
fn only_the_end_of_the_newest_window_or_a_violated_tolerance_is_a_fault() {
    let ended = |which: usize, ending| {
        let (mut bench, motion) = (Bench::new(), motion(1.2));
        bench.run(&motion, 0.0, 0.55);
        let number = bench.windows[bench.windows.len() - 1 - which].number;
        bench.report.ended = Some((number, ending));
        bench.pass(Some((&motion, 0.56)));
        bench.driver.fault().map(|fault| fault.to_string())
    };
    let contains = |fault: Option<String>, words: &str| {
        assert!(fault.as_ref().is_some_and(|text| text.contains(words)), "{words}: {fault:?}");
    };
    // Replaced by ourselves, as humble and jazzy end such goals.
    assert_eq!(ended(1, Ending::Cancelled), None);
    assert_eq!(ended(1, Ending::Aborted(-1)), None);
    contains(ended(0, Ending::Aborted(-1)), "another client");
    contains(ended(0, Ending::Cancelled), "another client");
    contains(ended(0, Ending::Refused), "is it active");
    contains(ended(1, Ending::Aborted(-4)), "left its path");
    contains(ended(0, Ending::Aborted(-5)), "in time");
}

#[test]
fn arm_that_does_not_follow_is_a_fault_and_so_is_a_goal_that_is_not_reached() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.3);
    bench.follows = false;
    bench.qd = [0.0; 7];
    bench.run(&motion, 0.3, 1.2);
    assert!(matches!(bench.driver.fault(), Some(Fault::Path { .. })), "{:?}", bench.driver.fault());
    assert!(matches!(bench.arrives(&motion, 3.0), Err(Fault::Goal { .. })));
    // As the arm does with a fault.
    bench.driver.hold_here();
    bench.pass(None);
    assert!(matches!(bench.order.motion, Motion::Stop(_)));
}

#[test]
fn motion_begins_where_the_arm_is_alone() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.q[1] += 0.1;
    bench.run(&motion, 0.0, 0.1);
    assert!(bench.windows.is_empty(), "{:?}", bench.windows);
    // Nor in its middle.
    let mut bench = Bench::new();
    bench.run(&motion, 0.5, 0.6);
    assert!(bench.windows.is_empty());
}

#[test]
fn stalled_fingers_that_stand_apart_hold_something() {
    let mut bench = Bench::new();
    let hold = Trajectory::hold(&bench.q, 1.0, &Robot::baxter().arm(LIMB).limits);
    let grip = Fingers::Grip(Grip { object_m: 0.02, offset_m: 0.0 });
    let own = settings().gripper;
    let close = |bench: &mut Bench, percent: f64, stalled, reached| {
        // Orders that say nothing new of the joints are rarer.
        bench.now = bench.now + Span::from_ms(30);
        bench.driver.begin_pass(bench.now, [true; 2]);
        bench.driver.command(&command(&hold, 0.5, grip), PASS_S);
        bench.take_orders();
        let order = bench.order.fingers.unwrap();
        assert!(order.closes && order.position == own.closed);
        bench.report.fingers =
            Some(FingerEnd { number: order.number, closes: true, stalled, reached });
        bench.report.joints.as_mut().unwrap().fingers = Some(own.position(percent));
        bench.pass(None);
        bench.driver.measured().holds(LIMB)
    };
    assert_eq!(close(&mut bench, 40.0, true, false), Some(true));
    let done = bench.driver.has_arrived(&command(&hold, 1.0, grip), 0.1);
    assert_eq!(done, Ok(true));
    // Closed on nothing, or on themselves.
    assert_eq!(close(&mut bench, 1.0, true, false), Some(false));
    assert_eq!(close(&mut bench, 1.0, false, true), Some(false));
    // Neither stalled nor at its position: the controller has not done it.
    assert_eq!(close(&mut bench, 60.0, false, false), None);
    assert!(bench.driver.has_arrived(&command(&hold, 1.0, grip), 0.1).is_err());
}

#[test]
fn driver_resumes_from_its_checkpoint() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.5);
    let checkpoint = bench.driver.checkpoint().unwrap();
    let mut other = Bench::new().driver;
    other.resume(&checkpoint).unwrap();
    assert_eq!(other.measured(), bench.driver.measured());
    assert_eq!(other.checkpoint(), Some(checkpoint));
}
