//! What an utterance says about the wanted object.

use super::{Mind, posterior, words};
use crate::evidence::Evidence;
use crate::state::{Heard, Held, Interaction, State};
use scene::{Reading, Response};
use service::Time;

impl Mind {
    /// Scores what was said against the questions that it may answer, and decides anew.
    pub(super) fn inform(&mut self, state: &mut State, heard: &Heard, at: Time) {
        if state.open.is_none() {
            if !self.is_request(heard) {
                return;
            }
            self.open(state, heard);
        }
        let Some(open) = &mut state.open else { return };
        open.utterances.1 = heard.seq;
        open.silences = 0;
        if open.pick.is_some() {
            return self.reconsider(state, heard, at);
        }
        let to = self.addressed(state, heard);
        let evidence = self.evidence(state, heard, &to);
        let Some(open) = &mut state.open else { return };
        self.take_in(open, evidence);
        self.note_answer(state, heard, &to);
        self.hold(state, heard, at);
        if !heard.more {
            self.decide_held(state, at);
        }
    }

    /// Has the belief follow what was said.
    pub(super) fn take_in(&self, open: &mut Interaction, evidence: Evidence) {
        let mut believed = posterior::of(open);
        self.observe(&mut believed, &evidence);
        posterior::store(believed, open);
        open.keep(evidence);
    }

    /// Notes what the next decision rests on. While the person speaks on it waits.
    fn hold(&self, state: &mut State, heard: &Heard, at: Time) {
        let Some(open) = &mut state.open else { return };
        let before = open.held.take().unwrap_or(Held { since: at, ..Held::default() });
        let remark = words::unknown(heard);
        open.held = Some(Held {
            heard: heard.heard_whole(),
            preface: if remark.is_empty() { before.preface } else { remark },
            utterance: heard.seq,
            since: before.since,
        });
    }

    /// Decides what was held back, if anything was.
    pub(super) fn decide_held(&mut self, state: &mut State, at: Time) {
        let held = state.open.as_mut().and_then(|open| open.held.take());
        if let Some(Held { heard, preface, utterance, .. }) = held {
            self.decide(state, heard, &preface, utterance, at);
        }
    }

    fn open(&self, state: &mut State, heard: &Heard) {
        state.last_interaction = state.last_interaction.next();
        let mut open = Interaction {
            id: state.last_interaction,
            opened: heard.accepted,
            objects: self.known(),
            utterances: (heard.seq, heard.seq),
            ..Interaction::default()
        };
        posterior::store(self.beginning(state), &mut open);
        state.open = Some(open);
    }

    /// Where the person points, if gestures count.
    pub(super) fn pointed_at(&self, heard: &Heard) -> Option<[f64; 3]> {
        heard.gesture.filter(|_| self.pointing.is_some())
    }

    /// Whether the utterance can begin an interaction: nothing but answers means nothing where
    /// nothing was asked, and neither does a hand that does not count.
    fn is_request(&self, heard: &Heard) -> bool {
        let only_answers = heard.meant.iter().all(|meant| is_answer(&meant.reading));
        let only_gesture = heard.gesture.is_some()
            && heard.meant.iter().all(|meant| meant.reading == Reading::default());
        self.pointed_at(heard).is_some() || !(only_answers || only_gesture)
    }
}

/// Whether the reading is an answer and nothing else.
fn is_answer(reading: &Reading) -> bool {
    reading.response != Response::None && reading.base.is_empty() && reading.excluded.is_empty()
}
