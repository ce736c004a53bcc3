//! The bridge without a domain: which goals it asks for, and how it judges their ends.

use service::{Span, Time};
use trajectory_driver::{
    ArmOrder, Condition, Ending, FingerOrder, JointMeasurement, Motion, Window, WindowPoint,
};

use super::actions::{Answer, GoalId, Identity, Request, status};
use super::controller::{Controller, Facts, judged};
use super::fingers::{FingerController, FingerResult};
use super::joints::JointReader;
use super::types::{Tolerances, TrajectoryGoal, TrajectoryResult};
use crate::types::{Header, JointState, Time as RosTime};

mod stops;
#[cfg(feature = "dds")]
mod wire;

const WITHIN: Tolerances = Tolerances { path_rad: 0.2, goal_rad: 0.01, goal_time_s: 2.0 };
const STRANGER: GoalId = [7; 16];

fn result(error_code: i32) -> TrajectoryResult {
    TrajectoryResult { error_code, error_string: String::new() }
}

/// A controller with a scripted server and arm.
struct Bench {
    controller: Controller,
    order: Option<ArmOrder>,
    joints: JointMeasurement,
    now: Time,
    goals: Vec<(GoalId, TrajectoryGoal)>,
    cancels: usize,
}

impl Bench {
    fn new() -> Self {
        let joints = ["a", "b"].map(str::to_owned).to_vec();
        let now = Time(10_000_000_000);
        let mut controller = Controller::new(joints, WITHIN, 0.05, Identity::new(9, now));
        controller.on_answer(Answer::Probed, now);
        let joints = JointMeasurement {
            q: vec![0.5, -0.5],
            qd: vec![0.0; 2],
            effort: vec![0.0; 2],
            ..JointMeasurement::default()
        };
        Self { controller, order: None, joints, now, goals: Vec::new(), cancels: 0 }
    }

    fn pass(&mut self) {
        self.now = self.now + Span::from_ms(10);
        self.joints.at_ns = self.now.ns();
        self.deaf_pass();
    }

    fn deaf_pass(&mut self) {
        let facts = Facts {
            order: self.order.as_ref(),
            joints: Some(&self.joints),
            is_ending: false,
            now: self.now,
        };
        for request in self.controller.decide(&facts, |at| {
            Some(RosTime { sec: (at.ns() / 1_000_000_000) as i32, nanosec: 0 })
        }) {
            match request {
                Request::Goal(id, goal) => self.goals.push((id, goal)),
                Request::CancelAll => self.cancels += 1,
                Request::Probe(_) => self.controller.on_answer(Answer::Probed, self.now),
                Request::Result(_) => panic!("asked for by the domain"),
            }
        }
    }

    fn order(&mut self, motion: Motion) {
        self.order = Some(ArmOrder { at_ns: self.now.ns(), motion, fingers: None });
        self.pass();
    }

    fn follow(&mut self, number: u64) {
        let point = |t_s, q, v| WindowPoint { t_s, q: vec![q; 2], qd: vec![v; 2] };
        let points = vec![point(0.05, 0.1, 0.2), point(0.3, 0.2, 0.0)];
        self.order(Motion::Follow(Window { number, begin_ns: self.now.ns(), points }));
    }

    fn answer(&mut self, answer: Answer<TrajectoryResult>) {
        self.controller.on_answer(answer, self.now);
    }

    fn ended(&self) -> Option<(u64, Ending)> {
        self.controller.facts().1
    }
}

#[test]
fn status_counts_before_the_error_code() {
    assert_eq!(judged(status::CANCELED, 0), Some(Ending::Cancelled), "it has the code of success");
    assert_eq!(judged(status::SUCCEEDED, 0), Some(Ending::Succeeded));
    assert_eq!(judged(status::ABORTED, -4), Some(Ending::Aborted(-4)));
    assert_eq!(judged(2, 0), None);
}

#[test]
fn window_becomes_a_goal_with_names_stamp_and_tolerances_once() {
    let mut bench = Bench::new();
    bench.follow(1);
    (0..5).for_each(|_| bench.pass());
    assert_eq!(bench.goals.len(), 1);
    let goal = &bench.goals[0].1;
    assert_eq!(goal.trajectory.joint_names, ["a", "b"]);
    assert_eq!(goal.trajectory.header.stamp.sec, 10);
    assert_eq!(goal.trajectory.points.len(), 2);
    assert_eq!(goal.trajectory.points[0].time_from_start, RosTime { sec: 0, nanosec: 50_000_000 });
    let tolerances = goal.path_tolerance.iter().map(|it| (it.name.as_str(), it.position));
    assert_eq!(tolerances.collect::<Vec<_>>(), [("a", 0.2), ("b", 0.2)]);
    assert_eq!(goal.goal_tolerance[1].position, 0.01);
    assert_eq!(goal.goal_time_tolerance, RosTime { sec: 2, nanosec: 0 });
}

