//! A pick that is called off while the object is held: it goes back to its place, whatever happens on the
//! way.

use super::*;
use crate::world::World;
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
    assert!(machine.entered(key(1), PickPhase::Holding) <= 1, "one grasp that holds");
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
fn an_object_on_which_the_fingers_close_stays_in_its_place() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Closing);
    let limb = machine.node.state().limb.unwrap();
    machine.act(cancel(1, OBJECT));
    machine.run_until("called off", |m| m.outcome() == PickOutcome::Cancelled);
    assert_back(&machine, OBJECT);
    assert_eq!(machine.robot.grasps(), 0, "nothing was lifted");
    let open = machine.robot.posture().width_m[limb];
    machine.run_until("at rest", Machine::rests);
    assert!(machine.robot.posture().width_m[limb] <= open + 1e-6, "open before the gripper rose");
}

/// A grasp that is tried again holds nothing meanwhile.
#[test]
fn between_two_grasps_nothing_is_left_to_put_back() {
    let mut machine = Machine::new(config());
    machine.robot.miss(1);
    machine.act(pick(1, OBJECT));
    machine.run_until("missed", |m| m.node.state().misses == 1);
    machine.run(0.3);
    machine.act(cancel(1, OBJECT));
    machine.run_until("called off", |m| m.outcome() == PickOutcome::Cancelled);
    assert_eq!(machine.entered(key(1), PickPhase::Returning), 0);
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
}

/// The gripper is where it hands the object over, and has not begun to open.
#[test]
fn an_object_that_has_arrived_goes_back_while_the_gripper_is_closed() {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    let arrived = |m: &Machine| m.node.state().is_letting_go();
    while !arrived(&machine) {
        machine.go(None);
    }
    // The record that the fingers open is lost.
    let lost = machine.journal.iter().position(|record| record.state.is_letting_go()).unwrap();
    machine.journal.truncate(lost);
    machine.act = None;
    machine.restart();
    machine.act(cancel(1, OBJECT));
    goes_back(&mut machine, OBJECT);
}

#[test]
fn an_object_of_which_the_gripper_lets_go_is_handed_over() {
    for stops in [false, true] {
        let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
        machine.run_until("fingers open", |m| m.node.state().is_letting_go());
        if stops {
            machine.motion(MotionOrder::Stop);
            machine.run(0.5);
            machine.restart();
        }
        machine.act(cancel(1, OBJECT));
        machine.run(0.5);
        machine.motion(MotionOrder::Resume);
        machine.delivers(1, OBJECT);
    }
}

/// How a fetch ends that is called off, in the order of the moments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Left,
    Returned,
    Delivered,
}

/// Calls a fetch off `after_s` after its order, and kills the arm `kill_s` after that, if at all. Whatever
/// is delivered was let go of by an earlier record.
fn called_off_after(after_s: f64, kill_s: Option<f64>, death: Death) -> End {
    let mut machine = Machine::new(config());
    machine.robot.expect_only_picks();
    machine.act(pick(1, OBJECT));
    machine.run(after_s);
    let is_late = machine.journal.iter().any(|record| record.state.is_letting_go());
    machine.act(cancel(1, OBJECT));
    if let Some(kill_s) = kill_s {
        machine.run(kill_s);
        machine.go(Some(death));
        machine.now = machine.now + Span::from_ms(200);
        machine.restart();
        // The bus hands the standing act to whoever joins.
        machine.act(cancel(1, OBJECT));
    }
    let what = format!("{after_s} s, killed {kill_s:?}");
    machine.run_until(&what, |m| m.phase() == PickPhase::Done);
    let end = match machine.outcome() {
        PickOutcome::Delivered => {
            assert!(is_late, "{what}: handed over after it was called off");
            machine.assert_delivered(1, OBJECT);
            End::Delivered
        }
        PickOutcome::Cancelled => {
            assert!(!is_late, "{what}: not handed over, though the fingers had opened");
            let returned = machine.entered(key(1), PickPhase::Returning);
            assert_eq!(machine.node.state().held, None, "{what}");
            if returned == 0 { End::Left } else { End::Returned }
        }
        outcome => panic!("{what}: {outcome:?}"),
    };
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
    end
}

/// Seconds from the order to the end of a fetch.
fn fetch_s() -> f64 {
    let mut machine = Machine::new(config());
    let begun = machine.now;
    machine.act(pick(1, OBJECT));
    machine.delivers(1, OBJECT);
    machine.now.since(begun).s()
}

/// Every moment of a fetch, in steps of 50 ms.
fn moments() -> impl Iterator<Item = f64> {
    let steps = (fetch_s() / 0.05) as u32;
    (0..steps).map(|step| 0.05 * f64::from(step))
}

