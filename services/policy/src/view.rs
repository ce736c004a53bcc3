//! The state as others see it.

use crate::mind::{Mind, questions};
use crate::state::{Act, Interaction, State};
use messages::{ActKind, FixedText, PolicyView, RobotAct, UtteranceSeq, WireCode};
use scene::Question;

/// The standing decision on the wire.
pub(crate) fn act(state: &State) -> RobotAct {
    let act = &state.act;
    let interaction = act.pick.map_or(state.last_interaction, |(pick, _)| pick.interaction);
    RobotAct {
        act: act.id.0,
        scene_key: state.scene_key,
        interaction: interaction.0,
        prompt: act.prompt.0,
        presentation: act.presentation,
        kind: act.kind.code(),
        question: asks(act).into(),
        object: act.pick.map_or(0, |(_, object)| object.0.into()),
        attempt: act.pick.map_or(0, |(pick, _)| pick.attempt),
        decided_ns: act.decided.ns(),
        utterance: act.utterance.0,
        text: FixedText::truncated(&act.text),
        ..RobotAct::default()
    }
}

/// What the act's words can be answered as: "I will get the white bowl" is denied like "this one?".
fn asks(act: &Act) -> Question {
    match (act.kind, act.pick) {
        (ActKind::Pick, Some((_, object))) => Question::Point(object),
        _ => act.question,
    }
}

/// What clients are told.
pub(crate) fn view(mind: &Mind, state: &State, refused: u64) -> PolicyView {
    let open = state.open.as_ref();
    let belief = open.map_or_else(|| mind.prior(state), Interaction::belief);
    let mut belief = belief.probabilities();
    let objects = mind.scene().objects().len();
    let absent = belief.split_off(objects.min(belief.len())).into_iter().next().unwrap_or(0.0);
    let numbers = |(first, last): (UtteranceSeq, UtteranceSeq)| (first.0, last.0);
    let latest = |ended: &messages::Ended| numbers(ended.utterances);
    let utterances = |open: &Interaction| numbers(open.utterances);
    PolicyView {
        scene_key: state.scene_key,
        applied: state.applied.0,
        interaction: open.map_or(0, |open| open.id.0),
        belief,
        absent,
        person: mind.expects(state),
        question: state.act.question,
        prompt: state.act.prompt.0,
        text: state.act.text.clone(),
        decision: kind_name(state.act.kind).to_owned(),
        value: state.act.value,
        alternatives: state.act.alternatives.clone(),
        expected_questions: state.act.expected_questions,
        bounds: state.act.bounds,
        questions: open.map_or(0, questions),
        utterances: open.map(utterances).or(state.ended.as_ref().map(latest)).unwrap_or_default(),
        last: state.ended.clone(),
        refused,
        planner: mind.planner().to_owned(),
    }
}

fn kind_name(kind: ActKind) -> &'static str {
    match kind {
        ActKind::Wait => "wait",
        ActKind::Ask => "ask",
        ActKind::Say => "say",
        ActKind::Pick => "pick",
        ActKind::Cancel => "cancel",
    }
}