#[test]
fn ends_of_goals_that_were_replaced_here_say_nothing() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    bench.follow(2);
    // As jazzy and humble end them, before and after the answer to the new one.
    bench.answer(Answer::Ended(bench.goals[0].0, status::ABORTED, result(-1)));
    assert_eq!(bench.ended(), None);
    bench.answer(Answer::Accepted(bench.goals[1].0, true));
    bench.follow(3);
    bench.answer(Answer::Ended(bench.goals[1].0, status::CANCELED, result(0)));
    assert_eq!((bench.ended(), bench.controller.facts().0), (None, 2));
    // A violated tolerance is none of ours.
    bench.follow(4);
    bench.answer(Answer::Ended(bench.goals[2].0, status::ABORTED, result(-4)));
    assert_eq!(bench.ended(), Some((3, Ending::Aborted(-4))));
    bench.answer(Answer::Ended(bench.goals[3].0, status::SUCCEEDED, result(0)));
    assert_eq!(bench.ended(), Some((4, Ending::Succeeded)));
}

#[test]
fn refused_goal_and_one_that_another_client_replaced_are_told() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, false));
    assert_eq!(bench.ended(), Some((1, Ending::Refused)));
    bench.follow(2);
    bench.answer(Answer::Accepted(bench.goals[1].0, true));
    bench.answer(Answer::Ended(bench.goals[1].0, status::ABORTED, result(-1)));
    assert_eq!(bench.ended(), Some((2, Ending::Aborted(-1))));
    // A status without a result is believed after a while.
    bench.follow(3);
    bench.answer(Answer::Statuses(vec![(bench.goals[2].0, status::CANCELED)]));
    (0..60).for_each(|_| bench.follow(3));
    assert_eq!(bench.ended(), Some((3, Ending::Cancelled)));
}

#[test]
fn stop_cancels_until_it_is_answered_and_the_joints_stand() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    bench.answer(Answer::Statuses(vec![(bench.goals[0].0, 2)]));
    bench.joints.qd = vec![0.4, 0.0];
    (0..20).for_each(|_| bench.order(Motion::Stop(5)));
    assert!((4..=5).contains(&bench.cancels), "{}", bench.cancels);
    // Meanwhile another goal holds the arm in its measured posture.
    let holds: Vec<_> = bench.goals[1..].iter().map(|(_, goal)| &goal.trajectory).collect();
    assert!((2..=3).contains(&holds.len()) && holds[0].points.len() == 1);
    assert_eq!(holds[0].points[0].positions, [0.5, -0.5]);
    assert_eq!(holds[0].header.stamp, RosTime::default(), "at once");
    bench.answer(Answer::Cancelled(0));
    (0..20).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.controller.facts().2, 0, "it is answered, and the joints move");
    bench.joints.qd = vec![0.0; 2];
    (0..30).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.controller.facts().2, 5);
    let cancels = bench.cancels;
    (0..20).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.cancels, cancels, "it is over");
}

#[test]
fn joint_states_that_stand_still_prove_no_stop() {
    let mut bench = Bench::new();
    bench.order(Motion::Stop(5));
    bench.answer(Answer::Cancelled(3));
    for _ in 0..200 {
        bench.now = bench.now + Span::from_ms(10);
        bench.order.as_mut().unwrap().at_ns = bench.now.ns();
        bench.deaf_pass();
    }
    assert_eq!(bench.controller.facts().2, 0, "frozen");
    assert!(bench.cancels > 30);
    (0..12).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.controller.facts().2, 5);
}

#[test]
fn stop_without_an_answer_is_over_once_every_window_has_run_out_at_rest() {
    let mut bench = Bench::new();
    (0..60).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.controller.facts().2, 0);
    (0..30).for_each(|_| bench.order(Motion::Stop(5)));
    assert_eq!(bench.controller.facts().2, 5);
}

#[test]
fn dead_arm_is_stopped_within_its_silence() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    bench.joints.qd = vec![0.4, 0.0];
    (0..14).for_each(|_| bench.pass());
    assert_eq!(bench.cancels, 0);
    (0..3).for_each(|_| bench.pass());
    assert_eq!(bench.cancels, 1);
    bench.answer(Answer::Cancelled(0));
    bench.joints.qd = vec![0.0; 2];
    (0..30).for_each(|_| bench.pass());
    assert!(!bench.controller.is_stopping());
    // A goal that has ended is not stopped again.
    let cancels = bench.cancels;
    (0..100).for_each(|_| bench.pass());
    assert_eq!(bench.cancels, cancels);
}

