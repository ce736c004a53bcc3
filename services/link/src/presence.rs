//! What a list of robots shows of one, and what a mirror needs to know of it.

use messages::{ArmStatus, PickPhase, PolicyView};
use scene::Scene;
use serde::{Deserialize, Serialize};
use service::Span;

/// Interval at which a robot says that it is there.
pub const PRESENCE_EVERY: Span = Span::from_ms(5_000);

/// A robot in a few words.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Presence {
    /// Its name.
    pub robot: String,
    /// Its version of whichone.
    pub version: String,
    /// State of its group, as `whichone status` shows it; empty while its supervisor does not answer.
    pub state: String,
    /// The scene.
    pub scene: String,
    /// What the dialogue is at: `idle`, or the kind of the standing decision (`ask`, `pick` …).
    pub dialogue: String,
    /// The question that stands, or the robot's last line; empty for none.
    pub line: String,
    /// The likeliest object and its probability, while an interaction is open.
    pub likeliest: Option<(String, f64)>,
    /// What the arm does: the phase of its pick; `rest` for none.
    pub arm: String,
    /// Whether the motion stop is latched.
    pub stopped: bool,
}

/// What a mirror begins with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// The robot's version of whichone.
    pub version: String,
    /// Epoch of its group.
    pub epoch: u64,
    /// Its settings in force.
    pub settings: String,
}

impl Presence {
    /// Adds what the policy and the arm have said last.
    #[must_use]
    pub fn with(
        mut self,
        view: Option<&PolicyView>,
        status: Option<&ArmStatus>,
        scene: &Scene,
    ) -> Self {
        if let Some(view) = view {
            let is_open = view.interaction > 0;
            self.dialogue = if is_open { view.decision.name() } else { "idle" }.to_owned();
            self.line.clone_from(&view.text);
            self.likeliest = is_open.then(|| likeliest(view, scene)).flatten();
        }
        if let Some(status) = status {
            let phase = status.phase.get();
            let is_at_rest = matches!(phase, PickPhase::Idle | PickPhase::Done);
            self.arm =
                if is_at_rest { "rest".to_owned() } else { format!("{phase:?}").to_lowercase() };
            self.stopped = status.stopped != 0;
        }
        self
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
