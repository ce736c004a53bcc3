//! After a hand-over: for a while the object can be refused, and the interaction is taken up again
//! without it, under a number of its own.

use scene::{ObjectId, Question, Response};
use serde::{Deserialize, Serialize};
use vocabulary::ids::PromptId;
use vocabulary::time::{Span, Time};

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::line::Preface;
use super::put_back::{WithUser, refuse};
use super::state::{Interaction, Preference, State};
use super::turn::Statement;
use super::utterance::Utterance;

/// A delivery that can still be refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HandedOver {
    /// The interaction that ended with the hand-over.
    pub interaction: Interaction,
    /// Time of the hand-over.
    pub at: Time,
    /// Lines said since: each can be answered with a refusal.
    pub lines: Vec<PromptId>,
}

impl HandedOver {
    /// Returns the object.
    pub fn object(&self) -> Option<ObjectId> {
        self.interaction.pick.map(|(_, object)| object)
    }
}

impl State {
    /// Returns the object that an answer to that line would refuse, after a hand-over.
    pub fn refusable(&self, prompt: PromptId) -> Option<ObjectId> {
        let handed_over = self.handed_over.as_ref().filter(|_| self.open.is_none())?;
        handed_over.object().filter(|_| handed_over.lines.contains(&prompt))
    }
}

impl Manager {
    /// Forgets a delivery that can no longer be refused.
    pub(super) fn expire(&self, state: &mut State, at: Time) {
        let window = Span::from_s(self.setup.turns.refusal_s);
        if state.handed_over.as_ref().is_some_and(|it| at > it.at + window) {
            state.handed_over = None;
        }
        self.expire_with_user(state, at);
    }

    /// Returns the refusal of the object handed over last, if the utterance is likely to be one.
    pub(super) fn refusal(&self, state: &State, heard: &Heard<'_>) -> Option<Heard<'static>> {
        let object = state.handed_over.as_ref().filter(|_| state.open.is_none())?.object()?;
        // Words of another object are the next request, and no refusal.
        let says_no = |(_, question, reading): &(f64, Question, scene::Reading)| {
            let of_it = *question == Question::Point(object) && reading.response == Response::No;
            let has = |word: &scene::WordId| self.setup.model.has_word(object, *word);
            let excludes = reading.base.is_empty() && !reading.excluded.is_empty();
            (of_it && reading.base.iter().all(has)) || excludes
        };
        let mut denial = self.denial(object, &heard.interpretations)?;
        let likeliest = heard.interpretations.first().filter(|it| says_no(it));
        denial.mark = Some(self.not(object));
        likeliest.map(|_| denial)
    }

    pub(super) fn not(&self, object: ObjectId) -> Mark {
        Mark::Not(self.setup.scene.object(object).name.clone())
    }

    /// Counts the last delivery as refused, and returns its interaction.
    pub(super) fn refuse_last(state: &mut State, at: Time) -> Option<Interaction> {
        let refused = state.handed_over.take()?.interaction;
        let (name, interaction) = (refused.picked.clone(), refused.id);
        refuse(state, &WithUser { name, interaction, at });
        Some(refused)
    }

    /// Takes up the interaction whose object was refused, without that object.
    pub(super) fn reopen(&mut self, state: &mut State, said: Statement<'_>) {
        let Statement { utterance, heard, refusal, at, .. } = said;
        let Some(refused) = Self::refuse_last(state, at) else { return };
        self.open_like(state, utterance, refused);
        self.retract(state, &heard);
        let Some(open) = &mut state.open else { return };
        self.take_in(open, heard);
        refusal.into_iter().for_each(|refusal| self.take_in(open, refusal));
        self.defer(state, utterance, Preference::Best, Preface::Sorry, at);
        if !utterance.more {
            self.decide_deferred(state, at);
        }
    }

    /// Opens an interaction in which everything counts that was said in another one.
    pub(super) fn open_like(&mut self, state: &mut State, said: &Utterance, before: Interaction) {
        self.open(state, said);
        if let Some(open) = &mut state.open {
            let Interaction { posterior, evidence, forgotten, conceded, .. } = before;
            (open.posterior, open.evidence) = (posterior, evidence);
            (open.forgotten, open.conceded) = (forgotten, conceded);
        }
    }
}
