//! Content of an utterance about the wanted object.

use scene::{Reading, Response};

use super::Manager;
use super::attribution::Heard;
use super::evidence::Evidence;
use super::line::Preface;
use super::state::{Basis, Deferred, Interaction, State, Utterance};
use crate::time::Time;

impl Manager {
    /// Scores an utterance against the questions that it may answer, and decides again.
    pub(super) fn inform(
        &mut self,
        state: &mut State,
        utterance: &Utterance,
        shares: &[f64],
        at: Time,
    ) {
        if state.open.is_none() {
            if !self.is_request(utterance) {
                return;
            }
            self.open(state, utterance);
        }
        let Some(open) = &mut state.open else { return };
        open.utterances.1 = utterance.seq;
        open.silences = 0;
        let heard = self.interpret(state, utterance, shares);
        let Some(open) = &mut state.open else { return };
        if open.pick.is_some() {
            return self.reconsider(state, heard, at);
        }
        self.take_in(open, heard);
        self.note_answer(state, utterance, shares);
        defer(state, utterance, at);
        if !utterance.more {
            self.decide_deferred(state, at);
        }
    }

    /// Updates the interaction's posterior with an utterance, and remembers its content.
    pub(super) fn take_in(&self, open: &mut Interaction, heard: Heard) {
        let Heard { interpretations, unknown, gesture } = heard;
        self.update(&mut open.posterior, &interpretations, gesture);
        if self.recall {
            let interpretations = interpretations
                .iter()
                .map(|(weight, question, reading)| self.named(*weight, *question, reading));
            let interpretations = interpretations.collect();
            open.remember(Evidence { interpretations, unknown: unknown.to_owned(), gesture });
        }
    }

    /// Makes the deferred decision, if there is one.
    pub(super) fn decide_deferred(&mut self, state: &mut State, at: Time) {
        let deferred = state.open.as_mut().and_then(|open| open.deferred.take());
        if let Some(Deferred { basis, .. }) = deferred {
            self.decide(state, basis, at);
        }
    }

    fn open(&mut self, state: &mut State, utterance: &Utterance) {
        state.last_interaction = state.last_interaction.next();
        let (id, posterior) = (state.last_interaction, self.beginning(state));
        let mut open = Interaction::new(id, utterance.accepted, posterior, utterance.seq);
        open.objects = self.known_objects();
        state.open = Some(open);
    }

    /// Returns whether the user points at something that counts.
    pub(super) fn is_pointing(&self, utterance: &Utterance) -> bool {
        utterance.gesture.is_some() && self.pointing.is_some()
    }

    /// Returns whether the utterance can open an interaction: a mere answer means nothing where no
    /// question was asked, and neither does a gesture that does not count.
    fn is_request(&self, utterance: &Utterance) -> bool {
        let mut all = utterance.interpretations.iter().map(|it| &it.reading);
        let only_gesture =
            utterance.gesture.is_some() && all.clone().all(|it| *it == Reading::default());
        self.is_pointing(utterance) || !(all.all(is_mere_answer) || only_gesture)
    }
}

/// Records what the next decision rests on. It waits while the user is still speaking.
fn defer(state: &mut State, utterance: &Utterance, at: Time) {
    let Some(open) = &mut state.open else { return };
    let (preface, since) = match open.deferred.take() {
        Some(before) => (before.basis.preface, before.since),
        None => (Preface::None, at),
    };
    let preface = match utterance.unknown.as_str() {
        "" => preface,
        word => Preface::UnknownWord(word.to_owned()),
    };
    let basis = Basis { heard: utterance.heard(), preface, utterance: utterance.seq };
    open.deferred = Some(Deferred { basis, since });
}

fn is_mere_answer(reading: &Reading) -> bool {
    reading.response != Response::None && reading.base.is_empty() && reading.excluded.is_empty()
}
