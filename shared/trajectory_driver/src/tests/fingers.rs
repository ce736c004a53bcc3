//! The fingers: cancelled commands, and partly opened ones.

use super::*;

impl Bench {
    fn command_fingers(&mut self, fingers: Fingers) -> crate::FingerOrder {
        let limits = &Robot::baxter().arm(LIMB).limits;
        let hold = Trajectory::hold(&self.q, 1.0, limits);
        self.now = self.now + Span::from_ms(30);
        self.hear();
        self.driver.begin_pass(self.now, [true; 2]);
        self.driver.command(&command(&hold, 0.5, fingers), PASS_S);
        self.take_orders();
        self.order.fingers.unwrap()
    }

    fn stop_now(&mut self) {
        self.driver.stop();
        self.pass(None);
        let Motion::Stop(number) = self.order.motion else { panic!("{:?}", self.order) };
        self.report.stopped = number;
        self.pass(None);
    }
}

const GRIP: Fingers = Fingers::Grip(Grip { object_m: 0.02, offset_m: 0.0 });

#[test]
fn cancelled_fingers_are_not_still_until_their_end_is_told() {
    let mut bench = Bench::new();
    let order = bench.command_fingers(GRIP);
    bench.stop_now();
    assert_eq!(bench.order.fingers, None);
    (0..50).for_each(|_| bench.pass(None));
    assert!(!bench.driver.is_still());
    let end = FingerEnd { number: order.number, closes: true, ..FingerEnd::default() };
    bench.report.fingers = Some(end);
    bench.pass(None);
    assert!(bench.driver.is_still());
    let next = bench.command_fingers(GRIP);
    assert!(next.number > order.number);
    // A command whose end was told is not awaited again.
    bench.report.fingers = Some(FingerEnd { number: next.number, ..end });
    bench.pass(None);
    bench.stop_now();
    assert!(bench.driver.is_still());
}

#[test]
fn end_of_cancelled_fingers_that_is_never_told_is_awaited_for_a_while() {
    let mut bench = Bench::new();
    bench.command_fingers(GRIP);
    bench.stop_now();
    (0..190).for_each(|_| bench.pass(None));
    assert!(!bench.driver.is_still());
    (0..15).for_each(|_| bench.pass(None));
    assert!(bench.driver.is_still());
}

#[test]
fn fingers_that_open_in_part_are_open_where_they_were_ordered() {
    let own = settings().gripper;
    let gripper = Robot::baxter().arm(LIMB).gripper;
    let half = Fingers::Open(gripper.width_m(50.0));
    for (percent, is_done) in [(48.0, true), (98.0, false), (10.0, false)] {
        let mut bench = Bench::new();
        let order = bench.command_fingers(half);
        let end = FingerEnd { number: order.number, stalled: true, ..FingerEnd::default() };
        bench.report.fingers = Some(end);
        bench.report.joints.as_mut().unwrap().fingers = Some(own.position(percent));
        bench.pass(None);
        let limits = &Robot::baxter().arm(LIMB).limits;
        let hold = Trajectory::hold(&bench.q, 1.0, limits);
        let done = bench.driver.has_arrived(&command(&hold, 1.0, half), 0.1);
        assert_eq!(done.is_ok(), is_done, "{percent} {done:?}");
    }
}

#[test]
fn stop_of_the_bridge_s_own_ends_the_motion_and_no_window_follows() {
    let (mut bench, motion) = (Bench::new(), motion(1.2));
    bench.run(&motion, 0.0, 0.5);
    let windows = bench.windows.len();
    bench.report.condition = Condition::Silent;
    bench.pass(Some((&motion, 0.51)));
    let Motion::Stop(number) = bench.order.motion else { panic!("{:?}", bench.order) };
    bench.report.condition = Condition::Ready;
    bench.report.stopped = number;
    bench.run(&motion, 0.51, 0.6);
    assert_eq!(bench.windows.len(), windows, "the old plan's middle is not followed");
    assert_eq!(bench.order.motion, Motion::Rest);
}
