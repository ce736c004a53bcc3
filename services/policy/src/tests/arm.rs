//! Reactions of the policy to the arm's status.

use super::*;
use messages::Task;

#[test]
fn only_the_ordered_pick_s_end_ends_the_interaction() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let sure = words(&["small", "white", "plastic", "dishwasher", "dishwasher", "dishwasher"]);
    tell(&mut node, observation(1, 0, &sure), at(1));
    let (pick, object) = node.state().act.pick.expect("sure enough to pick");
    let done = |interaction| ArmStatus {
        interaction,
        attempt: pick.attempt,
        object: object.0.into(),
        phase: PickPhase::Done.code(),
        outcome: PickOutcome::Delivered.code(),
        ..ArmStatus::default()
    };
    assert!(tell(&mut node, In::Arm(done(pick.interaction.0 + 1)), at(2)).0.is_empty());
    assert_eq!(tell(&mut node, In::Arm(done(pick.interaction.0)), at(3)).0.len(), 1);
    assert!(tell(&mut node, In::Arm(done(pick.interaction.0)), at(4)).0.is_empty());
    assert_eq!(node.state().ended.as_ref().map(|e| e.object), Some(Some(object)));
}

#[test]
fn the_stop_is_heard_from_the_arm() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let status = |stopped| In::Arm(ArmStatus { stopped, ..ArmStatus::default() });
    assert_eq!(tell(&mut node, status(1), at(1)).0.len(), 1);
    assert!(node.state().stop.motion.is_latched());
    assert!(tell(&mut node, status(1), at(2)).0.is_empty());
    assert_eq!(tell(&mut node, status(0), at(3)).0.len(), 1);
    assert!(!node.state().stop.motion.is_latched());
}

#[test]
fn an_end_of_another_task_is_no_end() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    node.state = handed_over(&mut manager());
    node.state = remark(
        &mut manager(),
        &node.state,
        Reading { intent: Intent::PutBack, ..Reading::default() },
    );
    let (pick, ObjectId(object)) = node.state().ordered().expect("an order");
    let done = |outcome: PickOutcome| ArmStatus {
        interaction: pick.interaction.0,
        attempt: pick.attempt,
        object: object.into(),
        task: Task::PutBack.into(),
        phase: PickPhase::Done.into(),
        outcome: outcome.into(),
        ..ArmStatus::default()
    };
    let mut forged = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    forged.state = node.state.clone();
    tell(&mut forged, In::Arm(done(PickOutcome::Delivered)), at(9));
    assert!(text(forged.state()).starts_with("I was interrupted"), "{}", text(forged.state()));
    tell(&mut node, In::Arm(done(PickOutcome::PutBack)), at(9));
    assert_eq!(text(node.state()), "I have put the clear bowl back.");
}
