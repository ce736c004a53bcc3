//! What was handed over is put back in its place, once, whatever happens on the way.

use super::*;
use messages::Task;

/// Returns the policy's order to put back what that interaction delivered.
fn put_back(interaction: u64, object: u16) -> RobotAct {
    let (act, kind) = (interaction * 10 + 5, ActKind::PutBack.code());
    RobotAct { act, kind, attempt: 2, ..pick(interaction, object) }
}

fn key(interaction: u64) -> PickId {
    PickId { interaction: InteractionId(interaction), attempt: 2 }
}

/// Returns a machine that has handed over that object.
fn delivered(config: Config, object: u16) -> Machine {
    let mut machine = Machine::new(config);
    machine.act(pick(1, object));
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine
}

/// The object stands in its place, put there once.
fn assert_put_back(machine: &Machine, object: u16) {
    let state = machine.node.state();
    assert_eq!((machine.outcome(), state.held), (PickOutcome::PutBack, None));
    assert!(!state.gone.contains(&ObjectId(object)));
    assert_eq!(machine.entered(key(1), PickPhase::Holding), 1, "one grasp that holds");
    assert_eq!(machine.entered(key(1), PickPhase::Done), 1, "one end");
    machine.robot.assert_well_behaved();
}

fn ends_put_back(machine: &mut Machine) {
    machine.run_until("put back", |m| m.outcome() == PickOutcome::PutBack);
    machine.run_until("at rest", Machine::rests);
}

#[test]
fn every_bowl_goes_back_to_its_place() {
    for object in 0..OBJECTS {
        let mut config = config_at(5.0);
        config.arm.restock = false;
        let mut machine = delivered(config, object);
        machine.act(put_back(1, object));
        machine.reaches(PickPhase::Holding);
        assert_eq!(machine.node.state().held.map(|held| held.object), Some(ObjectId(object)));
        machine.run_until("put back", |m| m.outcome() == PickOutcome::PutBack);
        // What is durable is seen with the next pass.
        machine.go(None);
        let carried = machine.worlds.iter().filter(|world| world.held == Some(object));
        let [.., last] =
            &carried.map(|it| it.objects[usize::from(object)].unwrap()).collect::<Vec<_>>()[..]
        else {
            panic!("it was never carried")
        };
        let place = machine.config.scene.object(ObjectId(object)).placement.unwrap();
        let now = machine.worlds.last().unwrap().objects[usize::from(object)].unwrap();
        for axis in 0..3 {
            assert!((last[axis] - place.xyz[axis]).abs() < 0.05, "released at its place: {last:?}");
            assert!((now[axis] - place.xyz[axis]).abs() < 1e-9);
        }
        assert_eq!(machine.status().task, Task::PutBack);
        machine.run_until("at rest", Machine::rests);
        assert_eq!(machine.robot.grasps(), 2);
        assert_put_back(&machine, object);
        // It can be fetched again, and nothing is left to be put back after that but this.
        machine.act(pick(2, object));
        machine.delivers(2, object);
    }
}

/// A simulated world restocks what was handed over; who asks for it to be put back has it all the same.
#[test]
fn an_object_that_was_restocked_is_put_back_all_the_same() {
    let mut machine = delivered(config_at(20.0), 2);
    machine.run_until("at rest", Machine::rests);
    machine.run(0.2);
    assert!(machine.node.state().gone.is_empty(), "restocked");
    machine.act(put_back(1, 2));
    machine.run_until("ordered", |m| m.phase() != PickPhase::Done);
    assert_eq!(machine.node.state().gone, [ObjectId(2)]);
    ends_put_back(&mut machine);
    assert_put_back(&machine, 2);
}

