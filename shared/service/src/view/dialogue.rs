use messages::{ActKind, Delivery, Outcome, PolicyView, Presented};
use scene::Scene;
use serde::ser::{Serialize, Serializer};
use vocabulary::Attributed;
use vocabulary::named::{ActionView, QuestionView, options};

use super::ms;
use crate::Time;

/// Belief and decision of the policy.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DialogueView<'a> {
    /// The open interaction, 0 for none.
    pub interaction: u64,
    /// Name of the person whose interaction it is; empty if the speaker is unnamed.
    pub from: &'a str,
    /// Highest utterance that is part of it.
    pub applied: u64,
    /// Probability of each object, by name, in the scene's order.
    #[serde(serialize_with = "map")]
    pub belief: Vec<(&'a str, f64)>,
    /// Probability that the wanted object is not here.
    pub absent: f64,
    /// User model learnt by the robot.
    pub person: Option<UserView>,
    /// Kind of the decision in force.
    pub decision: ActKind,
    /// The question in force; `None` if it is of another scene.
    pub question: Option<QuestionView<&'a str>>,
    /// Whether that question has been put to its end and waits for an answer.
    pub expects_answer: bool,
    /// Answers that fit it, while one is expected.
    pub options: Vec<&'a str>,
    /// Prompt of the robot's latest line, 0 for none.
    pub prompt: u64,
    /// The robot's latest line.
    pub text: &'a str,
    /// Expected discounted return of the decision.
    pub value: f64,
    /// Name of the planner that decides.
    pub planner: &'a str,
    /// Certified lower and upper bound on the best policy's value.
    pub bounds: Option<(f64, f64)>,
    /// The best other actions.
    pub alternatives: Vec<AlternativeView<'a>>,
    /// The questions that the latest utterance was attributed to.
    pub attributed: &'a Attributed,
    /// Questions asked in the open interaction.
    pub questions: u32,
    /// Expected number of further questions.
    pub expected_questions: f64,
    /// The latest interaction that has ended.
    pub last: Option<EndedView<'a>>,
    /// The latest delivery, while it can be refused.
    pub refusable: Option<DeliveryView<'a>>,
}

/// User model learnt by the robot.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct UserView {
    /// Probability that a question is answered.
    pub p_l: f64,
    /// Probability that an answer is wrong.
    pub epsilon: f64,
}

/// An action that the planner has weighed.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct AlternativeView<'a> {
    /// The action.
    pub action: ActionView<&'a str>,
    /// Expected discounted return of the alternative.
    pub value: f64,
}

/// The end of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct EndedView<'a> {
    /// Number of the interaction.
    pub interaction: u64,
    /// Name of the object that was picked or tried.
    pub object: Option<&'a str>,
    /// Outcome of the interaction.
    pub outcome: Outcome,
    /// Questions that were asked.
    pub questions: u32,
    /// Time from the first utterance to the end, seconds.
    pub seconds: f64,
}

/// A hand-over that can be refused for a while.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct DeliveryView<'a> {
    /// Number of the interaction that ended with it.
    pub interaction: u64,
    /// Name of the object.
    pub object: &'a str,
    /// End of the time for a refusal, milliseconds of the monotonic clock.
    pub until_ms: f64,
}

impl<'a> DialogueView<'a> {
    /// Makes the view of the policy's publication; objects by their names in `scene`.
    pub fn new(scene: &'a Scene, view: &'a PolicyView, presented: &Presented) -> Self {
        let names = scene.objects().iter().map(|object| object.name.as_str());
        let expects_answer = view.open_question(presented).is_some();
        Self {
            interaction: view.interaction,
            from: &view.from,
            applied: view.applied,
            belief: names.zip(view.belief.iter().copied()).collect(),
            absent: view.absent,
            person: view.person.map(|(p_l, epsilon)| UserView { p_l, epsilon }),
            decision: view.decision,
            question: QuestionView::new(scene, view.question),
            expects_answer,
            options: if expects_answer { options(scene, view.question) } else { Vec::new() },
            prompt: view.prompt,
            text: &view.text,
            value: view.value,
            planner: &view.planner,
            bounds: view.bounds,
            alternatives: view
                .alternatives
                .iter()
                .map(|(action, value)| AlternativeView {
                    action: ActionView::new(scene, *action),
                    value: *value,
                })
                .collect(),
            attributed: &view.attributed,
            questions: view.questions,
            expected_questions: view.expected_questions,
            last: view.last.as_ref().map(|last| EndedView {
                interaction: last.interaction.0,
                object: last.name.as_deref(),
                outcome: last.outcome,
                questions: last.questions,
                seconds: last.seconds,
            }),
            refusable: view.refusable.and_then(|it| DeliveryView::new(scene, it)),
        }
    }
}

impl<'a> DeliveryView<'a> {
    /// Names the object; `None` if it is not of this scene.
    fn new(scene: &'a Scene, delivery: Delivery) -> Option<Self> {
        let Delivery { interaction, object, until_ns } = delivery;
        let object = scene.objects().get(usize::from(object))?;
        Some(Self { interaction, object: &object.name, until_ms: ms(Time(until_ns)) })
    }
}

fn map<S: Serializer, V: Serialize>(pairs: &[(&str, V)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}
