//! The state of the robot, as the study needs it.

use messages::{ArmStatus, PickPhase, PolicyView};
use scene::Scene;
use serde::Serialize;

/// The robot at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct RobotState<'a> {
    /// Milliseconds since 1970.
    pub(super) at: u64,
    /// Milliseconds of the monotonic clock.
    pub(super) ms: f64,
    /// The scene in force.
    pub(super) scene: &'a Scene,
    /// The policy's belief and decision.
    pub(super) view: Option<&'a PolicyView>,
    /// A required service that is not ready.
    pub(super) missing: Option<&'a str>,
    /// `true` if the arm moves or is stopped.
    pub(super) arm_is_busy: bool,
    /// `true` if the planner is being switched or is still to be restored.
    pub(super) is_switching: bool,
}

/// Reason why an interaction cannot begin yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum NotReady {
    /// A service is not ready, or the policy has published nothing yet.
    Service,
    /// The policy uses another planner.
    Planner,
    /// An interaction is open, or the arm moves.
    Busy,
}

impl RobotState<'_> {
    /// Returns what keeps an interaction with this planner from beginning.
    pub(super) fn not_ready(&self, planner: &str) -> Option<NotReady> {
        match self.view {
            Some(view) if self.missing.is_none() => match () {
                () if view.planner != planner || self.is_switching => Some(NotReady::Planner),
                () if view.interaction != 0 || self.arm_is_busy => Some(NotReady::Busy),
                () => None,
            },
            _ => Some(NotReady::Service),
        }
    }

    /// Returns the number of the latest interaction, open or ended; 0 for none.
    pub(super) fn latest_interaction(&self) -> u64 {
        let ended = |view: &PolicyView| view.last.as_ref().map_or(0, |last| last.interaction.0);
        self.view.map_or(0, |view| view.interaction.max(ended(view)))
    }

    /// Returns the scene's key as it is stored.
    pub(super) fn scene_key(&self) -> String {
        format!("{:016x}", self.scene.key())
    }
}

/// Returns whether the arm moves or is stopped.
pub(super) fn arm_is_busy(arm: Option<&ArmStatus>) -> bool {
    let still = [PickPhase::Idle, PickPhase::Done];
    arm.is_some_and(|arm| !still.contains(&arm.phase.get()) || arm.stopped != 0)
}
