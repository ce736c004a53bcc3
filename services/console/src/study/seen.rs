//! What the study sees of the robot.

use messages::WireCode;
use messages::{ArmStatus, PickPhase, PolicyView};
use scene::Scene;
use service::status::Actual;
use service::status::GroupStatus;

/// Services without which no interaction can go on.
const NEEDED: [&str; 4] = ["speech", "grounding", "policy", "arm"];

/// The robot at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    /// Milliseconds since 1970.
    pub(super) at: u64,
    /// Milliseconds of the monotonic clock.
    pub(super) ms: f64,
    /// The scene in force.
    pub(super) scene: &'a Scene,
    /// What the policy thinks, once it was heard.
    pub(super) view: Option<&'a PolicyView>,
    /// A service that is needed and not ready.
    pub(super) missing: Option<&'a str>,
    /// Whether the arm moves or is stopped.
    pub(super) arm_is_busy: bool,
    /// Whether the policy is being switched, or still to be given back.
    pub(super) is_switching: bool,
}

/// Why an interaction cannot begin yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Hindrance {
    /// A service is not ready, or nothing was heard of the policy yet.
    Service(String),
    /// The policy decides by another planner than it should.
    Planner,
    /// A dialogue stands, or the arm moves.
    Busy,
}

impl Hindrance {
    /// Its name on the wire.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Service(_) => "service",
            Self::Planner => "planner",
            Self::Busy => "busy",
        }
    }
}

impl Seen<'_> {
    /// What hinders an interaction with that planner from beginning.
    pub(super) fn hindrance(&self, planner: &str) -> Option<Hindrance> {
        if let Some(name) = self.missing {
            return Some(Hindrance::Service(name.to_owned()));
        }
        let Some(view) = self.view else { return Some(Hindrance::Service("policy".to_owned())) };
        match () {
            () if view.planner != planner || self.is_switching => Some(Hindrance::Planner),
            () if view.interaction != 0 || self.arm_is_busy => Some(Hindrance::Busy),
            () => None,
        }
    }

    /// The number of the robot's latest interaction, open or ended; 0 where there was none.
    pub(super) fn latest_interaction(&self) -> u64 {
        let ended = |view: &PolicyView| view.last.as_ref().map_or(0, |last| last.interaction.0);
        self.view.map_or(0, |view| view.interaction.max(ended(view)))
    }

    /// The scene's key as the data has it.
    pub(super) fn scene_key(&self) -> String {
        format!("{:016x}", self.scene.key())
    }
}

/// A service that is needed and not ready; the supervisor's silence hinders nothing.
pub(super) fn missing(group: Option<&GroupStatus>) -> Option<&str> {
    let services = group.into_iter().flat_map(|group| &group.services);
    let mut needed = services.filter(|service| NEEDED.contains(&service.name.as_str()));
    needed.find(|service| service.actual != Actual::Ready).map(|service| service.name.as_str())
}

/// Whether the arm moves or is stopped.
pub(super) fn arm_is_busy(arm: Option<&ArmStatus>) -> bool {
    let still = [PickPhase::Idle.code(), PickPhase::Done.code()];
    arm.is_some_and(|arm| !still.contains(&arm.phase) || arm.stopped != 0)
}
