//! A cancelled object that cannot go back to its place: the gripper keeps holding it, and nothing
//! else is decided until the user decides about it.

use scene::{ObjectId, Response};
use vocabulary::time::Time;

use super::Manager;
use super::acts::{call_off, next_key};
use super::attribution::Heard;
use super::held_back::{HeldBack, Wait};
use super::line::{Content, Line, Preface, Remark};
use super::state::{Act, State};
use crate::rendering;

impl State {
    /// Returns the name of the object that the gripper has kept.
    pub fn kept(&self) -> Option<&str> {
        let held_back = self.open.as_ref()?.held_back.as_ref();
        held_back.filter(|it| it.is_kept()).map(|it| &*it.name)
    }
}

impl Manager {
    /// The arm has kept the object that was called off.
    pub(super) fn keep_hold(&self, state: &mut State, object: ObjectId, at: Time) {
        let name = self.setup.scene.object(object).name.clone();
        if let Some(open) = &mut state.open {
            open.pick = None;
            open.picked.clear();
            open.announced.clear();
            open.held_back = Some(HeldBack { name, wait: Wait::WordOfKept });
        }
        self.ask_about_kept(state, Preface::None, at);
    }

    /// Returns the object that the gripper has kept.
    pub(super) fn kept(&self, state: &State) -> Option<ObjectId> {
        self.setup.scene.object_named(state.kept()?)
    }

    /// Asks whether to hand over the object kept in the gripper; returns whether there is one.
    pub(super) fn ask_about_kept(&self, state: &mut State, preface: Preface, at: Time) -> bool {
        let Some(object) = self.kept(state) else { return false };
        let content = Content::Kept(rendering::object(&self.setup.scene, object));
        let reasons = Act { utterance: state.applied, decided: at, ..Act::default() };
        self.ask_for(state, object, Line { preface, content }, reasons);
        true
    }

    /// Returns whether the user asks for the object kept in the gripper by its description.
    pub(super) fn asks_for_kept(&self, state: &State, heard: &Heard<'_>) -> bool {
        let Some(kept) = self.kept(state) else { return false };
        heard.interpretations.first().is_some_and(|(.., reading)| {
            let describes = !reading.base.is_empty() && reading.response != Response::No;
            describes && self.described(reading).eq([kept])
        })
    }

    /// Has the arm try once more to put the object back that the gripper has kept.
    pub(super) fn leave_kept(&self, state: &mut State, object: ObjectId, at: Time) {
        let id = next_key(state);
        let Some(open) = &mut state.open else { return };
        open.held_back = None;
        open.pick = Some((id, object));
        open.picked.clone_from(&self.setup.scene.object(object).name);
        let remark = Remark::PuttingBack(rendering::object(&self.setup.scene, object));
        call_off(state, Content::Remark(remark), at);
    }
}
