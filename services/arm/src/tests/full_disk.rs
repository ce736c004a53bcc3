//! A slow or full disk: what moves is stopped all the same, and nothing begins that is not durable.

use super::*;

impl Machine {
    /// A client orders a stop or a release and asks until the arm rests; returns the last answer.
    fn order_by_socket(&mut self, order: MotionOrder) -> StopState {
        let given_ns = self.now.ns();
        let until = self.now + Span::from_ms(100);
        loop {
            self.order(order, given_ns);
            self.go(None);
            let state = *self.stop_states.last().expect("every order is answered in its pass");
            assert_eq!(state.given_ns, given_ns);
            let settled = state.durable || self.waiting_for_disk.is_some();
            if settled && (state.at_rest || order == MotionOrder::Resume) {
                return state;
            }
            assert!(self.now < until, "not at rest within 100 ms");
        }
    }
}

#[test]
fn motion_stop_halts_within_100_ms_also_on_a_full_disk_and_the_pick_resumes() {
    let moments = [(0, 0.3), (1, 1.5), (2, 2.2), (3, 2.9), (4, 3.6), (5, 5.0), (0, 6.4), (2, 8.5)];
    for ((object, after_s), is_full) in moments.into_iter().flat_map(|it| [(it, false), (it, true)])
    {
        let mut machine = Machine::new(config());
        machine.act(pick(1, object));
        machine.run(after_s);
        if is_full {
            machine.disk_fails();
            machine.run(0.03);
        }
        let state = machine.order_by_socket(MotionOrder::Stop);
        assert!(state.stopped && state.durable != is_full, "{state:?}");
        let posture = machine.robot.posture();
        machine.run(1.0);
        assert_eq!(machine.robot.posture(), posture, "object {object} after {after_s} s");
        machine.disk_is_back();
        machine.run(0.02);
        assert!(machine.order_by_socket(MotionOrder::Stop).durable);
        assert_eq!((machine.status().stopped, machine.status().moving), (1, 0));
        machine.awaits_release();
        assert!(!machine.order_by_socket(MotionOrder::Resume).stopped);
        machine.delivers(1, object);
        machine.run_until("at rest", Machine::rests);
        assert_eq!(machine.status().stopped, 0);
        assert!(is_full || machine.robot.grasps() == 1);
    }
}

#[test]
fn on_a_full_disk_no_phase_begins_and_the_pick_goes_on_when_there_is_space() {
    for after_s in [0.0, 0.5, 2.0, 3.0, 4.0, 5.0, 7.0] {
        let mut machine = Machine::new(config());
        machine.robot.expect_only_picks();
        machine.act(pick(1, 2));
        machine.run(after_s);
        machine.disk_fails();
        machine.run(30.0);
        let (posture, joints) = (machine.robot.posture(), machine.joints.len());
        machine.run(10.0);
        assert_eq!(machine.robot.posture(), posture, "it waits; disk full after {after_s} s");
        let joints = machine.joints.len() - joints;
        assert!(joints.abs_diff(1000) < 20, "{joints} joint states in 10 s");
        let (records, outputs) = machine.waiting_for_disk.as_ref().unwrap();
        assert!(records.len() < 8 && outputs.len() < 8, "{} {}", records.len(), outputs.len());
        machine.disk_is_back();
        machine.delivers(1, 2);
        assert_eq!(machine.robot.grasps(), 1);
    }
}

#[test]
fn nothing_begins_that_is_not_durable_however_slow_the_disk_and_whenever_killed() {
    for seed in 0..24 {
        let mut random = Rng::new(seed);
        let object = random.below(OBJECTS.into()) as u16;
        let mut machine = Machine::new(config_at(10.0));
        machine.robot.expect_only_picks();
        machine.act(pick(1, object));
        let until = machine.now + Span::from_s(120.0);
        while !(machine.outcome() == PickOutcome::Delivered && machine.rests()) {
            assert!(machine.now < until, "seed {seed}: stuck; {:?}", machine.node.state());
            match random.below(40) {
                0..8 => machine.disk_fails(),
                8..30 => machine.disk_is_back(),
                30 if random.below(3) == 0 => {
                    machine.now = machine.now + Span::from_ms(200);
                    machine.restart();
                }
                _ => {}
            }
            machine.go(None);
        }
        machine.disk_is_back();
        machine.assert_delivered(1, object);
    }
}
