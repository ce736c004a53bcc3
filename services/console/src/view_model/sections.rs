//! Sections of the page that only the console has: trajectory, speaking and turn. The scene is that
//! of [`scene::view`], the others are those of [`service::view`].

use messages::{MotionPhase, PresentationState, Presented, TrajectoryView, WorldView};
use scene::ObjectId;
use serde::Serialize;
use service::Time;

use super::prompts::Prompt;
use super::turn::{Actor, Turn, TurnState};
use crate::hub::ms;

/// The section `world`: the objects of the section `scene`, in its order; poses to a tenth of a
/// millimetre.
#[derive(Debug, Serialize)]
pub(super) struct WorldSection {
    objects: Vec<Option<[f64; 7]>>,
    held: Option<usize>,
    grippers: [[f64; 7]; 2],
}

impl WorldSection {
    pub(super) fn new(world: &WorldView, listed: &[ObjectId]) -> Self {
        let pose = |pose: [f64; 7]| pose.map(|number| (number * 1e4).round() / 1e4);
        Self {
            objects: listed.iter().map(|i| world.objects.get(i.index())?.map(pose)).collect(),
            held: world.held.and_then(|held| listed.binary_search(&ObjectId(held)).ok()),
            grippers: world.grippers.map(pose),
        }
    }
}

/// The section `trajectory`; places to a millimetre, times to a millisecond.
#[derive(Debug, Serialize)]
pub(super) struct TrajectorySection {
    pick: Option<String>,
    limb: &'static str,
    phases: Vec<Phase>,
    began_ms: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Phase {
    name: MotionPhase,
    points: Vec<[f64; 3]>,
    t_s: Vec<f64>,
}

impl TrajectorySection {
    /// Makes the section; `None` while no planned motion is under way.
    pub(super) fn new(trajectory: &TrajectoryView) -> Option<Self> {
        let digits = |number: f64| (number * 1e3).round() / 1e3;
        let phases = trajectory.phases.iter().map(|phase| Phase {
            name: phase.phase,
            points: phase.points_m.iter().map(|point| point.map(digits)).collect(),
            t_s: phase.t_s.iter().copied().map(digits).collect(),
        });
        let TrajectoryView { interaction, attempt, .. } = trajectory;
        (!trajectory.phases.is_empty()).then(|| Self {
            pick: (*interaction != 0).then(|| format!("{interaction}.{attempt}")),
            limb: if trajectory.limb == 0 { "left" } else { "right" },
            phases: phases.collect(),
            began_ms: (trajectory.began_ns != 0).then(|| ms(Time(trajectory.began_ns))),
        })
    }
}

/// The section `speaking`: the line that is being presented or was presented last.
#[derive(Debug, Serialize)]
pub(super) struct SpeakingSection<'a> {
    prompt: u64,
    presentation: u32,
    text: &'a str,
    url: Option<String>,
    began_ms: f64,
    ended_ms: Option<f64>,
    state: PresentationState,
}

impl<'a> SpeakingSection<'a> {
    pub(super) fn new(prompt: &'a Prompt, presented: &Presented, has_sound: bool) -> Self {
        let Presented { prompt: id, presentation, started_ns, ended_ns, state, .. } = *presented;
        Self {
            prompt: id,
            presentation,
            text: &prompt.text,
            url: has_sound.then(|| format!("/voice/line-{id}-{presentation}.wav")),
            began_ms: ms(Time(started_ns)),
            ended_ms: (ended_ns > 0).then(|| ms(Time(ended_ns))),
            state: state.get(),
        }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct TurnSection {
    who: Actor,
    state: TurnState,
    since_ms: f64,
    onset_ms: Option<f64>,
}

impl TurnSection {
    pub(super) fn new(turn: Turn, since: Time) -> Self {
        let Turn { who, state, onset } = turn;
        Self { who, state, since_ms: ms(since), onset_ms: onset.map(ms) }
    }
}
