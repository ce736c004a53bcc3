//! Decisions as standing acts: asking, picking, calling off, saying, repeating.

use scene::{ObjectId, Question};
use vocabulary::ids::{PickId, PromptId};
use vocabulary::time::Time;
use vocabulary::{ActKind, NamedQuestion, Outcome};

use super::Manager;
use super::line::{Content, Line, Preface, Remark};
use super::state::{Act, Basis, Interaction, Prompt, State, push_bounded};
use crate::Belief;

/// Share of the likeliest object's probability from which another one may well be wanted.
const LEFT_SHARE: f64 = 0.1;
/// Most values that are read out as choices.
const CHOICES_MAX: usize = 4;

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
        if stands && basis.heard != standing.prompt && basis.preface == Preface::None {
            // Already pending and not heard to its end yet: repeating it would only interrupt it.
            return set_reasons(state, reasons);
        }
        open.presentations += 1;
        // One that was answered in doubt is asked anew, and counts again.
        let is_answered = open.prompts.last().is_some_and(|prompt| prompt.answered.is_some());
        if stands && !is_answered {
            let at = reasons.decided;
            set_reasons(state, reasons);
            return self.put_again(state, basis.preface, at);
        }
        let prompt = self.new_prompt(state, question);
        let Some(open) = &mut state.open else { return };
        // The wording is a function of the state: a replay says the same.
        let content = match &state.act.line.content {
            // What was offered in words is not pointed at.
            Content::Offered(nearest) if stands => Content::Offered(nearest.clone()),
            _ => self.wording(open, prompt),
        };
        let line = Line { preface: basis.preface, content };
        set(state, Act { kind: ActKind::Ask, prompt, presentation: 1, question, line, ..reasons });
    }

    /// Numbers a prompt, and notes its question in the open interaction.
    pub(super) fn new_prompt(&self, state: &mut State, question: Question) -> PromptId {
        state.last_prompt = state.last_prompt.next();
        let named = match self.recall {
            true => NamedQuestion::new(&self.setup.scene, question),
            false => NamedQuestion::None,
        };
        let id = state.last_prompt;
        if let Some(open) = &mut state.open {
            open.add_prompt(Prompt { id, question, named, answered: None, times: 0 });
        }
        id
    }

    /// Puts the standing question once more, in other words.
    pub(super) fn put_again(&self, state: &mut State, preface: Preface, at: Time) {
        let Some(open) = &mut state.open else { return };
        let prompt = state.act.prompt;
        await_answer(open, prompt);
        let content = match &state.act.line.content {
            Content::Wanted(time) => Content::Wanted(time + 1),
            Content::Offered(nearest) => Content::Offered(nearest.clone()),
            _ => self.wording(open, prompt),
        };
        let act = &mut state.act;
        act.id = act.id.next();
        act.presentation += 1;
        act.line = Line { preface, content };
        (act.decided, act.utterance) = (at, state.applied);
    }

    /// Returns the next wording of a prompt: each is used once in an interaction.
    fn wording(&self, open: &mut Interaction, prompt: PromptId) -> Content {
        let Some(question) = open.prompt(prompt).map(|prompt| prompt.question) else {
            return Content::Silence;
        };
        let alike = || open.prompts.iter().filter(|prompt| prompt.question == question);
        // The wordings of a question go on where they were.
        let variant = alike().next().map_or(prompt, |prompt| prompt.id).0;
        let time = 1 + alike().map(|prompt| prompt.times).sum::<u32>();
        let choices = self.choices(&open.belief(), question);
        let is_last = open.silences > 0 && open.silences >= self.setup.turns.repeats_max;
        if let Some(prompt) = open.prompt_mut(prompt) {
            prompt.times += 1;
        }
        Content::Question { variant, time, choices, is_last }
    }

    /// Returns the values that the wanted object may have for the attribute in question, in their
    /// spoken form; empty if they are too many. Those of a yes/no question are only recorded.
    fn choices(&self, belief: &Belief, question: Question) -> Vec<String> {
        let (Question::Attribute(k, _) | Question::Which(k)) = question else { return Vec::new() };
        let scene = &self.setup.scene;
        let values = &scene.attributes()[k.index()].values;
        let mut is_left = vec![false; values.len()];
        if let Question::Attribute(_, v) = question {
            is_left[v.index()] = true;
        }
        for object in self.left(belief) {
            if let Some(v) = scene.object(object).values[k.index()] {
                is_left[v.index()] = true;
            }
        }
        let left = values.iter().zip(is_left).filter(|(_, is_left)| *is_left);
        let choices: Vec<String> = left.map(|(value, _)| value.spoken.clone()).collect();
        if choices.len() > CHOICES_MAX { Vec::new() } else { choices }
    }

    /// Returns the objects that may well be wanted, in the scene's order.
    pub(super) fn left(&self, belief: &Belief) -> Vec<ObjectId> {
        let objects = || self.setup.scene.ids();
        let most = objects().map(|i| belief.probability(i)).fold(0.0, f64::max);
        objects().filter(|i| belief.probability(*i) >= LEFT_SHARE * most).collect()
    }

    /// Returns the same objects, the likeliest first.
    pub(super) fn left_by_probability(&self, belief: &Belief) -> Vec<ObjectId> {
        let mut left = self.left(belief);
        left.sort_by(|a, b| belief.probability(*b).total_cmp(&belief.probability(*a)));
        left
    }

    pub(super) fn pick(
        &mut self,
        state: &mut State,
        object: ObjectId,
        preface: Preface,
        reasons: Act,
    ) {
        if state.stop.motion.is_latched() {
            return self.hold_back(state, object, preface, reasons);
        }
        let id = next_key(state);
        let Some(open) = &mut state.open else { return };
        open.held_back = None;
        let pick = Some((id, object));
        open.pick = pick;
        open.picked.clone_from(&self.setup.scene.object(object).name);
        state.last_prompt = state.last_prompt.next();
        open.announced = vec![state.last_prompt];
        let line = Line { preface, content: Content::Fetching(self.description(object)) };
        let prompt = state.last_prompt;
        set(state, Act { kind: ActKind::Pick, prompt, presentation: 1, pick, line, ..reasons });
    }

    /// Asks the user openly for the wanted object.
    pub(super) fn ask_wanted(&self, state: &mut State, at: Time) {
        state.last_prompt = state.last_prompt.next();
        let (prompt, utterance) = (state.last_prompt, state.applied);
        let (kind, line) = (ActKind::Ask, Content::Wanted(1).into());
        let act =
            Act { kind, prompt, presentation: 1, line, utterance, decided: at, ..Act::default() };
        set(state, act);
    }

    /// Answers the user without a decision: before the standing question, in the middle of the
    /// standing pick, or alone.
    pub(super) fn reply(&self, state: &mut State, remark: Remark, at: Time) {
        if self.ask_about_kept(state, Preface::Remark(remark.clone()), at) {
            return;
        }
        match state.act.kind {
            ActKind::Ask if state.open.is_some() => {
                if self.is_given_up(state, &remark) {
                    return self.close(state, Outcome::Abandoned, at, Content::Remark(remark));
                }
                self.put_again(state, Preface::Remark(remark), at);
            }
            ActKind::Pick | ActKind::Cancel | ActKind::PutBack if state.ordered().is_some() => {
                state.last_prompt = state.last_prompt.next();
                let act = &mut state.act;
                (act.id, act.prompt, act.presentation) = (act.id.next(), state.last_prompt, 1);
                act.line = Content::Remark(remark).into();
                (act.decided, act.utterance) = (at, state.applied);
                if state.to_put_back().is_some() {
                    state.note_putting_back(state.last_prompt);
                } else if let Some(open) = &mut state.open {
                    open.announce(state.last_prompt);
                }
            }
            _ => {
                say(state, Content::Remark(remark), at);
                if let Some(handed_over) = &mut state.handed_over {
                    push_bounded(&mut handed_over.lines, state.last_prompt);
                }
            }
        }
    }

    /// Counts one more turn without an answer, if the remark replies to words that may be nobody's.
    /// Returns whether too many of them have followed one another.
    fn is_given_up(&self, state: &mut State, remark: &Remark) -> bool {
        let follows = matches!(&state.act.line.preface, Preface::Remark(it) if says_nothing(it));
        let Some(open) = &mut state.open else { return false };
        if says_nothing(remark) {
            open.silences += 1;
            return follows && open.silences > self.setup.turns.repeats_max.max(1);
        }
        if !matches!(remark, Remark::Stopped | Remark::StopUnconfirmed) {
            open.silences = 0;
        }
        false
    }
}

