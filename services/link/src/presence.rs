//! Presence of a robot in lists, and its first message to mirrors.

use messages::{ArmStatus, PickPhase, PolicyView};
use roster::Presence;
use scene::Scene;
use serde::{Deserialize, Serialize};
use service::Span;

/// Interval of a robot's presence messages.
pub const PRESENCE_EVERY: Span = Span::from_ms(5_000);

/// First message to a mirror.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// The robot's version of whichone.
    pub version: String,
    /// Epoch of the group.
    pub epoch: u64,
    /// Settings in force of the group.
    pub settings: String,
}

/// Adds the last statements of the policy and the arm.
pub fn add(
    presence: &mut Presence,
    view: Option<&PolicyView>,
    status: Option<&ArmStatus>,
    scene: &Scene,
) {
    if let Some(view) = view {
        let is_open = view.interaction > 0;
        presence.dialogue = if is_open { view.decision.name() } else { "idle" }.to_owned();
        presence.line.clone_from(&view.text);
        presence.likeliest = is_open.then(|| likeliest(view, scene)).flatten();
    }
    if let Some(status) = status {
        let phase = status.phase.get();
        let is_at_rest = matches!(phase, PickPhase::Idle | PickPhase::Done);
        presence.arm =
            if is_at_rest { "rest".to_owned() } else { format!("{phase:?}").to_lowercase() };
        presence.stopped = status.stopped != 0;
    }
}

fn likeliest(view: &PolicyView, scene: &Scene) -> Option<(String, f64)> {
    let all = view.belief.iter().copied().enumerate();
    let (place, share) = all.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    // Objects of perception have numbers; their names are not in the scene's file.
    let name = match view.objects.get(place) {
        Some(number) => format!("object {}", number.0),
        None => scene.objects().get(place)?.name.clone(),
    };
    Some((name, share))
}
