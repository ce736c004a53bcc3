//! Recovery of an open pick that does not move, after a restart or after a
//! motion stop. It depends on durable facts and sensors alone, never on what the arm did
//! last in memory.

use crate::Config;
use crate::state::{ArmState, Record};
use manipulation::{Limb, OUTSIDE_MAX_RAD};
use messages::pick::Pick;
use messages::{PickOutcome, PickPhase};
use scene::Scene;
use service::NodeError;

/// Next action of an open pick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// Take the object: fetch it, or go where the user gives it back. Nothing has been grasped, so
    /// closing (again) is not a second grasp.
    Take,
    /// Bring the held object to the person, or to its place.
    Carry,
    /// Open the fingers: the gripper is there.
    Release,
    /// Stop and report an interruption: a person must check.
    Interrupt,
}

/// Decision table. `holding` is the gripper's sensor reading, `at_goal` whether the gripper is where
/// the object is let go: at the handover, or at its place.
pub fn next(phase: PickPhase, holding: Option<bool>, at_goal: bool) -> Next {
    match (phase, holding) {
        (PickPhase::Closing, Some(true)) => Next::Carry,
        (PickPhase::Closing, None) => Next::Interrupt,
        (PickPhase::Holding | PickPhase::Returning, _) if at_goal => Next::Release,
        (PickPhase::Holding | PickPhase::Returning, Some(false)) => Next::Interrupt,
        (PickPhase::Holding | PickPhase::Returning, _) => Next::Carry,
        _ => Next::Take,
    }
}

/// Returns the last state of the journal, or the initial state if it is empty.
///
/// # Errors
/// The journal's joint positions are too far outside the joint limits to be true.
pub fn state(config: &Config, mut records: Vec<Record>) -> Result<ArmState, NodeError> {
    let first =
        || ArmState::first(&config.setup.robot, config.scene.key(), config.setup.plan.open_percent);
    let state = records.pop().map_or_else(first, |record| record.state);
    let outside = Limb::BOTH.into_iter().find_map(|limb| {
        let q = state.posture.joints[limb];
        let clamped = config.setup.robot.arm(limb).chain.limits().clamp(&q);
        let plausible =
            q.iter().zip(&clamped).all(|(q, limit)| (q - limit).abs() <= OUTSIDE_MAX_RAD);
        (!plausible).then_some(q)
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
    next.handed_over.clear();
    next.offered = None;
    next.waits_for_person = false;
    next.pick =
        state.pick.map(|pick| Pick { outcome: outcome(&pick), phase: PickPhase::Done, ..pick });
    Some(next)
}

/// Returns the outcome of a pick whose scene was replaced.
fn outcome(pick: &Pick) -> PickOutcome {
    match pick.phase {
        PickPhase::Done => pick.outcome,
        PickPhase::Closing | PickPhase::Holding | PickPhase::Returning => PickOutcome::Interrupted,
        _ => PickOutcome::Cancelled,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovery_takes_before_a_grasp_carries_after_it_and_leaves_the_unknown_to_a_person() {
        use Next::{Carry, Interrupt, Release, Take};
        use PickPhase::{Accepted, Closing, Holding, Moving, Returning};
        for (phase, at_goal, expected) in [
            // With the gripper's sensor empty, holding and unknown.
            (Accepted, false, [Take, Take, Take]),
            (Moving, false, [Take, Take, Take]),
            (Closing, false, [Take, Carry, Interrupt]),
            (Closing, true, [Take, Carry, Interrupt]),
            (Holding, false, [Interrupt, Carry, Carry]),
            (Holding, true, [Release, Release, Release]),
            (Returning, false, [Interrupt, Carry, Carry]),
            (Returning, true, [Release, Release, Release]),
        ] {
            let found = [Some(false), Some(true), None].map(|own| next(phase, own, at_goal));
            assert_eq!(found, expected, "{phase:?} at the goal: {at_goal}");
        }
    }
}
