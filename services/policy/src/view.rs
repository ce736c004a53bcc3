//! The state as other services see it.

use dialogue::ids::UtteranceSeq;
use dialogue::manager::{Interaction, Manager, State};
use dialogue::{ActKind, rendering};
use messages::{Delivery, FixedText, PolicyView, RobotAct, WireCode};
use scene::{Question, Scene};
use service::Span;

/// Returns the standing decision as it is published.
pub(crate) fn act(scene: &Scene, state: &State) -> RobotAct {
    let act = &state.act;
    let interaction = act.pick.map_or(state.last_interaction, |(pick, _)| pick.interaction);
    RobotAct {
        act: act.id.0,
        scene_key: state.scene_key,
        interaction: interaction.0,
        prompt: act.prompt.0,
        presentation: act.presentation,
        kind: act.kind.code(),
        question: answerable(state).into(),
        object: act.pick.map_or(0, |(_, object)| object.0.into()),
        attempt: act.pick.map_or(0, |(pick, _)| pick.attempt),
        decided_ns: act.decided.ns(),
        utterance: act.utterance.0,
        text: FixedText::truncated(&rendering::text(scene, act)),
        ..RobotAct::default()
    }
}

/// Returns the question that waits for an answer: that of the act, or whether what was decided while
/// the motion stop was latched shall start.
fn asked(state: &State) -> Question {
    let act = &state.act;
    let confirmable = || state.confirmable(act.prompt).or_else(|| state.goes_back(act.prompt));
    let confirmable = (act.kind == ActKind::Say).then(confirmable).flatten();
    confirmable.map_or(act.question, Question::Point)
}

/// Returns the question as which the act's line can be answered: "I will get the white bowl" can be
/// denied like "this one?", also after the hand-over.
fn answerable(state: &State) -> Question {
    let act = &state.act;
    let deniable = match (act.kind, act.pick) {
        (ActKind::Pick | ActKind::PutBack, Some((_, object))) => Some(object),
        (ActKind::Say, _) => state.refusable(act.prompt),
        _ => None,
    };
    deniable.map_or_else(|| asked(state), Question::Point)
}

/// Returns what was handed over last, while it can be refused.
fn delivery(manager: &Manager, state: &State) -> Option<Delivery> {
    let handed_over = state.handed_over.as_ref().filter(|_| state.open.is_none())?;
    let window = Span::from_s(manager.turns().refusal_s);
    Some(Delivery {
        interaction: handed_over.interaction.id.0,
        object: handed_over.object()?.0,
        until_ns: (handed_over.at + window).ns(),
    })
}

/// Returns the view that clients get.
pub(crate) fn view(manager: &Manager, state: &State, rejected: u64) -> PolicyView {
    let open = state.open.as_ref();
    let belief = open.map_or_else(|| manager.prior(state), Interaction::belief);
    let mut belief = belief.probabilities();
    let objects = manager.scene().objects().len();
    let absent = belief.split_off(objects.min(belief.len())).into_iter().next().unwrap_or(0.0);
    let ended = state.ended.as_ref().map(|ended| ended.utterances);
    let utterances = open.map(|open| open.utterances).or(ended);
    PolicyView {
        scene_key: state.scene_key,
        applied: state.applied.0,
        interaction: open.map_or(0, |open| open.id.0),
        belief,
        absent,
        person: manager.user_params(state),
        question: asked(state),
        prompt: state.act.prompt.0,
        text: rendering::text(manager.scene(), &state.act),
        decision: state.act.kind,
        value: state.act.value,
        alternatives: state.act.alternatives.clone(),
        expected_questions: state.act.expected_questions,
        bounds: state.act.bounds,
        attributed: state.attributed.clone(),
        questions: open.map_or(0, |open| open.questions),
        utterances: utterances.map(|(UtteranceSeq(a), UtteranceSeq(b))| (a, b)).unwrap_or_default(),
        last: state.ended.clone(),
        refusable: delivery(manager, state),
        refused: rejected,
        planner: manager.planner().to_owned(),
    }
}
