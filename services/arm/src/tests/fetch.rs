//! Each of the six bowls is brought, within the limits, and time says how long it takes.

use super::*;
use manipulation::{Limb, Robot as Description};
use messages::JOINT_STATE_LEN;

#[test]
fn every_bowl_is_handed_over_and_restocked() {
    for object in 0..OBJECTS {
        let mut machine = Machine::new(config());
        machine.act(pick(1, object));
        let begun = machine.now;
        machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
        let seconds = machine.now.since(begun).s();
        assert!((4.0..12.0).contains(&seconds), "object {object} took {seconds} s");
        assert_eq!(machine.node.state().gone, [ObjectId(object)]);
        machine.run_until("at rest", Machine::rests);
        machine.run(0.3);
        assert_eq!(machine.status().moving, 0);
        assert!(machine.node.state().gone.is_empty(), "put back");
        assert_eq!(machine.robot.grasps(), 1);
        machine.assert_delivered(1, object);
        assert_published_within_limits(&machine.joints);
    }
}

/// Joints never leave their limits, nor move faster than theirs from one joint state to the next.
fn assert_published_within_limits(states: &[JointStates]) {
    let limits = Description::baxter().arm(Limb::Left).limits;
    for pair in states.windows(2) {
        let seconds = (pair[1].at_ns - pair[0].at_ns) as f64 / 1e9;
        for entry in 0..JOINT_STATE_LEN {
            let Some(j) = joint_of(entry) else { continue };
            let (lower, upper) = limits.position.0[j];
            let q = pair[1].position[entry];
            assert!((lower..=upper).contains(&q));
            let fastest = 0.6 * limits.velocity[j] * (1.0 + 1e-6);
            let speed = (q - pair[0].position[entry]).abs() / seconds;
            assert!(speed <= fastest, "joint {j} at {speed} rad/s over {seconds} s");
            assert!(pair[1].velocity[entry].abs() <= fastest);
        }
    }
}

fn joint_of(entry: usize) -> Option<usize> {
    let name = messages::JOINT_STATE_NAMES[entry].split_once('_')?.1;
    manipulation::JOINTS.iter().position(|joint| *joint == name)
}

#[test]
fn published_velocities_are_the_slope_of_the_positions() {
    let mut machine = Machine::new(config_at(3.0));
    machine.act(pick(1, 0));
    machine.run(0.6);
    let mut moved = false;
    for triple in machine.joints.windows(3) {
        let seconds = (triple[2].at_ns - triple[0].at_ns) as f64 / 1e9;
        for entry in 0..JOINT_STATE_LEN {
            let slope = (triple[2].position[entry] - triple[0].position[entry]) / seconds;
            let velocity = triple[1].velocity[entry];
            moved |= velocity.abs() > 0.5;
            // Accelerations of 1.2 rad/s², nine times that at threefold speed, over 10 ms.
            assert!((slope - velocity).abs() < 0.25, "{slope} and {velocity} rad/s");
        }
    }
    assert!(moved);
}

#[test]
fn grasped_object_moves_with_the_gripper() {
    let mut machine = Machine::picking(config_at(5.0), 4, PickPhase::Holding);
    let placed = machine.worlds.last().unwrap().objects[4].unwrap();
    machine.reaches(PickPhase::Done);
    // What is durable is seen with the next pass.
    machine.go(None);
    let held = machine.worlds.iter().filter(|world| world.held == Some(4));
    let poses: Vec<[f64; 7]> = held.map(|world| world.objects[4].unwrap()).collect();
    let place = machine.config.scene.object(ObjectId(4)).placement.unwrap();
    for axis in 0..3 {
        assert!((poses[0][axis] - placed[axis]).abs() < 1e-6, "it is taken where it stands");
        assert!((placed[axis] - place.xyz[axis]).abs() < 1e-6);
    }
    let last = poses.last().unwrap();
    assert!(last[2] > 0.0, "it is lifted and carried: {last:?}");
    assert_eq!(machine.worlds.last().unwrap().objects[4], None, "the person has it");
}

#[test]
fn fast_time_brings_the_same_sooner() {
    let mut machine = Machine::new(config_at(60.0));
    machine.act(pick(1, 2));
    let begun = machine.now;
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    assert!(machine.now.since(begun).s() < 0.3);
    machine.run_until("at rest", Machine::rests);
    machine.assert_delivered(1, 2);
}

#[test]
fn remaining_seconds_count_down() {
    let mut machine = Machine::picking(config_at(2.0), 1, PickPhase::Moving);
    machine.run(0.1);
    let (promised, at) = (machine.status().remaining_s, machine.now);
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    let took = machine.now.since(at).s();
    // The status is up to 250 ms old, and every phase may wait for one more pass.
    assert!((promised - took).abs() < 0.3, "promised {promised} s, took {took} s");
    machine.go(None);
    assert_eq!(machine.status().remaining_s, 0.0);
}

#[test]
fn picks_follow_one_another() {
    let mut machine = Machine::new(config_at(20.0));
    for (interaction, object) in [(1, 5), (2, 0), (3, 0), (4, 3)] {
        machine.act(pick(interaction, object));
        let delivered = move |m: &Machine| {
            m.node.state().pick.is_some_and(|pick| pick.id.interaction.0 == interaction)
                && m.outcome() == PickOutcome::Delivered
        };
        machine.run_until("delivered", delivered);
        machine.assert_delivered(interaction, object);
    }
    machine.run_until("at rest", Machine::rests);
    assert_eq!(machine.robot.grasps(), 4);
}
