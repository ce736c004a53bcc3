//! Stops of the bridge's own, when a stop is over, and the fingers beside it.

use super::*;

const COMMAND: FingerOrder = FingerOrder { number: 3, position: 0.0, closes: true };

impl Bench {
    fn passes(&mut self, n: usize, motion: &Motion) {
        (0..n).for_each(|_| self.order(motion.clone()));
    }

    fn stopped(&self) -> u64 {
        self.controller.facts().2
    }

    fn stops_fingers(&self, is_ending: bool) -> bool {
        let joints = Some(&self.joints);
        let facts = Facts { order: self.order.as_ref(), joints, is_ending, now: self.now };
        self.controller.stops_fingers(&facts)
    }
}

#[test]
fn arm_that_was_held_up_goes_on_only_once_it_knows_that_it_was_stopped() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    (0..16).for_each(|_| bench.pass());
    assert_eq!((bench.cancels, bench.controller.is_stopping()), (1, true));
    bench.follow(2);
    bench.answer(Answer::Cancelled(0));
    (0..20).for_each(|_| bench.follow(2));
    assert!(!bench.controller.is_stopping(), "the joints stand");
    assert_eq!(bench.goals.len(), 1, "the arm follows its old plan");
    assert_eq!(bench.controller.condition(bench.now), Condition::Silent);
    assert!(bench.stops_fingers(false));
    bench.passes(2, &Motion::Rest);
    bench.answer(Answer::Probed);
    assert_eq!(bench.controller.condition(bench.now), Condition::Ready);
    bench.follow(3);
    assert_eq!(bench.goals.len(), 2, "it has planned anew");
}

#[test]
fn stop_of_the_arm_acknowledges_one_of_the_bridge_and_an_old_order_does_not() {
    let mut bench = Bench::new();
    bench.follow(1);
    let given = bench.now;
    (0..16).for_each(|_| bench.pass());
    // Given before the bridge's stop, and read after it.
    bench.order = Some(ArmOrder { at_ns: given.ns(), motion: Motion::Rest, fingers: None });
    bench.pass();
    assert_eq!(bench.controller.condition(bench.now), Condition::Silent);
    bench.passes(1, &Motion::Stop(5));
    assert_eq!(bench.controller.condition(bench.now), Condition::Ready);
    bench.answer(Answer::Cancelled(0));
    bench.passes(20, &Motion::Stop(5));
    assert_eq!(bench.stopped(), 5);
}

#[test]
fn orders_of_a_dead_arm_and_of_a_bridge_that_ends_are_not_carried_out() {
    let mut bench = Bench::new();
    bench.follow(1);
    let late = Motion::Follow(Window { number: 2, ..Window::default() });
    let at_ns = bench.now.ns();
    bench.now = bench.now + Span::from_ms(160);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    bench.answer(Answer::Ended(bench.goals[0].0, status::SUCCEEDED, result(0)));
    bench.order = Some(ArmOrder { at_ns, motion: late.clone(), fingers: None });
    bench.pass();
    assert_eq!((bench.goals.len(), bench.cancels), (1, 0), "nothing is under way");
    assert!(bench.stops_fingers(false));
    bench.order = Some(ArmOrder { at_ns: bench.now.ns(), motion: late, fingers: None });
    assert!(!bench.stops_fingers(false) && bench.stops_fingers(true));
    let Bench { controller, order, joints, now, .. } = &mut bench;
    let facts = Facts { order: order.as_ref(), joints: Some(joints), is_ending: true, now: *now };
    assert_eq!(controller.decide(&facts, |_| None), [], "the bridge ends");
    bench.pass();
    assert_eq!(bench.goals.len(), 2);
}

#[test]
fn joints_that_turn_back_have_not_stopped() {
    let mut bench = Bench::new();
    bench.passes(1, &Motion::Stop(5));
    bench.answer(Answer::Cancelled(0));
    for v in [0.3, 0.02, -0.01, -0.02, -0.2] {
        bench.joints.qd = vec![v, 0.0];
        bench.now = bench.now + Span::from_ms(2);
        bench.joints.at_ns = bench.now.ns();
        bench.order.as_mut().unwrap().at_ns = bench.now.ns();
        bench.deaf_pass();
        assert_eq!(bench.stopped(), 0, "{v}");
    }
    bench.joints.qd = vec![0.0; 2];
    bench.passes(10, &Motion::Stop(5));
    assert_eq!(bench.stopped(), 0, "90 ms");
    // The goal that holds the arm lasts for 200 ms.
    bench.passes(6, &Motion::Stop(5));
    assert_eq!(bench.stopped(), 0);
    bench.passes(8, &Motion::Stop(5));
    assert_eq!(bench.stopped(), 5);
}