#[test]
fn at_every_moment_it_is_left_or_goes_back_until_the_gripper_opens() {
    let ends: Vec<End> =
        moments().map(|after_s| called_off_after(after_s, None, Death::Seen)).collect();
    assert!(ends.is_sorted(), "{ends:?}");
    for end in [End::Left, End::Returned, End::Delivered] {
        let count = ends.iter().filter(|it| **it == end).count();
        assert!(count > 5, "{count} of {} moments: {end:?}", ends.len());
    }
}

/// A kill in the pass that takes the order, and later, at each point of a pass.
#[test]
fn at_every_moment_the_same_holds_of_an_arm_that_is_killed() {
    let deaths = [Death::Unsynced, Death::Unseen, Death::Seen];
    for (n, after_s) in moments().enumerate() {
        let kill_s = [0.0, 0.05, 0.4][n / 3 % 3];
        called_off_after(after_s, Some(kill_s), deaths[n % 3]);
    }
}

/// Returns a machine whose arm keeps the object that was called off after `after_s` of its transport.
fn keeping(after_s: f64) -> Machine {
    let mut machine = Machine::picking(config(), OBJECT, PickPhase::Holding);
    machine.run(after_s);
    let world = std::mem::replace(
        &mut machine.node.world,
        Arc::new(World::unknown(&machine.config.setup.robot)),
    );
    machine.act(cancel(1, OBJECT));
    machine.reaches(PickPhase::Done);
    machine.node.world = world;
    assert_keeps(&mut machine);
    machine
}

/// The arm stands and holds the object.
fn assert_keeps(machine: &mut Machine) {
    assert_eq!(machine.outcome(), PickOutcome::Kept);
    let posture = machine.robot.posture();
    machine.run(2.0);
    assert_eq!(machine.robot.posture(), posture, "it holds still");
    assert_eq!(machine.node.state().held.map(|held| held.object), Some(ObjectId(OBJECT)));
    machine.robot.assert_well_behaved();
}

#[test]
fn without_a_way_back_the_gripper_keeps_hold_until_a_word() {
    for after_s in [0.0, 0.5, 1.0, 1.5, 2.0] {
        let mut machine = keeping(after_s);
        // Neither a release of the motion stop nor a kill is a word.
        machine.motion(MotionOrder::Stop);
        machine.run(0.2);
        machine.motion(MotionOrder::Resume);
        assert_keeps(&mut machine);
        machine.restart();
        assert_keeps(&mut machine);
        machine.act(RobotAct { attempt: 2, act: 12, ..pick(1, OBJECT) });
        machine.run_until("handed over", |m| m.outcome() == PickOutcome::Delivered);
        machine.run_until("at rest", Machine::rests);
        assert_eq!(machine.robot.grasps(), 1, "{after_s} s");
        machine.robot.assert_well_behaved();
    }
}

#[test]
fn what_is_kept_goes_back_once_there_is_a_way() {
    let mut machine = keeping(1.0);
    machine.act(RobotAct { attempt: 2, act: 12, ..cancel(1, OBJECT) });
    machine.run_until("called off", |m| m.outcome() == PickOutcome::Cancelled);
    let state = machine.node.state();
    assert_eq!((state.held, state.gone.is_empty()), (None, true));
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
}

#[test]
fn the_gripper_drops_nothing_that_it_keeps_for_another_order() {
    let other = (OBJECT + 1) % OBJECTS;
    for act in [RobotAct { act: 20, ..pick(2, other) }, cancel(2, other)] {
        let mut machine = keeping(1.0);
        let posture = machine.robot.posture();
        machine.act(act);
        machine.run_until("judged", |m| m.outcome() == PickOutcome::Interrupted);
        machine.run(1.0);
        assert_eq!(machine.robot.posture(), posture);
        // A person has taken it out.
        machine.act(RobotAct { act: 30, ..pick(3, other) });
        machine.delivers(3, other);
    }
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
        let is_over = |m: &Machine| m.phase() == PickPhase::Done && m.rests();
        machine.endures((seed, &mut random, 20), Machine::restart, is_over);
        match machine.outcome() {
            PickOutcome::Delivered => machine.assert_delivered(1, object),
            _ if machine.entered(key(1), PickPhase::Returning) == 0 => {
                assert_eq!(machine.outcome(), PickOutcome::Cancelled, "seed {seed}");
            }
            _ => {
                back += 1;
                assert_back(&machine, object);
            }
        }
        assert!(machine.robot.grasps() <= 1, "seed {seed}");
    }
    assert!(back >= 20, "{back} of 40 went back");
}
