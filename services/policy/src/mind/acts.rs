//! How a decision becomes the standing act: what is asked, picked, said, or said again.

use super::words;
use crate::state::{Act, Interaction, Prompt, State};
use dialogue::NamedQuestion;
use messages::{ActKind, InteractionId, PickId, PromptId};
use scene::{ObjectId, Question, Scene};
use service::Time;

/// Makes `act` the standing decision.
pub(super) fn set(state: &mut State, act: Act) {
    state.act = Act { id: state.act.id.next(), ..act };
}

pub(super) fn ask(
    scene: &Scene,
    state: &mut State,
    question: Question,
    heard: PromptId,
    preface: &str,
    reasons: Act,
) {
    let standing = state.act.clone();
    let Some(open) = &mut state.open else { return };
    let stands = standing.kind == ActKind::Ask
        && standing.question == question
        && open.prompts.last().is_some_and(|prompt| prompt.id == standing.prompt);
    if stands && heard != standing.prompt {
        // It stands already and nobody has heard it to its end yet: saying it again would only
        // interrupt it.
        state.act = Act { id: standing.id, ..keep_words(reasons, &standing) };
        return;
    }
    open.presentations += 1;
    // The words are a function of the state: a replay says the same.
    let (prompt, presentation) = match stands {
        true => (standing.prompt, standing.presentation + 1),
        false => (state.last_prompt.next(), 1),
    };
    let words = scene.phrase_variant(question, prompt.0, presentation);
    let text = format!("{preface}{words}");
    if stands {
        ask_anew(open, standing.prompt);
        let again =
            Act { presentation: standing.presentation + 1, ..keep_words(reasons, &standing) };
        set(state, Act { text, ..again });
        return;
    }
    state.last_prompt = state.last_prompt.next();
    let asked = NamedQuestion::new(scene, question);
    open.prompts.push(Prompt { id: state.last_prompt, asked, answered: None });
    let prompt = state.last_prompt;
    let kind = ActKind::Ask;
    set(state, Act { kind, prompt, presentation: 1, question, text, ..reasons });
}

/// The new reasons with the standing act's words.
pub(super) fn keep_words(reasons: Act, standing: &Act) -> Act {
    Act {
        kind: standing.kind,
        prompt: standing.prompt,
        presentation: standing.presentation,
        question: standing.question,
        pick: standing.pick,
        text: standing.text.clone(),
        ..reasons
    }
}

pub(super) fn pick(scene: &Scene, state: &mut State, object: ObjectId, reasons: Act) {
    let Some(open) = &mut state.open else { return };
    open.picks += 1;
    let id = PickId { interaction: InteractionId(open.id.0), attempt: open.picks };
    open.pick = Some((id, object));
    open.picked = scene.object(object).name.clone();
    state.last_prompt = state.last_prompt.next();
    let prompt = state.last_prompt;
    let text = words::fetching(scene, object);
    let pick = Some((id, object));
    set(state, Act { kind: ActKind::Pick, prompt, presentation: 1, pick, text, ..reasons });
}

/// Orders the same pick under a new key.
pub(super) fn order_again(state: &mut State, at: Time) {
    let Some(open) = &mut state.open else { return };
    let Some((id, object)) = open.pick else { return };
    open.picks += 1;
    let pick = Some((PickId { attempt: open.picks, ..id }, object));
    open.pick = pick;
    set(state, Act { pick, decided: at, ..state.act.clone() });
}

/// Has the arm leave what it was sent for, if it does not hold it yet.
pub(super) fn call_off(state: &mut State, text: &str, at: Time) {
    let Some(open) = &state.open else { return };
    state.last_prompt = state.last_prompt.next();
    let cancel = Act {
        kind: ActKind::Cancel,
        prompt: state.last_prompt,
        presentation: 1,
        pick: open.pick,
        text: text.to_owned(),
        utterance: state.applied,
        decided: at,
        ..Act::default()
    };
    set(state, cancel);
}

pub(super) fn say(state: &mut State, text: &str, at: Time) {
    state.last_prompt = state.last_prompt.next();
    let prompt = state.last_prompt;
    let (text, utterance) = (text.to_owned(), state.applied);
    let kind = ActKind::Say;
    set(
        state,
        Act { kind, prompt, presentation: 1, text, utterance, decided: at, ..Act::default() },
    );
}

/// Says the standing words once more.
pub(super) fn repeat(state: &mut State, at: Time) {
    let prompt = state.act.prompt;
    if let Some(open) = &mut state.open {
        open.presentations += 1;
        ask_anew(open, prompt);
    }
    let presentation = state.act.presentation + 1;
    set(state, Act { presentation, decided: at, utterance: state.applied, ..state.act.clone() });
}

/// A question that is asked again waits for its answer again.
fn ask_anew(open: &mut Interaction, id: PromptId) {
    let prompt = open.prompts.iter_mut().find(|prompt| prompt.id == id);
    prompt.into_iter().for_each(|prompt| prompt.answered = None);
}
