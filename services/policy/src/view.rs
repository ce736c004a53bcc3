//! The state as other services see it.

use dialogue::manager::{Interaction, Manager, State};
use dialogue::rendering;
use messages::{Delivery, FixedText, PolicyView, RobotAct, WireCode};
use scene::{ObjectId, Question, Scene};
use service::Span;
use vocabulary::Action;
use vocabulary::ids::UtteranceSeq;

/// Returns the standing decision as it is published.
pub(crate) fn act(manager: &Manager, state: &State) -> RobotAct {
    let scene = manager.scene();
    let act = &state.act;
    let interaction = act.pick.map_or(state.last_interaction, |(pick, _)| pick.interaction);
    RobotAct {
        act: act.id.0,
        scene_key: scene_key(manager, state),
        interaction: interaction.0,
        prompt: act.prompt.0,
        presentation: act.presentation,
        kind: act.kind.code(),
        in_words: u8::from(act.is_in_words()),
        question: numbered(scene, manager.answerable(state)).into(),
        object: act.pick.map_or(0, |(_, object)| scene.number(object).0.into()),
        attempt: act.pick.map_or(0, |(pick, _)| pick.attempt),
        decided_ns: act.decided.ns(),
        utterance: act.utterance.0,
        text: FixedText::truncated(&rendering::text(scene, act)),
        ..RobotAct::default()
    }
}

/// Returns the key of the scene that the words of a message belong to. Objects from perception have
/// numbers that are not the scene's, so that it stays the same whatever is on the table.
fn scene_key(manager: &Manager, state: &State) -> u64 {
    if state.table.is_some() { manager.scene_file().key() } else { state.scene_key }
}

/// Returns the question with the object's number.
fn numbered(scene: &Scene, question: Question) -> Question {
    match question {
        Question::Point(object) => Question::Point(scene.number(object)),
        other => other,
    }
}

/// Returns the object's number; one past the scene's objects, for an absent one, stays as it is.
fn number(scene: &Scene, object: ObjectId) -> ObjectId {
    if object.index() < scene.objects().len() { scene.number(object) } else { ObjectId(u16::MAX) }
}

/// Returns the object handed over last, while it can be refused.
fn delivery(manager: &Manager, state: &State) -> Option<Delivery> {
    let handed_over = state.handed_over.as_ref().filter(|_| state.open.is_none())?;
    let window = Span::from_s(manager.turns().refusal_s);
    Some(Delivery {
        interaction: handed_over.interaction.id.0,
        object: manager.scene().number(handed_over.object()?).0,
        until_ns: (handed_over.at + window).ns(),
    })
}

/// Returns the view that clients get.
pub(crate) fn view(manager: &Manager, state: &State, rejected: u64) -> PolicyView {
    let open = state.open.as_ref();
    let belief = open.map_or_else(|| manager.prior(state), Interaction::belief);
    let mut belief = belief.probabilities();
    let scene = manager.scene();
    let count = scene.objects().len();
    let all = (0..count).map(|object| scene.number(object.into()));
    let objects = if state.table.is_some() { all.collect() } else { Vec::new() };
    let alternative = |(action, value): &(Action, f64)| match action {
        Action::Ask(question) => (Action::Ask(numbered(scene, *question)), *value),
        Action::Pick(object) => (Action::Pick(number(scene, *object)), *value),
        Action::Wait => (Action::Wait, *value),
    };
    let absent = belief.split_off(count.min(belief.len())).into_iter().next().unwrap_or(0.0);
    let ended = state.ended.as_ref().map(|ended| ended.utterances);
    let utterances = open.map(|open| open.utterances).or(ended);
    PolicyView {
        scene_key: scene_key(manager, state),
        applied: state.applied.0,
        interaction: open.map_or(0, |open| open.id.0),
        from: open.map(|open| open.from().to_string()).unwrap_or_default(),
        belief,
        absent,
        person: manager.user_params(state),
        objects,
        question: numbered(scene, manager.asked(state)),
        prompt: state.act.prompt.0,
        text: rendering::text(manager.scene(), &state.act),
        decision: state.act.kind,
        value: state.act.value,
        alternatives: state.act.alternatives.iter().map(alternative).collect(),
        expected_questions: state.act.expected_questions,
        bounds: state.act.bounds,
        attributed: state.attributed.clone(),
        questions: open.map_or(0, |open| open.questions),
        utterances: utterances.map(|(UtteranceSeq(a), UtteranceSeq(b))| (a, b)).unwrap_or_default(),
        last: state.ended.clone(),
        refusable: delivery(manager, state),
        refused: rejected,
        planner: manager.planner().to_owned(),
        forgot: 0,
    }
}
