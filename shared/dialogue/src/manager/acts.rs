//! Decisions as standing acts: asking, picking, calling off, saying, repeating.

use scene::{ObjectId, Question};

use super::Manager;
use super::line::{Content, Line, Preface, Remark};
use super::state::{Act, Basis, Interaction, Prompt, State};
use crate::ids::{PickId, PromptId};
use crate::time::Time;
use crate::{ActKind, NamedQuestion};

/// Makes `act` the standing decision.
pub(super) fn set(state: &mut State, act: Act) {
    state.act = Act { id: state.act.id.next(), ..act };
}

/// Replaces the reasons of the standing act.
pub(super) fn set_reasons(state: &mut State, reasons: Act) {
    let standing = std::mem::take(&mut state.act);
    state.act = Act {
        id: standing.id,
        kind: standing.kind,
        prompt: standing.prompt,
        presentation: standing.presentation,
        question: standing.question,
        pick: standing.pick,
        line: standing.line,
        ..reasons
    };
}

impl Manager {
    pub(super) fn ask(&self, state: &mut State, question: Question, basis: Basis, reasons: Act) {
        let standing = &state.act;
        let Some(open) = &mut state.open else { return };
        let stands = standing.kind == ActKind::Ask
            && standing.question == question
            && open.prompts.last().is_some_and(|prompt| prompt.id == standing.prompt);
        if stands && basis.heard != standing.prompt {
            // It stands already and was not heard to its end yet: saying it again would only
            // interrupt it.
            return set_reasons(state, reasons);
        }
        open.presentations += 1;
        let (prompt, presentation) = if stands {
            await_answer(open, standing.prompt);
            (standing.prompt, standing.presentation + 1)
        } else {
            state.last_prompt = state.last_prompt.next();
            let named = match self.recall {
                true => NamedQuestion::new(&self.setup.scene, question),
                false => NamedQuestion::None,
            };
            open.prompts.push(Prompt { id: state.last_prompt, question, named, answered: None });
            (state.last_prompt, 1)
        };
        // The wording is a function of the state: a replay says the same.
        let content = Content::Question { variant: prompt.0, presentation };
        let line = Line { preface: basis.preface, content };
        set(state, Act { kind: ActKind::Ask, prompt, presentation, question, line, ..reasons });
    }

    pub(super) fn pick(&mut self, state: &mut State, object: ObjectId, reasons: Act) {
        let Some(open) = &mut state.open else { return };
        open.picks += 1;
        let id = PickId { interaction: open.id, attempt: open.picks };
        let pick = Some((id, object));
        open.pick = pick;
        open.picked.clone_from(&self.setup.scene.object(object).name);
        state.last_prompt = state.last_prompt.next();
        let line = Content::Fetching(self.description(object)).into();
        let prompt = state.last_prompt;
        set(state, Act { kind: ActKind::Pick, prompt, presentation: 1, pick, line, ..reasons });
    }
}

/// Orders the same pick under a new key.
pub(super) fn order_again(state: &mut State, at: Time) {
    let Some(open) = &mut state.open else { return };
    let Some((id, object)) = open.pick else { return };
    open.picks += 1;
    open.pick = Some((PickId { attempt: open.picks, ..id }, object));
    state.act.pick = open.pick;
    state.act.decided = at;
    state.act.id = state.act.id.next();
}

/// Orders the arm to leave the object that it was sent for, unless it already holds it.
pub(super) fn call_off(state: &mut State, content: Content, at: Time) {
    let pick = state.open.as_ref().and_then(|open| open.pick);
    say_with(state, ActKind::Cancel, content, at);
    state.act.pick = pick;
}

pub(super) fn say(state: &mut State, content: Content, at: Time) {
    say_with(state, ActKind::Say, content, at);
}

fn say_with(state: &mut State, kind: ActKind, content: Content, at: Time) {
    state.last_prompt = state.last_prompt.next();
    let (prompt, utterance) = (state.last_prompt, state.applied);
    let line = content.into();
    let act = Act { kind, prompt, presentation: 1, line, utterance, decided: at, ..Act::default() };
    set(state, act);
}

/// Says a remark, and repeats the standing question behind it.
pub(super) fn interject(state: &mut State, remark: Remark, at: Time) {
    if state.act.kind == ActKind::Ask {
        repeat(state, at);
        let content = Content::Question { variant: 0, presentation: 1 };
        state.act.line = Line { preface: Preface::Remark(remark), content };
    } else if state.act.kind != ActKind::Pick {
        say(state, Content::Remark(remark), at);
    }
}

/// Repeats the standing line.
pub(super) fn repeat(state: &mut State, at: Time) {
    let prompt = state.act.prompt;
    if let Some(open) = &mut state.open {
        open.presentations += 1;
        await_answer(open, prompt);
    }
    let act = &mut state.act;
    act.id = act.id.next();
    act.presentation += 1;
    (act.decided, act.utterance) = (at, state.applied);
}

/// A question that is repeated waits for its answer again.
fn await_answer(open: &mut Interaction, id: PromptId) {
    if let Some(prompt) = open.prompt_mut(id) {
        prompt.answered = None;
    }
}
