//! Picks that wait for a word: those decided while the motion stop is latched, which are ordered
//! once the user has confirmed them and the stop is released, and an object that was called off and
//! that the gripper has kept (`kept.rs`).

use scene::{ObjectId, Question, Response};
use serde::{Deserialize, Serialize};
use vocabulary::ActKind;
use vocabulary::ids::PromptId;
use vocabulary::time::Time;

use super::Manager;
use super::acts::{say, set};
use super::attribution::Heard;
use super::line::{Content, Line, Preface, Remark};
use super::state::{Act, State};
use super::stop::MotionStop;

/// A pick that waits for the release of the motion stop, or for a decision about a kept object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HeldBack {
    /// Name of the object.
    pub name: String,
    /// Condition for the pick.
    pub wait: Wait,
}

/// Condition that a pick waits for. Earlier journals have `is_confirmed: bool`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wait {
    /// The user's word and the release.
    Word,
    /// The release; the user has confirmed it.
    Release,
    /// The user's decision about the object kept in the gripper.
    WordOfKept,
    /// The release; the user has asked for the object kept in the gripper.
    ReleaseOfKept,
}

impl HeldBack {
    /// Returns whether the user has confirmed it.
    pub fn is_confirmed(&self) -> bool {
        matches!(self.wait, Wait::Release | Wait::ReleaseOfKept)
    }

    /// Returns whether the gripper has kept the object.
    pub fn is_kept(&self) -> bool {
        matches!(self.wait, Wait::WordOfKept | Wait::ReleaseOfKept)
    }
}

impl State {
    /// Returns the object that an answer to that line would confirm or deny, if its pick waits for
    /// the release of the motion stop.
    pub fn confirmable(&self, prompt: PromptId) -> Option<ObjectId> {
        let open = self.open.as_ref().filter(|open| open.held_back.is_some())?;
        match open.prompt(prompt)?.question {
            Question::Point(object) => Some(object),
            _ => None,
        }
    }
}

impl Manager {
    /// Announces a pick that cannot start yet.
    pub(super) fn hold_back(
        &mut self,
        state: &mut State,
        object: ObjectId,
        preface: Preface,
        reasons: Act,
    ) {
        let name = self.setup.scene.object(object).name.clone();
        let content = Content::HeldBack(self.description(object));
        let Some(open) = &mut state.open else { return };
        open.held_back = Some(HeldBack { name, wait: Wait::Word });
        self.ask_for(state, object, Line { preface, content }, reasons);
    }

    /// Says a line that is answered with yes or no to the object, without aiming at it.
    pub(super) fn ask_for(&self, state: &mut State, object: ObjectId, line: Line, reasons: Act) {
        let prompt = self.new_prompt(state, Question::Point(object));
        set(state, Act { kind: ActKind::Say, prompt, presentation: 1, line, ..reasons });
    }

    /// Returns the object of the pick that was held back, if an answer confirms it.
    pub(super) fn confirmed(&self, state: &State, heard: &Heard<'_>) -> Option<ObjectId> {
        let held = state.open.as_ref()?.held_back.as_ref()?;
        let object = self.setup.scene.object_named(&held.name)?;
        let yes = heard.interpretations.first().is_some_and(|(_, question, reading)| {
            let has = |word: &scene::WordId| self.setup.model.has_word(object, *word);
            *question == Question::Point(object)
                && reading.response == Response::Yes
                && reading.base.iter().all(has)
        });
        (yes || self.asks_for_kept(state, heard)).then_some(object)
    }

    /// Carries out the pick that was held back, as soon as it can be.
    pub(super) fn confirm(&mut self, state: &mut State, object: ObjectId, at: Time) {
        if let Some(held) = state.open.as_mut().and_then(|open| open.held_back.as_mut()) {
            held.wait = if held.is_kept() { Wait::ReleaseOfKept } else { Wait::Release };
        }
        if state.to_put_back().is_some() {
            // Its turn comes once the other object is back.
            self.reply(state, Remark::AllRight, at);
        } else if state.stop.motion.is_latched() {
            say(state, Content::Confirmed, at);
        } else {
            self.release(state, object, at);
        }
    }

    /// Reports the effect of a stop that a user ordered, as the arm does: it is at rest, or the
    /// stop is not confirmed in time.
    pub(super) fn report_stop(&mut self, state: &mut State, confirmed: bool, at: Time) {
        let Some(order) = &mut state.stop.order else { return };
        order.is_late = true;
        if confirmed {
            state.stop.order = None;
        }
        let remark = if confirmed { Remark::Stopped } else { Remark::StopUnconfirmed };
        self.reply(state, remark, at);
    }

    pub(super) fn note_stop(&mut self, state: &mut State, stop: MotionStop, at: Time) {
        let (before, is_latched) = (state.stop.motion.is_latched(), stop.is_latched());
        state.stop.motion = stop;
        if before == is_latched {
            return;
        }
        if !is_latched {
            state.stop.order = None;
        }
        if !is_latched && self.release_put_back(state, at) {
            return;
        }
        let Some(held) = state.open.as_ref().and_then(|open| open.held_back.clone()) else {
            return;
        };
        let Some(object) = self.setup.scene.object_named(&held.name) else { return };
        match (is_latched, held.is_confirmed()) {
            (true, _) => {}
            (false, true) => self.release(state, object, at),
            (false, false) => self.ask_to_release(state, object, Preface::None, at),
        }
    }

    /// Asks whether an object is still wanted whose pick was held back.
    pub(super) fn ask_to_release(
        &mut self,
        state: &mut State,
        object: ObjectId,
        preface: Preface,
        at: Time,
    ) {
        if self.ask_about_kept(state, preface.clone(), at) {
            return;
        }
        let content = match state.stop.motion.is_latched() {
            true => Content::HeldBack(self.description(object)),
            false => Content::AskToRelease(self.description(object)),
        };
        let utterance = state.applied;
        let reasons = Act { utterance, decided: at, ..Act::default() };
        self.ask_for(state, object, Line { preface, content }, reasons);
    }

    fn release(&mut self, state: &mut State, object: ObjectId, at: Time) {
        let utterance = state.applied;
        let reasons = Act { utterance, decided: at, ..Act::default() };
        let is_kept = state.kept().is_some();
        self.pick(state, object, Preface::None, reasons);
        if is_kept {
            state.act.line = Content::Remark(Remark::AllRight).into();
        }
    }
}