#[test]
fn joints_have_stopped_once_they_have_stood_for_a_tenth_of_a_second() {
    let mut bench = Bench::new();
    bench.passes(1, &Motion::Stop(5));
    bench.answer(Answer::Cancelled(0));
    bench.passes(9, &Motion::Stop(5));
    assert_eq!((bench.stopped(), bench.goals.len()), (0, 0), "90 ms, and no goal holds the arm");
    bench.passes(2, &Motion::Stop(5));
    assert_eq!(bench.stopped(), 5);
}

#[test]
fn goal_that_may_be_under_way_beside_a_refused_one_is_stopped() {
    let mut bench = Bench::new();
    bench.follow(1);
    bench.answer(Answer::Accepted(bench.goals[0].0, true));
    bench.follow(2);
    bench.answer(Answer::Accepted(bench.goals[1].0, false));
    (0..17).for_each(|_| bench.pass());
    assert_eq!(bench.cancels, 1);
    // One that was replaced is over, whether or not its end is told.
    let mut bench = Bench::new();
    (1..=2).for_each(|number| bench.follow(number));
    bench.answer(Answer::Accepted(bench.goals[1].0, true));
    bench.answer(Answer::Ended(bench.goals[1].0, status::SUCCEEDED, result(0)));
    (0..17).for_each(|_| bench.pass());
    assert_eq!(bench.cancels, 0);
}

/// Fingers with a command under way at a time, and its goal.
fn closing(now: Time) -> (FingerController, GoalId) {
    let mut fingers = FingerController::new(Identity::new(9, now));
    fingers.on_answer(Answer::Probed, now);
    assert!(fingers.decide(Some(COMMAND), true, now).is_empty(), "not during a stop");
    let asked = fingers.decide(Some(COMMAND), false, now);
    let [Request::Goal(id, _)] = asked[..] else { panic!("{asked:?}") };
    (fingers, id)
}

#[test]
fn command_to_the_fingers_is_cancelled_until_its_end_is_told() {
    let mut now = Time(5_000_000_000);
    let (mut fingers, id) = closing(now);
    let next = FingerOrder { number: 4, position: 1.0, closes: false };
    let mut cancels = 0;
    for pass in 0..30 {
        // The stop of the arm is over after 100 ms; the first requests came before the goal.
        let asked = fingers.decide(Some(next), pass < 10, now);
        assert!(asked.iter().all(|it| *it == Request::CancelAll), "{asked:?}");
        cancels += asked.len();
        fingers.on_answer(Answer::Cancelled(0), now);
        assert!(fingers.is_stopping());
        now = now + Span::from_ms(10);
    }
    assert_eq!((cancels, fingers.end()), (6, None));
    fingers.on_answer(Answer::Accepted(id, true), now);
    fingers.on_answer(Answer::Ended(id, status::CANCELED, FingerResult::default()), now);
    assert!(!fingers.is_stopping());
    assert_eq!(fingers.end().map(|end| (end.number, end.stalled)), Some((3, false)));
    assert!(
        matches!(fingers.decide(Some(next), false, now)[..], [Request::Goal(_, it)] if it == next)
    );
}

#[test]
fn cancelled_command_whose_end_is_never_told_is_over_after_a_while() {
    let mut now = Time(5_000_000_000);
    let (mut fingers, _) = closing(now);
    fingers.decide(None, true, now);
    for _ in 0..199 {
        now = now + Span::from_ms(10);
        fingers.on_answer(Answer::Cancelled(0), now);
        fingers.decide(None, false, now);
        assert!(fingers.is_stopping());
    }
    now = now + Span::from_ms(20);
    assert!(fingers.decide(None, false, now).is_empty());
    assert!(!fingers.is_stopping());
    assert_eq!(fingers.end().map(|end| (end.number, end.reached)), Some((3, false)));
}
