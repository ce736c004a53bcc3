//! While a motion is being planned the arm accepts, publishes and stops as ever, and a plan that rests on
//! what was is not carried out.

use super::*;

/// Longer than any plan takes.
const LONG: Span = Span::from_ms(400);

/// Returns a machine whose plans take long, in the middle of the plan of its first order.
fn planning(object: u16) -> Machine {
    let mut machine = Machine::new(config_at(10.0));
    machine.planning_time = LONG;
    machine.act(pick(1, object));
    machine.run(0.1);
    assert_eq!(machine.planning.len(), 1, "one request");
    machine
}

/// Runs until every plan that was requested so far has come.
fn all_plans_come(machine: &mut Machine) {
    machine.planning_time = PLANNING;
    machine.run(LONG.s());
}

#[test]
fn order_is_accepted_durably_before_it_is_planned() {
    let mut machine = Machine::new(config());
    machine.run(0.1);
    machine.planning_time = LONG;
    machine.act(pick(1, 2));
    machine.go(None);
    assert_eq!(machine.journal.last().unwrap().state.open_pick().unwrap().object, ObjectId(2));
    assert_eq!(machine.planning.len(), 1);
    machine.go(None);
    assert_eq!(machine.status().phase, PickPhase::Accepted);
    machine.planning_time = PLANNING;
    machine.delivers(1, 2);
}

#[test]
fn nothing_is_planned_before_its_order_is_durable() {
    let mut machine = Machine::new(config());
    machine.disk_fails();
    machine.act(pick(1, 2));
    machine.run(0.1);
    assert!(machine.planning.is_empty());
    machine.disk_is_back();
    assert_eq!(machine.planning.len(), 1);
    machine.delivers(1, 2);
}

#[test]
fn joint_states_continue_while_the_arm_plans() {
    let mut machine = planning(0);
    let (published, from) = (machine.joints.len(), machine.now);
    while machine.phase() == PickPhase::Accepted {
        machine.go(None);
    }
    assert!(machine.now.since(from) > Span::from_ms(200));
    let intervals = machine.joints[published..].windows(2);
    let longest = intervals.map(|pair| pair[1].at_ns - pair[0].at_ns).max();
    assert!(longest <= Some(Span::from_ms(11).0), "{longest:?} ns");
}

#[test]
fn motion_stop_counts_while_the_arm_plans() {
    let mut machine = planning(3);
    machine.motion(MotionOrder::Stop);
    machine.go(None);
    machine.go(None);
    assert_eq!((machine.status().stopped, machine.status().moving), (1, 0));
    all_plans_come(&mut machine);
    assert!(machine.rests(), "a plan that comes after the stop is not begun");
    assert_eq!(machine.phase(), PickPhase::Accepted);
    machine.motion(MotionOrder::Resume);
    machine.delivers(1, 3);
}

#[test]
fn plan_of_a_cancelled_order_is_not_begun() {
    let mut machine = planning(3);
    machine.act(cancel(1, 3));
    all_plans_come(&mut machine);
    assert_eq!(machine.outcome(), PickOutcome::Cancelled);
    assert!(machine.rests());
    machine.act(pick(2, 4));
    machine.delivers(2, 4);
}

#[test]
fn later_order_is_planned_in_the_place_of_an_earlier_one() {
    let mut machine = planning(3);
    machine.act(cancel(1, 3));
    machine.run(0.05);
    machine.act(pick(2, 5));
    machine.run(0.05);
    assert_eq!(machine.planning.len(), 2, "the first result is on its way as well");
    machine.delivers(2, 5);
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn plan_from_where_the_arm_was_is_not_begun() {
    let mut machine = planning(2);
    for limb in Limb::BOTH {
        machine.robot.push(limb, 0.1);
    }
    machine.delivers(1, 2);
    machine.run_until("at rest", Machine::rests);
}

#[test]
fn arm_killed_while_it_plans_plans_again() {
    for restart in [Machine::restart, Machine::restart_from_journal] {
        let mut machine = planning(1);
        restart(&mut machine);
        assert_eq!(machine.phase(), PickPhase::Accepted);
        machine.delivers(1, 1);
        assert_eq!(machine.robot.grasps(), 1);
    }
}
