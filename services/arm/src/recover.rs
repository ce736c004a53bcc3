//! Recovery of an open pick that does not move, after a restart or after a
//! motion stop. It depends on durable facts and sensors alone, never on what the arm did
//! last in memory.

use crate::Config;
use crate::state::{ArmState, Record};
use manipulation::Limb;
use messages::pick::Pick;
use messages::{PickOutcome, PickPhase};
use scene::Scene;
use service::NodeError;

/// Next action of an open pick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// Fetch the object from the present posture. Nothing has been grasped, so closing (again) is
    /// not a second grasp.
    Fetch,
    /// Bring the held object to the person.
    Deliver,
    /// Open the fingers: the gripper is at the handover.
    Release,
    /// Stop and report an interruption: a person must check.
    Interrupt,
}

/// Decision table. `holding` is the gripper's sensor reading, `at_hand_over` whether the gripper is
/// where objects are handed over.
pub fn next(phase: PickPhase, holding: Option<bool>, at_hand_over: bool) -> Next {
    match (phase, holding) {
        (PickPhase::Closing, Some(true)) => Next::Deliver,
        (PickPhase::Closing, None) => Next::Interrupt,
        (PickPhase::Holding, _) if at_hand_over => Next::Release,
        (PickPhase::Holding, Some(false)) => Next::Interrupt,
        (PickPhase::Holding, _) => Next::Deliver,
        _ => Next::Fetch,
    }
}

/// Returns the last state of the journal, or the initial state if it is empty.
///
/// # Errors
/// The journal's joint positions are outside the joint limits.
pub fn state(config: &Config, mut records: Vec<Record>) -> Result<ArmState, NodeError> {
    let first =
        || ArmState::first(&config.setup.robot, config.scene.key(), config.setup.plan.open_width_m);
    let state = records.pop().map_or_else(first, |record| record.state);
    let outside = Limb::BOTH.into_iter().find_map(|limb| {
        let q = state.posture.joints[limb];
        (!config.setup.robot.arm(limb).chain.limits().within(&q)).then_some(q)
    });
    match outside {
        None => Ok(state),
        Some(q) => Err(NodeError {
            what: format!("the journal has an arm at {q:?} rad, outside its joint limits"),
            help: "set it aside with `whichone journal set-aside arm`".to_owned(),
        }),
    }
}

/// Returns the state for a scene with other objects, if the journal's is of another scene. Its objects
/// and orders do not apply.
pub fn other_scene(state: &ArmState, scene: &Scene) -> Option<ArmState> {
    if state.scene_key == scene.key() {
        return None;
    }
    let mut next = ArmState { scene_key: scene.key(), held: None, ..state.clone() };
    next.gone.clear();
    next.waits_for_person = false;
    next.pick =
        state.pick.map(|pick| Pick { outcome: outcome(&pick), phase: PickPhase::Done, ..pick });
    Some(next)
}

/// Returns the outcome of a pick whose scene was replaced.
fn outcome(pick: &Pick) -> PickOutcome {
    match pick.phase {
        PickPhase::Done => pick.outcome,
        PickPhase::Closing | PickPhase::Holding => PickOutcome::Interrupted,
        _ => PickOutcome::Cancelled,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovery_fetches_before_a_grasp_delivers_after_it_and_leaves_the_unknown_to_a_person() {
        use Next::{Deliver, Fetch, Interrupt, Release};
        use PickPhase::{Accepted, Closing, Holding, Moving};
        for (phase, at_hand_over, expected) in [
            // With the gripper's sensor empty, holding and unknown.
            (Accepted, false, [Fetch, Fetch, Fetch]),
            (Moving, false, [Fetch, Fetch, Fetch]),
            (Closing, false, [Fetch, Deliver, Interrupt]),
            (Closing, true, [Fetch, Deliver, Interrupt]),
            (Holding, false, [Interrupt, Deliver, Deliver]),
            (Holding, true, [Release, Release, Release]),
        ] {
            let found = [Some(false), Some(true), None].map(|own| next(phase, own, at_hand_over));
            assert_eq!(found, expected, "{phase:?} at the hand over: {at_hand_over}");
        }
    }
}
