//! Stops: the motion stop, the emergency stop, disabled motors.

use crate::world::World;
use messages::robot::DrillKind;
use messages::robot::Order;
use messages::{MotionInhibit, MotionOrder, PickPhase};
use service::{Span, Time};

/// Faster than this a joint moves, rad/s: ten deviations of the velocity's noise.
const MOVES_RAD_S: f64 = 0.05;

/// The first joint state from which on nothing moved.
fn still_from(world: &World) -> Time {
    let moves = |s: &&messages::robot::JointState| s.velocity.iter().any(|v| v.abs() > MOVES_RAD_S);
    let last = world.joint_states.iter().rev().find(moves).unwrap();
    Time(last.stamp_ns) + Span::from_ms(10)
}

#[test]
fn motion_stop_halts_within_100_ms() {
    let mut slowest = Span(0);
    for (object, after_s) in [(0, 5.0), (1, 5.7), (2, 6.3), (3, 7.1), (4, 8.0), (5, 9.5), (2, 11.0)]
    {
        let mut world = World::new(&[]);
        world.pick(1, object);
        world.run(after_s);
        let stopped = world.now;
        world.motion(MotionOrder::Stop);
        world.run(1.0);
        let took = still_from(&world).since(stopped);
        slowest = slowest.max(took);
        assert!(took <= Span::from_ms(100), "{} s for object {object}", took.s());
        assert_eq!((world.status().stopped, world.status().moving), (1, 0));
        let before = world.joint_states.len();
        world.run(1.0);
        assert!(still_from(&world) <= Time(world.joint_states[before].stamp_ns), "latched");
        world.motion(MotionOrder::Resume);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        world.assert_delivered_once();
    }
    assert!(slowest > Span::from_ms(20), "something was moving when it was stopped");
}

#[test]
fn emergency_stop_latches_and_the_pick_resumes_after_release() {
    let mut world = World::new(&[]);
    world.pick(1, 1);
    world.run_until("moving", |w| w.phase() == PickPhase::Moving);
    world.run(1.5);
    world.drill(DrillKind::PressEstop, 0.0);
    world.run_until("latched", |w| w.status().stopped == 1);
    assert_eq!(world.hindrance(), MotionInhibit::Stopped);
    let pressed = world.now;
    world.run(1.0);
    world.motion(MotionOrder::Resume);
    world.run(0.5);
    assert_eq!(world.status().stopped, 1, "the button is still pressed");
    world.drill(DrillKind::ReleaseEstop, 0.0);
    world.drill(DrillKind::Reset, 0.0);
    world.run(0.3);
    assert_eq!((world.status().stopped, world.hindrance()), (1, MotionInhibit::Disabled));
    assert_nothing_is_commanded_since(&world, pressed);
    world.drill(DrillKind::Enable, 0.0);
    world.run(1.0);
    assert_eq!(world.status().moving, 0, "it is latched");
    world.motion(MotionOrder::Resume);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    world.assert_delivered_once();
}

/// A release of the motion stop that was in force before must not lift that of the button.
#[test]
fn emergency_stop_is_another_stop_than_the_one_in_force() {
    let mut world = World::new(&[]);
    world.run(0.5);
    world.motion(MotionOrder::Stop);
    world.run(0.3);
    let seen = world.status().stop();
    world.drill(DrillKind::PressEstop, 0.0);
    world.run_until("the button's stop", |w| w.hindrance() == MotionInhibit::Stopped);
    world.run(0.3);
    assert!(world.status().stop() > seen, "{} after {seen}", world.status().stop());
}

fn assert_nothing_is_commanded_since(world: &World, since: Time) {
    let late = since + Span::from_ms(20);
    let commands = |order: &Order<'_>| matches!(order, Order::Joints(..) | Order::Gripper(..));
    let found = world.orders.iter().find(|(at, order)| *at > late && commands(order));
    assert!(found.is_none(), "{found:?}");
}

#[test]
fn arm_halts_on_disabled_motors_and_faults_and_goes_on_only_after_a_release() {
    for (fault, repairs) in [
        (DrillKind::Disable, vec![DrillKind::Enable]),
        (DrillKind::Fail, vec![DrillKind::Reset, DrillKind::Enable]),
    ] {
        for phase in [PickPhase::Moving, PickPhase::Closing, PickPhase::Holding] {
            let mut world = World::new(&[]);
            world.pick(1, 5);
            world.run_until("under way", |w| w.phase() == phase);
            world.run(0.4);
            world.drill(fault, 0.0);
            world.run(0.1);
            let off = world.now;
            world.run(1.5);
            assert_eq!((world.status().stopped, world.status().moving), (1, 0));
            assert_nothing_is_commanded_since(&world, off);
            repairs.iter().for_each(|repair| world.drill(*repair, 0.0));
            world.run(1.0);
            assert_eq!((world.hindrance(), world.status().moving), (MotionInhibit::None, 0));
            world.motion(MotionOrder::Resume);
            world.run_until("over", |w| w.phase() == PickPhase::Done);
            world.assert_delivered_once();
        }
    }
}
