//! Orders: accepted once, abandoned in time, rejected if infeasible.

use super::*;

#[test]
fn repeated_order_is_recognised_and_old_one_obsolete() {
    let mut machine = Machine::new(config_at(20.0));
    machine.act(pick(3, 1));
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine.run(3.0);
    machine.assert_delivered(3, 1);
    // As from a policy that was restored from an old copy.
    machine.node.act.id = messages::ActId(0);
    machine.act(pick(2, 4));
    machine.act(pick(3, 4));
    machine.run(3.0);
    assert_eq!(machine.node.state().pick.unwrap().object, ObjectId(1));
    assert_eq!(machine.robot.grasps(), 1);
}

#[test]
fn act_older_than_the_current_one_is_ignored() {
    let mut machine = Machine::new(config_at(20.0));
    machine.act(say(50));
    machine.run(0.05);
    machine.act(pick(1, 1));
    machine.run(0.5);
    assert_eq!(machine.phase(), PickPhase::Idle);
}

#[test]
fn pick_cancelled_before_closing_leaves_the_object() {
    for after_s in [0.001, 0.5, 2.0] {
        let mut machine = Machine::new(config());
        machine.act(pick(1, 4));
        machine.run(after_s);
        machine.act(cancel(1, 4));
        machine.run(0.05);
        assert_eq!(machine.outcome(), PickOutcome::Cancelled, "after {after_s} s");
        machine.run_until("at rest", Machine::rests);
        assert_eq!(machine.robot.grasps(), 0);
        machine.robot.assert_well_behaved();
    }
}

#[test]
fn pick_cancelled_before_its_order_never_starts() {
    let mut machine = Machine::new(config_at(20.0));
    machine.act(cancel(1, 4));
    machine.run(0.1);
    assert_eq!(machine.outcome(), PickOutcome::Cancelled);
    machine.node.act.id = messages::ActId(0);
    machine.act(pick(1, 4));
    machine.run(1.0);
    assert!(machine.rests());
    assert_eq!(machine.outcome(), PickOutcome::Cancelled);
}

#[test]
fn pick_cancelled_while_stopped_returns_after_the_release() {
    let mut machine = Machine::new(config_at(5.0));
    machine.act(pick(1, 0));
    machine.run(0.3);
    machine.motion(MotionOrder::Stop);
    machine.run(0.2);
    machine.act(cancel(1, 0));
    machine.run(1.0);
    assert_eq!(machine.outcome(), PickOutcome::Cancelled);
    assert!(!machine.rests());
    machine.motion(MotionOrder::Resume);
    machine.run_until("at rest", Machine::rests);
}

#[test]
fn arm_reports_an_unreachable_object_without_moving() {
    let mut config = config();
    let text = "name = \"far\"\nnoun = \"cup\"\n\
        [[attributes]]\nname = \"color\"\nvalues = [\"red\", \"blue\"]\n\
        [[objects]]\nname = \"away\"\nattributes = { color = \"red\" }\nxyz = [3.0, 0.0, 0.0]\n\
        size = [0.1, 0.1, 0.05]\ngrasp_width = 0.006\nform = \"hollow\"\n\
        [[objects]]\nname = \"nowhere\"\nattributes = { color = \"blue\" }\n";
    config.scene = scene::Scene::from_toml("far.toml", text).unwrap();
    let mut machine = Machine::new(config);
    for (interaction, object) in [(1, 0), (2, 1), (3, 7)] {
        machine.act(pick(interaction, object));
        machine.run(0.1);
        assert_eq!(
            (machine.phase(), machine.outcome()),
            (PickPhase::Done, PickOutcome::Unreachable)
        );
        assert_eq!(machine.status().interaction, interaction);
        assert!(machine.rests());
    }
    machine.act(point(40, 0));
    machine.run(0.5);
    assert!(machine.rests());
    assert_eq!(machine.robot.grasps(), 0);
}

#[test]
fn taken_object_stays_gone_after_a_restart() {
    let mut config = config_at(20.0);
    config.arm.restock = false;
    let mut machine = Machine::new(config);
    machine.act(pick(1, 3));
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine.run_until("at rest", Machine::rests);
    machine.restart_from_journal();
    machine.run(0.1);
    assert_eq!(machine.worlds.last().unwrap().objects[3], None);
    machine.act(pick(2, 3));
    machine.run(0.2);
    assert_eq!(machine.outcome(), PickOutcome::Unreachable);
    machine.act(pick(3, 2));
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine.run_until("at rest", Machine::rests);
    assert_eq!(machine.node.state().gone, [ObjectId(3), ObjectId(2)]);
}

/// The policy may be restarted with a changed scene before the arm is.
#[test]
fn act_of_another_scene_waits_until_the_arm_reloads() {
    let mut machine = Machine::new(config());
    let scene = markers();
    machine.act(RobotAct { scene_key: scene.key(), ..pick(1, 1) });
    machine.run(0.5);
    assert_eq!(machine.phase(), PickPhase::Idle, "object 1 of the other scene is not a bowl");
    machine.config.scene = scene;
    machine.restart_from_journal();
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
}

#[test]
fn arm_ignores_an_invalid_act() {
    let mut machine = Machine::new(config());
    let far = RobotAct { object: 70_000, act: 12, ..pick(1, 1) };
    machine.act(far);
    machine.run(0.5);
    assert_eq!(machine.phase(), PickPhase::Idle);
    assert!(machine.rests());
}