/// Whether a remark replies to words without content: recognisers make such words of silence.
fn says_nothing(remark: &Remark) -> bool {
    matches!(remark, Remark::NotUnderstood | Remark::Welcome | Remark::Goodbye)
}

/// Orders the same pick under a new key.
pub(super) fn order_again(state: &mut State, at: Time) {
    let id = next_key(state);
    let Some(open) = &mut state.open else { return };
    let Some((_, object)) = open.pick else { return };
    open.pick = Some((id, object));
    state.act.pick = open.pick;
    state.act.decided = at;
    state.act.id = state.act.id.next();
}

/// Orders the arm to leave the object that it was sent for, or to put it back if it already holds
/// it.
pub(super) fn call_off(state: &mut State, content: Content, at: Time) {
    let pick = state.open.as_ref().and_then(|open| open.pick);
    say_with(state, ActKind::Cancel, content, at);
    state.act.pick = pick;
}

pub(super) fn say(state: &mut State, content: Content, at: Time) {
    say_with(state, ActKind::Say, content, at);
}

/// Returns the key of the next order to the arm, higher than every earlier one.
pub(super) fn next_key(state: &mut State) -> PickId {
    let (interaction, last) = (state.last_interaction, state.last_order);
    let attempt = if last.interaction == interaction { last.attempt + 1 } else { 1 };
    state.last_order = PickId { interaction, attempt };
    state.last_order
}

pub(super) fn say_with(state: &mut State, kind: ActKind, content: Content, at: Time) {
    state.last_prompt = state.last_prompt.next();
    let (prompt, utterance) = (state.last_prompt, state.applied);
    let line = content.into();
    let act = Act { kind, prompt, presentation: 1, line, utterance, decided: at, ..Act::default() };
    set(state, act);
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