#[test]
fn remaining_seconds_count_down_to_the_release() {
    let mut machine = delivered(config_at(2.0), 1);
    machine.act(put_back(1, 1));
    machine.reaches(PickPhase::Moving);
    machine.run(0.1);
    let (promised, at) = (machine.status().remaining_s, machine.now);
    machine.run_until("put back", |m| m.outcome() == PickOutcome::PutBack);
    let took = machine.now.since(at).s();
    assert!((promised - took).abs() < 0.4, "promised {promised} s, took {took} s");
}

/// Putting back with deaths anywhere in it, and now and then a motion stop.
fn story(seed: u64, restart: fn(&mut Machine)) {
    let mut random = Rng::new(seed);
    let object = random.below(OBJECTS.into()) as u16;
    let mut machine = delivered(config_at(10.0), object);
    machine.act(put_back(1, object));
    let is_over = |m: &Machine| m.outcome() == PickOutcome::PutBack && m.rests();
    machine.endures((seed, &mut random, 30), restart, is_over);
    assert_put_back(&machine, object);
}

#[test]
fn killed_anywhere_the_arm_puts_it_back_once() {
    for seed in 0..16 {
        story(seed, Machine::restart_from_journal);
        story(100 + seed, Machine::restart);
    }
}

#[test]
fn what_was_called_off_before_the_fingers_close_stays_with_the_user() {
    for phase in [PickPhase::Accepted, PickPhase::Moving] {
        let mut machine = delivered(config_at(5.0), 3);
        machine.act(put_back(1, 3));
        machine.reaches(phase);
        machine.act(RobotAct { act: 16, kind: ActKind::Cancel.code(), ..put_back(1, 3) });
        machine.run_until("called off", |m| m.outcome() == PickOutcome::Cancelled);
        assert_eq!(machine.robot.grasps(), 1);
        machine.act(RobotAct { attempt: 3, act: 17, ..put_back(1, 3) });
        ends_put_back(&mut machine);
        machine.robot.assert_well_behaved();
    }
    let mut machine = delivered(config_at(5.0), 3);
    machine.act(put_back(1, 3));
    machine.reaches(PickPhase::Holding);
    machine.act(RobotAct { act: 16, kind: ActKind::Cancel.code(), ..put_back(1, 3) });
    ends_put_back(&mut machine);
    assert_put_back(&machine, 3);
}

#[test]
fn fingers_that_close_on_nothing_leave_it_with_the_user() {
    let mut machine = delivered(config_at(20.0), 3);
    machine.robot.miss(u32::MAX);
    machine.act(put_back(1, 3));
    machine.run_until("missed", |m| m.outcome() == PickOutcome::Missed);
    assert_eq!(machine.node.state().misses, machine.config.arm.grasp.attempts);
    machine.robot.miss(0);
    machine.act(RobotAct { attempt: 3, act: 17, ..put_back(1, 3) });
    ends_put_back(&mut machine);
    machine.robot.assert_well_behaved();
}

#[test]
fn nothing_that_was_not_handed_over_is_put_back() {
    let mut machine = delivered(config_at(20.0), 3);
    machine.act(put_back(1, 4));
    machine.run_until("refused", |m| m.outcome() == PickOutcome::Unreachable);
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn one_key_is_of_one_task() {
    let mut machine = delivered(config_at(20.0), 3);
    machine.act(RobotAct { attempt: 1, ..put_back(1, 3) });
    machine.run(2.0);
    assert_eq!(machine.outcome(), PickOutcome::Delivered);
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn another_scene_ends_putting_back() {
    for (phase, outcome) in [
        (PickPhase::Moving, PickOutcome::Cancelled),
        (PickPhase::Holding, PickOutcome::Interrupted),
    ] {
        let mut machine = delivered(config_at(10.0), 1);
        machine.act(put_back(1, 1));
        machine.reaches(phase);
        machine.act = None;
        machine.config.scene = markers();
        machine.restart_from_journal();
        assert_eq!((machine.phase(), machine.outcome()), (PickPhase::Done, outcome));
        assert!(machine.node.state().handed_over.is_empty());
    }
}
