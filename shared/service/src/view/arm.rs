use messages::{ArmStatus, MotionInhibit, PickOutcome, PickPhase};
use scene::Scene;
use serde::Serialize;

use super::rounded;

/// State of the arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ArmView<'a> {
    /// The interaction that its pick belongs to, 0 for none.
    pub interaction: u64,
    /// The pick's attempt within the interaction.
    pub attempt: u32,
    /// Name of the object that it picks or picked.
    pub object: Option<&'a str>,
    /// Phase of the pick.
    pub phase: PickPhase,
    /// Outcome of the latest pick.
    pub outcome: PickOutcome,
    /// True if a joint moves.
    pub moving: bool,
    /// True if the motion stop is latched.
    pub stopped: bool,
    /// Condition that inhibits motion.
    pub hindrance: MotionInhibit,
    /// Time left until the pick is done, seconds.
    pub remaining_s: f64,
    /// True if it points at an object.
    pub aimed: bool,
}

impl<'a> ArmView<'a> {
    /// Makes the view of a status; objects by their names in `scene`.
    pub fn new(scene: &'a Scene, arm: &ArmStatus) -> Self {
        let object = scene.objects().get(arm.object as usize).filter(|_| arm.interaction != 0);
        Self {
            interaction: arm.interaction,
            attempt: arm.attempt,
            object: object.map(|object| object.name.as_str()),
            phase: arm.phase.get(),
            outcome: arm.outcome.get(),
            moving: arm.moving != 0,
            stopped: arm.stopped != 0,
            hindrance: arm.hindrance.get(),
            remaining_s: rounded(arm.remaining_s, 1),
            aimed: arm.aimed_act != 0,
        }
    }
}
