//! The state in the sections of the console's page (docs/console.md), so that the same views show it.

use dialogue::manager::{HandedOver, Interaction};
use dialogue::rendering;
use scene::view::{ObjectView, SceneView, objects};
use scene::{ObjectId, Question};
use serde::ser::{Serialize, SerializeMap, Serializer};
use vocabulary::ids::PickId;
use vocabulary::named::{ActionView, QuestionView};
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Outcome, PickOutcome, PickPhase, Presentation, Task};

use crate::Session;
use crate::transcript::Line;

/// What stays the same in a dialogue.
#[derive(serde::Serialize)]
pub(crate) struct SceneSections<'a> {
    scene: SceneView<'a>,
    further: Vec<ObjectView<'a>>,
}

/// What changes in a dialogue.
#[derive(serde::Serialize)]
pub(crate) struct Sections<'a> {
    dialogue: DialogueSection<'a>,
    arm: ArmSection<'a>,
    world: WorldSection,
    speaking: Option<SpeakingSection>,
    turn: TurnSection,
    lines: &'a [Line],
}

#[derive(serde::Serialize)]
struct DialogueSection<'a> {
    interaction: u64,
    applied: u64,
    belief: Belief<'a>,
    absent: f64,
    decision: ActKind,
    question: Option<QuestionView<&'a str>>,
    expects_answer: bool,
    prompt: u64,
    text: String,
    value: f64,
    planner: &'a str,
    bounds: Option<(f64, f64)>,
    alternatives: Vec<Alternative<'a>>,
    questions: u32,
    expected_questions: f64,
    last: Option<EndedSection<'a>>,
    refusable: Option<DeliverySection<'a>>,
}

/// Probability of each object, by name.
struct Belief<'a>(Vec<(&'a str, f64)>);

impl Serialize for Belief<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(Some(self.0.len()))?;
        for (name, probability) in &self.0 {
            map.serialize_entry(name, probability)?;
        }
        map.end()
    }
}

#[derive(serde::Serialize)]
struct Alternative<'a> {
    action: ActionView<&'a str>,
    value: f64,
}

#[derive(serde::Serialize)]
struct EndedSection<'a> {
    interaction: u64,
    object: Option<&'a str>,
    outcome: Outcome,
    questions: u32,
    seconds: f64,
}

#[derive(serde::Serialize)]
struct DeliverySection<'a> {
    interaction: u64,
    object: &'a str,
    until_ms: f64,
}

#[derive(serde::Serialize)]
struct ArmSection<'a> {
    interaction: u64,
    attempt: u32,
    object: Option<&'a str>,
    task: Task,
    phase: PickPhase,
    outcome: PickOutcome,
    moving: bool,
    stopped: bool,
    remaining_s: f64,
}

#[derive(serde::Serialize)]
struct WorldSection {
    /// Where each object of the section `scene` is, metres, frame `base`; null: a user has it.
    objects: Vec<Option<[f64; 3]>>,
    /// Which of them the gripper holds.
    held: Option<usize>,
    grippers: [[f64; 3]; 1],
}

#[derive(serde::Serialize)]
struct SpeakingSection {
    prompt: u64,
    presentation: u32,
    began_ms: f64,
    ended_ms: Option<f64>,
}

#[derive(serde::Serialize)]
struct TurnSection {
    state: &'static str,
}

