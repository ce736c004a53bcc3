//! A pick that is called off while the object is held: it goes back to its place, whatever happens on the
//! way.

use super::*;
use crate::world::World;
use dialogue::Rng;
use std::sync::Arc;

const OBJECT: u16 = 4;

fn key(attempt: u32) -> PickId {
    PickId { interaction: InteractionId(1), attempt }
}

/// The object stands in its place, and the gripper that held it is empty.
fn assert_back(machine: &Machine, object: u16) {
    let state = machine.node.state();
    assert_eq!((machine.outcome(), state.held), (PickOutcome::Cancelled, None));
    assert!(!state.gone.contains(&ObjectId(object)) && state.handed_over.is_empty());
    assert_eq!(machine.entered(key(1), PickPhase::Holding), 1, "one grasp that holds");
    assert_eq!(machine.entered(key(1), PickPhase::Returning), 1, "it goes back once");
    assert_eq!(machine.entered(key(1), PickPhase::Done), 1, "one end");
    machine.robot.assert_well_behaved();
}

fn goes_back(machine: &mut Machine, object: u16) {
    machine.run_until("called off", |m| m.outcome() == PickOutcome::Cancelled);
    assert_back(machine, object);
    machine.run_until("at rest", Machine::rests);
}

#[test]
fn every_bowl_that_is_denied_in_the_gripper_goes_back_to_its_place() {
    for (object, after_s) in (0..OBJECTS).zip([0.05, 0.3, 0.6, 0.9, 1.2, 1.5]) {
        let mut machine = Machine::picking(config(), object, PickPhase::Holding);
        machine.run(after_s);
        machine.act(cancel(1, object));
        machine.reaches(PickPhase::Returning);
        machine.run_until("let go", |m| m.phase() == PickPhase::Done);
        machine.go(None);
        let carried = machine.worlds.iter().rfind(|world| world.held == Some(object)).unwrap();
        let carried = carried.objects[usize::from(object)].unwrap();
        let place = machine.config.scene.object(ObjectId(object)).placement.unwrap();
        let now = machine.worlds.last().unwrap().objects[usize::from(object)].unwrap();
        for axis in 0..3 {
            assert!((carried[axis] - place.xyz[axis]).abs() < 0.02, "let go at {carried:?}");
            assert!((now[axis] - place.xyz[axis]).abs() < 1e-9);
        }
        goes_back(&mut machine, object);
        assert_eq!(machine.robot.grasps(), 1);
        // Another one is fetched in the same interaction, and this one in the next.
        let other = (object + 1) % OBJECTS;
        machine.act(RobotAct { attempt: 2, act: 12, ..pick(1, other) });
        machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
        machine.run_until("at rest", Machine::rests);
        machine.act(pick(2, object));
        machine.delivers(2, object);
    }
}

#[test]
fn an_object_on_which_the_fingers_close_goes_back_once_they_hold_it() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Closing);
    machine.act(cancel(1, OBJECT));
    goes_back(&mut machine, OBJECT);
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn an_object_that_has_arrived_is_handed_over() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    let releases = |m: &Machine| {
        let step = m.node.executor.program().and_then(|program| program.steps.front());
        step.is_some_and(|step| step.kind == messages::MotionPhase::Release)
    };
    machine.run_until("fingers open", releases);
    machine.act(cancel(1, OBJECT));
    machine.delivers(1, OBJECT);
}

#[test]
fn a_motion_stop_on_the_way_back_keeps_hold_of_the_object() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    machine.run(1.0);
    machine.act(cancel(1, OBJECT));
    machine.reaches(PickPhase::Returning);
    machine.run(0.8);
    machine.motion(MotionOrder::Stop);
    machine.run(0.2);
    let posture = machine.robot.posture();
    machine.run(1.0);
    assert_eq!(machine.robot.posture(), posture);
    assert_eq!(machine.node.state().held.map(|held| held.object), Some(ObjectId(OBJECT)));
    machine.motion(MotionOrder::Resume);
    goes_back(&mut machine, OBJECT);
}

/// Called off while the motion stop is latched, it goes back after the release.
#[test]
fn a_denial_while_stopped_is_obeyed_after_the_release() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    machine.run(1.0);
    machine.motion(MotionOrder::Stop);
    machine.run(0.5);
    machine.act(cancel(1, OBJECT));
    machine.run(1.0);
    assert_eq!(machine.phase(), PickPhase::Returning);
    machine.motion(MotionOrder::Resume);
    goes_back(&mut machine, OBJECT);
}

#[test]
fn without_a_way_back_the_gripper_keeps_hold_and_a_person_is_asked() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    machine.run(1.0);
    machine.act(cancel(1, OBJECT));
    machine.reaches(PickPhase::Returning);
    machine.node.world = Arc::new(World::unknown(&machine.config.setup.robot));
    machine.reaches(PickPhase::Done);
    let state = machine.node.state();
    assert_eq!((machine.outcome(), state.waits_for_person), (PickOutcome::Interrupted, true));
    assert_eq!(state.held.map(|held| held.object), Some(ObjectId(OBJECT)));
    let posture = machine.robot.posture();
    machine.run(2.0);
    assert_eq!(machine.robot.posture(), posture, "it holds still");
    machine.robot.assert_well_behaved();
}

#[test]
fn an_object_that_was_dropped_is_left_to_a_person() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    machine.run(1.0);
    machine.act(cancel(1, OBJECT));
    machine.reaches(PickPhase::Returning);
    machine.robot.drop_object();
    machine.restart();
    machine.reaches(PickPhase::Done);
    assert_eq!(machine.outcome(), PickOutcome::Interrupted);
}

/// Killed at any point, with motion stops between, it ends in its place or with the user, never elsewhere.
#[test]
fn killed_at_any_point_it_goes_back_once() {
    let mut back = 0;
    for seed in 0..40 {
        let mut random = Rng::new(seed);
        let object = random.below(OBJECTS.into()) as u16;
        let mut machine = Machine::picking(config_at(10.0), object, PickPhase::Closing);
        machine.robot.expect_only_picks();
        machine.run(0.01 * random.below(25) as f64);
        machine.act(cancel(1, object));
        let (mut left, mut stopped) = (6, false);
        let until = machine.now + Span::from_s(60.0);
        while !(machine.phase() == PickPhase::Done && machine.rests()) {
            assert!(machine.now < until, "seed {seed}: stuck; {:?}", machine.node.state());
            if random.below(if stopped { 30 } else { 150 }) == 0 {
                stopped = !stopped;
                machine.motion(if stopped { MotionOrder::Stop } else { MotionOrder::Resume });
            }
            if left > 0 && random.below(20) == 0 {
                left -= 1;
                let death = [Death::Unsynced, Death::Unseen, Death::Seen][random.below(3)];
                machine.go(Some(death));
                stopped = machine.journal.last().is_some_and(|record| record.state.stopped);
                machine.now = machine.now + Span::from_ms(200);
                machine.restart();
            } else {
                machine.go(None);
            }
        }
        match machine.outcome() {
            PickOutcome::Delivered => machine.assert_delivered(1, object),
            _ => {
                back += 1;
                assert_back(&machine, object);
            }
        }
        assert!(machine.robot.grasps() == 1, "seed {seed}");
    }
    assert!(back >= 20, "{back} of 40 went back");
}
