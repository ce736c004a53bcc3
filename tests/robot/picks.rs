//! Picks on the simulated Baxter, and the commands that it needs.

use crate::world::World;
use messages::robot::Order;
use messages::robot::{Command, DrillKind};
use messages::{MotionInhibit, PickOutcome, PickPhase};
use service::Span;

#[test]
fn robot_delivers_six_bowls_in_turn() {
    let mut world = World::new(&[]);
    for object in 0..6 {
        world.grasps = 0;
        world.pick(u64::from(object) + 1, object);
        world.run_until("taken on", |w| w.phase() != PickPhase::Done);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        assert_eq!(world.outcome(), PickOutcome::Delivered, "object {object}");
        assert_eq!(world.grasps, 1, "object {object}");
    }
    world.run_until("at rest", |w| w.status().moving == 0);
    assert_eq!(world.hindrance(), MotionInhibit::None);
}

#[test]
fn arm_fetches_in_every_scene_with_a_slow_and_noisy_robot() {
    for scene in ["markers", "tools"] {
        let slow = ("arm.simulated.lag_s", "0.08");
        let mut world =
            World::new(&[("group.scene", scene), slow, ("arm.simulated.noise_rad", "0.0006")]);
        world.pick(1, 1);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        world.assert_delivered_once();
    }
}

/// The robot's topics of a robot with one arm are those of the left limb.
#[test]
fn single_arm_of_six_joints_delivers_on_the_same_topics() {
    let single = [
        ("group.scene", "blocks"),
        ("arm.robot", "ur5e"),
        ("arm.hand_over_xyz", "[0.45, 0.42, 0.25]"),
        ("arm.table_z_m", "0.0"),
    ];
    let mut world = World::new(&single);
    for object in [0, 3, 7] {
        world.grasps = 0;
        world.pick(u64::from(object) + 1, object);
        world.run_until("taken on", |w| w.phase() != PickPhase::Done);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        assert_eq!(world.outcome(), PickOutcome::Delivered, "object {object}");
        assert_eq!(world.grasps, 1, "object {object}");
    }
    let named = |order: &Order| match order {
        Order::Joints(_, command) => command.joints().unwrap().len() == 6,
        _ => true,
    };
    assert!(world.orders.iter().all(|(_, order)| named(order)), "six joints are commanded");
}

#[test]
fn grippers_are_calibrated_before_any_motion() {
    let mut world = World::new(&[]);
    world.pick(1, 2);
    world.run_until("calibrating", |w| w.hindrance() == MotionInhibit::Calibrating);
    world.run_until("moving", |w| w.phase() == PickPhase::Moving);
    let words: Vec<Command> = gripper_commands(&world);
    assert!(words.len() >= 2 && words.iter().all(|word| *word == Command::Calibrate), "{words:?}");
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    world.assert_delivered_once();
}

fn gripper_commands(world: &World) -> Vec<Command> {
    let read = |(_, order): &(_, Order<'_>)| match order {
        Order::Gripper(_, message) => message.read().ok(),
        _ => None,
    };
    world.orders.iter().filter_map(read).collect()
}

#[test]
fn both_limbs_get_position_commands_at_100_hz() {
    let mut world = World::new(&[]);
    world.pick(1, 0);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    world.run(3.0);
    for times in &world.commanded {
        let gaps: Vec<Span> = times.windows(2).map(|w| w[1].since(w[0])).collect();
        assert!(gaps.iter().all(|gap| *gap <= Span::from_ms(20)), "{:?}", gaps.iter().max());
        let rate = gaps.len() as f64 / times.last().unwrap().since(times[0]).s();
        assert!((90.0..115.0).contains(&rate), "{rate} Hz");
    }
    for (_, order) in &world.orders {
        if let Order::Joints(limb, command) = order {
            assert_eq!(command.mode, 1, "position mode, never raw");
            let names = command.joints().unwrap();
            let own = manipulation::Limb::BOTH[*limb].joint_names();
            assert!(names.iter().map(|(name, _)| *name).eq(own.iter().map(String::as_str)));
        }
    }
}

#[test]
fn robot_without_feed_forward_arrives() {
    let mut world = World::new(&[("arm.baxter.feed_forward", "false")]);
    world.pick(1, 3);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    world.assert_delivered_once();
    let fed = |order: &Order<'_>| matches!(order, Order::FeedForward(..));
    assert!(!world.orders.iter().any(|(_, order)| fed(order)));
}

#[test]
fn arm_detects_a_speed_ratio_that_is_too_low() {
    let mut world = World::new(&[("arm.baxter.speed_ratio", "0.1")]);
    world.pick(1, 0);
    world.run_until("over", |w| w.phase() == PickPhase::Done);
    assert_eq!(world.outcome(), PickOutcome::Blocked);
    assert_eq!(world.grasps, 0);
}

#[test]
fn arm_retries_one_missed_grasp_and_reports_two() {
    for (misses, outcome) in [(1.0, PickOutcome::Delivered), (2.0, PickOutcome::Missed)] {
        let mut world = World::new(&[]);
        world.drill(DrillKind::Miss, misses);
        world.pick(1, 4);
        world.run_until("over", |w| w.phase() == PickPhase::Done);
        assert_eq!(world.outcome(), outcome);
        assert_eq!(world.grasps, u32::from(outcome == PickOutcome::Delivered));
        world.run_until("at rest", |w| w.status().moving == 0);
    }
}