#[test]
fn goals_at_the_start_are_cancelled_if_ours_and_named_if_of_others() {
    let mut bench = Bench::new();
    let mut former = Identity::new(9, Time(3_000_000));
    let id = former.next_goal();
    bench.answer(Answer::Statuses(vec![(id, 2), ([8; 16], status::SUCCEEDED)]));
    bench.order(Motion::Rest);
    assert_eq!(bench.cancels, 1);
    bench.answer(Answer::Statuses(vec![(id, status::CANCELED)]));
    bench.answer(Answer::Cancelled(0));
    (0..15).for_each(|_| bench.order(Motion::Rest));
    assert!(!bench.controller.is_stopping());
    assert_eq!(bench.controller.condition(bench.now), Condition::Ready);

    bench.answer(Answer::Statuses(vec![(STRANGER, 2)]));
    assert_eq!(bench.controller.condition(bench.now), Condition::Foreign);
    bench.follow(1);
    assert!(bench.goals.is_empty(), "nothing is sent beside it");
    bench.answer(Answer::Statuses(vec![(STRANGER, status::SUCCEEDED)]));
    bench.follow(2);
    assert_eq!(bench.goals.len(), 1);
}

#[test]
fn controller_that_does_not_answer_is_silent() {
    let mut bench = Bench::new();
    bench.follow(1);
    (0..28).for_each(|_| bench.follow(1));
    assert_eq!(bench.controller.condition(bench.now), Condition::Ready);
    // Statuses of a server that hangs are still delivered.
    bench.answer(Answer::Statuses(Vec::new()));
    bench.now = bench.now + Span::from_ms(30);
    assert_eq!(bench.controller.condition(bench.now), Condition::Silent);
    // It lives, and the goal was lost.
    bench.answer(Answer::Probed);
    assert_eq!(bench.controller.condition(bench.now), Condition::Ready);
    bench.now = bench.now + Span::from_ms(3_000);
    assert_eq!(bench.controller.condition(bench.now), Condition::Silent);
    let unheard = Controller::new(Vec::new(), WITHIN, 0.05, Identity::new(9, Time(0)));
    assert_eq!(unheard.condition(bench.now), Condition::Unheard);
}

#[test]
fn stalled_fingers_have_gripped_whatever_the_status() {
    let now = Time(5_000_000_000);
    for (status, stalled, reached, expected) in [
        (status::ABORTED, true, false, (true, false)),
        (status::SUCCEEDED, true, false, (true, false)),
        (status::SUCCEEDED, false, true, (false, true)),
        (status::CANCELED, true, false, (false, false)),
        (status::ABORTED, false, false, (false, false)),
    ] {
        let mut fingers = FingerController::new(Identity::new(9, now));
        fingers.on_answer(Answer::Probed, now);
        let order = FingerOrder { number: 3, position: 0.0, closes: true };
        let asked = fingers.decide(Some(order), false, now);
        let [Request::Goal(id, _)] = asked[..] else { panic!("{asked:?}") };
        assert!(fingers.decide(Some(order), false, now).is_empty(), "once");
        fingers.on_answer(Answer::Ended(STRANGER, status::SUCCEEDED, FingerResult::default()), now);
        assert_eq!(fingers.end(), None, "the end of another one");
        fingers.on_answer(Answer::Ended(id, status, FingerResult { stalled, reached }), now);
        let end = fingers.end().unwrap();
        assert_eq!((end.number, end.closes, (end.stalled, end.reached)), (3, true, expected));
    }
}

#[test]
fn joint_states_are_read_by_name_and_without_velocities() {
    let mut reader = JointReader::new(vec!["a".to_owned(), "b".to_owned()], "f".to_owned());
    let state = |sec, nanosec, joints: &[(&str, f64)]| JointState {
        header: Header { stamp: RosTime { sec, nanosec }, frame_id: String::new() },
        name: joints.iter().map(|(name, _)| (*name).to_owned()).collect(),
        position: joints.iter().map(|(_, q)| *q).collect(),
        ..JointState::default()
    };
    let at = |ms: u64| Time(1_000_000_000 + ms * 1_000_000);
    assert!(!reader.read(&state(100, 0, &[("f", 0.02), ("a", 1.0)]), at(0)), "a joint is missing");
    assert!(reader.read(&state(100, 0, &[("b", 2.0), ("x", 9.0), ("a", 1.0)]), at(0)));
    assert!(reader.read(&state(100, 100_000_000, &[("b", 2.0), ("a", 1.1)]), at(101)));
    let latest = reader.latest().unwrap();
    assert_eq!((latest.q.clone(), latest.fingers), (vec![1.1, 2.0], Some(0.02)));
    assert!((latest.qd[0] - 1.0).abs() < 0.02 && latest.qd[1] == 0.0, "{:?}", latest.qd);
    // Stamps of a clock that is not ours.
    let stamp = reader.stamp(at(1_100)).unwrap();
    assert_eq!(stamp.sec, 101);
    let lost = f64::NAN;
    assert!(!reader.read(&state(100, 200_000_000, &[("b", lost), ("a", 1.2)]), at(201)));
}