impl Session {
    /// Returns the scene for the page.
    pub(crate) fn scene_sections(&self) -> SceneSections<'_> {
        let scene = self.scene();
        let placed: Vec<ObjectId> = scene.placed().collect();
        let others = scene.ids().filter(|object| !placed.contains(object));
        SceneSections {
            scene: SceneView::new(scene, &self.labels, &placed),
            further: objects(scene, &self.labels, others),
        }
    }

    /// Returns everything else that the page shows.
    pub(crate) fn sections(&self) -> Sections<'_> {
        let placed: Vec<ObjectId> = self.scene().placed().collect();
        Sections {
            dialogue: self.dialogue(),
            arm: self.arm_section(),
            world: WorldSection {
                objects: placed.iter().map(|it| self.arm.place_of(*it)).collect(),
                held: self.arm.held().and_then(|held| placed.iter().position(|it| *it == held)),
                grippers: [self.arm.gripper()],
            },
            speaking: self.speaking(),
            turn: TurnSection { state: self.turn() },
            lines: self.transcript.lines(),
        }
    }

    fn dialogue(&self) -> DialogueSection<'_> {
        let (scene, state) = (self.scene(), &self.state);
        let (open, act) = (state.open.as_ref(), &state.act);
        let belief = open.map_or_else(|| self.manager.prior(state), Interaction::belief);
        let names = scene.objects().iter().map(|object| object.name.as_str());
        let alternative = |(action, value): &(_, f64)| Alternative {
            action: ActionView::new(scene, *action),
            value: *value,
        };
        let question = self.manager.asked(state);
        let presented = self.voice.presented();
        DialogueSection {
            interaction: open.map_or(0, |open| open.id.0),
            applied: state.applied.0,
            belief: Belief(names.zip(belief.probabilities()).collect()),
            absent: 0.0,
            decision: act.kind,
            question: QuestionView::new(scene, question),
            expects_answer: question != Question::None && is_over(&presented, act.prompt.0),
            prompt: act.prompt.0,
            text: rendering::text(scene, act),
            value: act.value,
            planner: self.manager.planner(),
            bounds: act.bounds,
            alternatives: act.alternatives.iter().map(alternative).collect(),
            questions: open.map_or(0, |open| open.questions),
            expected_questions: act.expected_questions,
            last: state.ended.as_ref().map(|ended| EndedSection {
                interaction: ended.interaction.0,
                object: ended.name.as_deref(),
                outcome: ended.outcome,
                questions: ended.questions,
                seconds: ended.seconds,
            }),
            refusable: state
                .handed_over
                .as_ref()
                .filter(|_| open.is_none())
                .and_then(|it| self.delivery(it)),
        }
    }

    fn delivery(&self, handed_over: &HandedOver) -> Option<DeliverySection<'_>> {
        let until = handed_over.at + Span::from_s(self.manager.turns().refusal_s);
        Some(DeliverySection {
            interaction: handed_over.interaction.id.0,
            object: &self.scene().object(handed_over.object()?).name,
            until_ms: ms(until),
        })
    }

    fn arm_section(&self) -> ArmSection<'_> {
        let order = self.arm.order();
        let PickId { interaction, attempt } = order.map_or_else(PickId::default, |it| it.id);
        ArmSection {
            interaction: interaction.0,
            attempt,
            object: order.map(|it| self.scene().object(it.object).name.as_str()),
            task: order.map_or(Task::Fetch, |it| it.task),
            phase: order.map_or(PickPhase::Idle, |it| it.phase),
            outcome: order.map_or(PickOutcome::Pending, |it| it.outcome),
            moving: self.arm.moves(),
            stopped: self.arm.motion_stop().is_latched(),
            remaining_s: self.arm.remaining_s(),
        }
    }

    fn speaking(&self) -> Option<SpeakingSection> {
        let presented = self.voice.presented();
        (presented.prompt.0 != 0).then(|| SpeakingSection {
            prompt: presented.prompt.0,
            presentation: presented.number,
            began_ms: ms(presented.began),
            ended_ms: presented.ended.map(ms),
        })
    }

    /// Whose turn it is, in the words of the console's section `turn`.
    fn turn(&self) -> &'static str {
        let is_open = self.state.open.is_some();
        let is_fetching = self.arm.order().is_some_and(|order| order.phase != PickPhase::Done);
        if self.arm.motion_stop().is_latched() {
            "stopped"
        } else if self.voice.is_playing() {
            "speaking"
        } else if is_fetching || self.arm.moves() && !is_open {
            "moving"
        } else if is_open && self.state.act.kind == ActKind::Ask {
            "asked"
        } else {
            "idle"
        }
    }
}

/// Returns whether that prompt was said to its end.
fn is_over(presented: &Presentation, prompt: u64) -> bool {
    presented.prompt.0 == prompt && presented.complete
}

/// Milliseconds.
pub(crate) fn ms(at: Time) -> f64 {
    at.ns() as f64 / 1e6
}
