//! Grasps that miss are tried again from above, as often as is configured, and an arm that is killed
//! in between finds the world as it was.

use super::*;
use crate::state::Cause;

/// Opening of the gripper that fetches the object: the right one.
fn open_m(config: &Config) -> f64 {
    config.setup.robot.arm(Limb::Right).gripper.open_m
}

/// Objects stand so far beside their places that about every other grasp misses.
fn inaccurate(attempts: u32) -> Config {
    let mut config = config_at(20.0);
    let rim_m = config.scene.object(ObjectId(1)).placement.unwrap().grasp_width;
    // Half of what is normally distributed lies within 0.6745 standard deviations.
    config.arm.grasp.error_m = 0.5 * (open_m(&config) - rim_m) / 0.6745;
    config.arm.grasp.attempts = attempts;
    config
}

#[test]
fn arm_retries_a_missed_grasp_from_above() {
    let mut machine = Machine::new(config_at(10.0));
    machine.robot.miss(1);
    machine.act(pick(1, 3));
    machine.run_until("missed", |m| m.node.state().misses == 1);
    let limb = machine.node.state().limb.unwrap();
    let height = |m: &Machine| m.tip(limb).translation.z;
    let low = height(&machine);
    machine.run_until("above the object", |m| height(m) > low + 0.1);
    assert_eq!(machine.phase(), PickPhase::Closing, "no phase is taken back");
    machine.delivers(1, 3);
    machine.run_until("at rest", Machine::rests);
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn grasps_succeed_as_often_as_the_model_says_and_every_story_has_an_end() {
    const STORIES: u64 = 60;
    let mut delivered = 0;
    for interaction in 1..=STORIES {
        let mut machine = Machine::new(inaccurate(1));
        machine.act(pick(interaction, 1));
        machine.reaches(PickPhase::Done);
        match machine.outcome() {
            PickOutcome::Delivered => delivered += 1,
            other => assert_eq!(other, PickOutcome::Missed),
        }
        machine.robot.assert_well_behaved();
    }
    let p = 0.5;
    let expected = p * STORIES as f64;
    let deviation = (expected * (1.0 - p)).sqrt();
    let off = (f64::from(delivered) - expected).abs();
    assert!(off < 3.0 * deviation, "{delivered} of {STORIES}, {expected} expected");
}

#[test]
fn killed_arm_finds_the_object_in_the_same_place() {
    for interaction in 1..=12 {
        let mut outcomes = Vec::new();
        for kills in [false, true] {
            let mut machine = Machine::new(inaccurate(3));
            machine.act(pick(interaction, 1));
            if kills {
                machine.reaches(PickPhase::Closing);
                machine.restart_from_journal();
                machine.run(0.05);
                machine.restart_from_journal();
            }
            machine.reaches(PickPhase::Done);
            let missed = machine.journal.iter().filter(|r| r.cause == Cause::Missed).count();
            outcomes.push((machine.outcome(), machine.node.state().misses, missed));
            machine.robot.assert_well_behaved();
        }
        assert_eq!(outcomes[0], outcomes[1], "interaction {interaction}");
    }
}
