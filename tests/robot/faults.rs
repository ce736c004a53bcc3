//! Faults of the robot, of its bridge, and of the arm's process.

use crate::world::World;
use messages::robot::DrillKind;
use messages::{MotionInhibit, MotionOrder, PickOutcome, PickPhase};
use service::Span;
use vocabulary::Rng;

#[test]
fn arm_halts_while_joint_states_are_stale() {
    for phase in [PickPhase::Moving, PickPhase::Closing, PickPhase::Holding] {
        let mut world = World::new(&[]);
        world.pick(1, 0);
        world.run_until("under way", |w| w.phase() == phase);
        world.run(0.3);
        let before = world.joint_states.len();
        world.drill(DrillKind::Silence, 1.0);
        world.run(0.9);
        assert_eq!(world.hindrance(), MotionInhibit::Stale);
        world.run_until("heard again", |w| w.joint_states.len() > before + 1);
        let heard = world.joint_states.last().unwrap().joints().unwrap();
        let fastest = heard.iter().map(|(_, [_, rad_s, _])| rad_s.abs()).fold(0.0, f64::max);
        assert!(fastest < 0.05, "{fastest} rad/s while nobody heard it");
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        world.assert_delivered_once();
    }
}

#[test]
fn arm_tolerates_the_loss_of_a_third_of_the_joint_states() {
    for seed in ["1", "2", "3"] {
        let loss = ("arm.simulated.loss", "0.33");
        let mut world = World::new(&[loss, ("arm.simulated.seed", seed)]);
        world.pick(1, 2);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        world.assert_delivered_once();
    }
}

#[test]
fn blocked_arm_halts_and_waits_for_a_operator() {
    let mut world = World::new(&[]);
    world.pick(1, 3);
    world.run_until("moving", |w| w.phase() == PickPhase::Moving);
    world.run(1.0);
    world.drill(DrillKind::Obstruct, 3.0);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    assert_eq!(world.outcome(), PickOutcome::Blocked);
    world.run(4.0);
    assert_eq!(world.status().moving, 0, "it waits for a person");
    world.motion(MotionOrder::Resume);
    world.run(0.1);
    world.pick(2, 3);
    world.run_until("delivered", |w| w.outcome() == PickOutcome::Delivered);
    assert_eq!(world.grasps, 1);
}

#[test]
fn arm_ends_a_pick_whose_goal_is_not_reached_in_time() {
    let over = [("arm.baxter.path_tolerance_rad", "1.0"), ("arm.baxter.goal_time_s", "0.3")];
    let mut world = World::new(&over);
    world.pick(1, 3);
    world.run_until("there", |w| w.phase() == PickPhase::Closing);
    let shortly_before = world.now - Span::from_ms(400);
    // The same story again, up to a little before the end of the approach.
    let mut world = World::new(&over);
    world.pick(1, 3);
    world.run_until("nearly there", |w| w.now >= shortly_before);
    assert_eq!(world.phase(), PickPhase::Moving);
    world.drill(DrillKind::Obstruct, 30.0);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    assert_eq!(world.outcome(), PickOutcome::Blocked);
    assert_eq!(world.grasps, 0);
}

#[test]
fn killed_arm_resumes_from_the_measured_posture() {
    for seed in 0..30 {
        let mut random = Rng::new(seed);
        let mut world = World::new(&[]);
        world.pick(1, (seed % 6) as u16);
        let mut kills = 0;
        while !(world.phase() == PickPhase::Done && world.status().moving == 0) {
            world.run(0.05 + 3.0 * random.uniform());
            if kills < 6 && world.phase() != PickPhase::Done {
                kills += 1;
                world.kill_arm();
                world.run(0.05 + 0.5 * random.uniform());
                world.start_arm();
            }
            assert!(world.now.ns() < 120_000_000_000, "seed {seed}: {:?}", world.arm_state());
        }
        assert_eq!(world.outcome(), PickOutcome::Delivered, "seed {seed}");
        world.assert_delivered_once();
    }
}

#[test]
fn pick_survives_a_restart_of_the_robot() {
    for seed in 0..12 {
        let mut random = Rng::new(seed);
        let mut world = World::new(&[]);
        world.pick(1, (seed % 6) as u16);
        for _ in 0..3 {
            world.run(3.0 * random.uniform());
            world.kill_robot();
            world.run(0.2 + 1.5 * random.uniform());
            world.start_robot();
        }
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        world.assert_delivered_once();
    }
}

#[test]
fn arm_waits_for_a_robot_that_starts_late() {
    let mut world = World::new(&[("arm.simulated.enabled", "false")]);
    world.kill_robot();
    world.pick(1, 1);
    world.run(1.0);
    assert_eq!(world.phase(), PickPhase::Accepted);
    world.kill_arm();
    world.start_arm();
    world.run(0.5);
    assert_eq!(world.hindrance(), MotionInhibit::Unheard);
    world.start_robot();
    world.run(0.5);
    assert_eq!(world.hindrance(), MotionInhibit::Disabled);
    world.drill(DrillKind::Enable, 0.0);
    world.run(2.0);
    assert_eq!((world.status().stopped, world.status().moving), (1, 0), "enabling moves nothing");
    world.motion(MotionOrder::Resume);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    world.assert_delivered_once();
}
