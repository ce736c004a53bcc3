//! The motion stop: at once, latched, and lifted only by its release.

use super::*;

/// Whether set points have ended is not what people beside the arm see.
#[test]
fn arm_that_is_measured_to_move_is_not_at_rest() {
    let mut machine = Machine::new(config());
    machine.act(pick(1, 1));
    machine.run(2.0);
    machine.robot.coast(true);
    machine.motion(MotionOrder::Stop);
    machine.run(3.0);
    assert_eq!((machine.status().stopped, machine.status().moving), (1, 1));
    machine.robot.coast(false);
    machine.run(0.1);
    assert_eq!((machine.status().stopped, machine.status().moving), (1, 0));
}

#[test]
fn from_beside_an_object_the_gripper_goes_straight_up_first() {
    for object in 0..OBJECTS {
        let mut machine = Machine::picking(config(), object, PickPhase::Closing);
        machine.run(0.3);
        machine.motion(MotionOrder::Stop);
        machine.run(0.1);
        let limb = machine.node.state().limb.unwrap();
        let tip = |m: &Machine| m.tip(limb).translation.vector;
        let place = machine.config.scene.object(ObjectId(object)).placement.unwrap();
        let (at, top_m) = (tip(&machine), place.xyz[2] + 0.5 * place.size[2]);
        machine.motion(MotionOrder::Resume);
        machine.run_until("above it", |m| {
            let now = tip(m);
            let aside_m = (now - at).xy().norm();
            assert!(aside_m < 0.002, "object {object}: {aside_m} m aside at {} m", now.z);
            now.z > top_m + 0.1
        });
        machine.delivers(1, object);
    }
}

#[test]
fn motion_stop_while_idle_is_latched_and_survives_a_restart() {
    let mut machine = Machine::new(config_at(10.0));
    machine.motion(MotionOrder::Stop);
    machine.run(0.05);
    assert_eq!(machine.status().stopped, 1);
    machine.restart_from_journal();
    machine.act(pick(1, 1));
    machine.run(2.0);
    assert_eq!(machine.phase(), PickPhase::Accepted);
    assert_eq!(machine.journal.last().unwrap().state.pick, machine.node.state().pick);
    assert!(machine.rests());
    machine.restart_from_journal();
    machine.run(1.0);
    assert!(machine.rests());
    machine.motion(MotionOrder::Resume);
    machine.delivers(1, 1);
}

#[test]
fn arm_applies_newer_motion_orders_only() {
    let mut machine = Machine::new(config());
    let now = machine.now.ns();
    machine.order(MotionOrder::Stop, now - 5);
    machine.run(0.02);
    assert!(machine.node.state().stopped);
    machine.order(MotionOrder::Resume, now - 9);
    machine.order(MotionOrder::Resume, now - 5);
    machine.order(MotionOrder::Resume, now + 3_600_000_000_000);
    machine.run(0.02);
    assert!(machine.node.state().stopped, "older, repeated, from the future");
    machine.order(MotionOrder::Resume, now - 4);
    machine.run(1.95);
    assert!(machine.node.state().stopped, "too soon after the stop");
    machine.order(MotionOrder::Stop, machine.now.ns());
    machine.run(1.95);
    machine.order(MotionOrder::Resume, machine.now.ns());
    machine.run(8.0);
    assert!(machine.node.state().stopped, "too soon after another one, and not later either");
    machine.order(MotionOrder::Resume, (machine.now - Span::from_ms(5_001)).ns());
    machine.run(0.02);
    assert!(machine.node.state().stopped, "given up by its giver");
    machine.order(MotionOrder::Resume, machine.now.ns());
    machine.run(0.02);
    assert!(!machine.node.state().stopped);
}

#[test]
fn release_of_an_earlier_stop_leaves_the_later_one_in_force() {
    let mut machine = Machine::new(config_at(10.0));
    machine.motion(MotionOrder::Stop);
    machine.run(0.05);
    let seen = machine.status().stop();
    machine.run(3.0);
    machine.motion(MotionOrder::Stop);
    machine.run(0.05);
    let later = machine.status().stop();
    assert!(later > seen, "{later} after {seen}");
    machine.awaits_release();
    for (stop, holds) in [(seen, true), (later, false)] {
        let release = StopOrder::new(MotionOrder::Resume, machine.now);
        machine.receive(StopOrder { stop, ..release });
        machine.run(0.05);
        assert_eq!(machine.node.state().stopped, holds, "release of {stop}");
        let answer = machine.stop_states.last().unwrap();
        assert_eq!((answer.stop, answer.stopped), (machine.status().stop(), holds));
    }
    assert_eq!(machine.status().stop(), StopId(0));
    // Only releases are of a stop.
    machine.receive(StopOrder { stop: seen, ..StopOrder::new(MotionOrder::Stop, machine.now) });
    machine.run(0.05);
    assert!(machine.node.state().stopped);
}

#[test]
fn motion_stop_from_the_future_is_obeyed_and_can_be_released() {
    let mut machine = Machine::new(config());
    machine.order(MotionOrder::Stop, u64::MAX);
    machine.run(0.02);
    assert!(machine.node.state().stopped);
    machine.motion(MotionOrder::Resume);
    machine.run(0.02);
    assert!(!machine.node.state().stopped);
}

#[test]
fn motion_orders_of_an_earlier_boot_have_no_precedence() {
    let mut machine = Machine::new(config());
    machine.motion(MotionOrder::Stop);
    machine.run(0.02);
    machine.now = Time(1_000);
    machine.restart_from_journal();
    assert!(machine.node.state().stopped, "the latch itself stays");
    machine.motion(MotionOrder::Resume);
    machine.run(0.02);
    assert!(!machine.node.state().stopped);
}

#[test]
fn arm_resumes_after_its_process_was_suspended() {
    let mut machine = Machine::new(config());
    machine.act(pick(1, 0));
    machine.run(1.0);
    let before = machine.robot.posture();
    machine.now = machine.now + Span::from_s(30.0);
    machine.go(None);
    let moved: f64 = (0..2)
        .flat_map(|limb| (0..7).map(move |j| (limb, j)))
        .map(|(l, j)| (machine.robot.posture().joints[l][j] - before.joints[l][j]).abs())
        .fold(0.0, f64::max);
    assert!(moved < 0.2, "{moved} rad at once");
    machine.delivers(1, 0);
}
