//! Pointing: the gripper's axis passes through the object, and the status says for which question.

use super::*;
use messages::ActId;
use nalgebra::Vector3;

fn assert_aims(machine: &Machine, object: u16) {
    let place = machine.config.scene.object(ObjectId(object)).placement.unwrap();
    let misses = Limb::BOTH.map(|limb| {
        let gripper = machine.tip(limb);
        let axis = gripper.rotation * Vector3::z();
        let to = Vector3::from(place.xyz) - gripper.translation.vector;
        if to.dot(&axis) > 0.0 { to.cross(&axis).norm() } else { f64::INFINITY }
    });
    assert!(misses[0].min(misses[1]) < 0.002, "object {object} is missed by {misses:?} m");
}

#[test]
fn each_question_is_aimed_at_and_then_the_arm_rests() {
    let mut machine = Machine::new(config_at(10.0));
    for (act, object) in [(1, 0), (2, 1), (3, 2), (4, 5), (5, 3), (6, 4)] {
        machine.act(point(act, object));
        machine.run_until("aimed", |m| m.status().aimed_at() == Some(ActId(act)));
        assert_aims(&machine, object);
        let posture = machine.robot.posture();
        machine.run(0.5);
        assert_eq!(machine.robot.posture(), posture, "it keeps pointing");
        assert_eq!(machine.status().aimed_at(), Some(ActId(act)));
    }
    machine.act(say(7));
    machine.run(0.05);
    assert_eq!(machine.status().aimed_at(), None);
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
    assert!(machine.journal.iter().all(|record| record.state.pick.is_none()));
}

#[test]
fn repeated_pointing_question_needs_no_motion() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(point(1, 2));
    machine.run_until("aimed", |m| m.status().aimed_at() == Some(ActId(1)));
    let posture = machine.robot.posture();
    machine.act(point(2, 2));
    machine.run(0.02);
    assert_eq!(machine.status().aimed_at(), Some(ActId(2)));
    assert_eq!(machine.robot.posture(), posture);
}

#[test]
fn pick_starts_from_the_pointing_posture() {
    for (pointed, picked) in [(3, 3), (3, 0), (0, 2)] {
        let mut machine = Machine::new(config_at(10.0));
        machine.act(point(1, pointed));
        machine.run_until("aimed", |m| m.status().aimed_at().is_some());
        machine.act(pick(1, picked));
        machine.delivers(1, picked);
        machine.run_until("at rest", Machine::rests);
    }
}

#[test]
fn another_question_and_another_pick_may_come_under_way() {
    let mut machine = Machine::new(config_at(4.0));
    machine.act(point(1, 2));
    machine.run(0.2);
    machine.act(point(2, 0));
    machine.run(0.3);
    machine.act(point(3, 4));
    machine.run_until("aimed", |m| m.status().aimed_at() == Some(ActId(3)));
    assert_aims(&machine, 4);
    machine.act(point(4, 3));
    machine.run(0.2);
    machine.act(pick(1, 4));
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine.run(0.1);
    machine.act(pick(2, 5));
    machine.run_until("delivered", |m| {
        m.entered(PickId { interaction: InteractionId(2), attempt: 1 }, PickPhase::Done) == 1
    });
    machine.assert_delivered(1, 4);
    machine.assert_delivered(2, 5);
}

#[test]
fn arm_killed_while_pointing_points_again() {
    let mut machine = Machine::new(config_at(10.0));
    machine.act(point(1, 5));
    machine.run(0.1);
    machine.restart_from_journal();
    machine.run_until("aimed", |m| m.status().aimed_at() == Some(ActId(1)));
    assert_aims(&machine, 5);
    machine.restart();
    machine.run_until("aimed again", |m| m.status().aimed_at() == Some(ActId(1)));
    machine.motion(MotionOrder::Stop);
    machine.act(say(2));
    machine.run(1.0);
    assert!(!machine.rests(), "stopped");
    machine.motion(MotionOrder::Resume);
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
}

#[test]
fn arm_ignores_pointing_at_an_invalid_object() {
    let mut machine = Machine::new(config());
    machine.act(point(1, 99));
    machine.run(1.0);
    assert!(machine.rests());
    assert_eq!(machine.status().aimed_at(), None);
}
