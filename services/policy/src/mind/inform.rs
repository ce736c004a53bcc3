//! What an utterance says about the wanted object.

use super::{Mind, posterior, words};
use crate::evidence::{Asked, Evidence};
use crate::state::{Heard, Interaction, State};
use node::Time;
use scene::{Reading, Response};

impl Mind {
    /// Scores what was said against the question that was heard, and decides anew.
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
            return;
        }
        // An answer to an earlier question of this interaction still says what it says about that
        // question; one to another interaction's says nothing.
        let asked = open.prompts.iter().find(|prompt| prompt.id == heard.prompt);
        let asked = asked.map_or(Asked::Nothing, |prompt| prompt.asked.clone());
        let evidence = Evidence::new(&self.scene, asked, heard);
        let mut believed = posterior::of(open);
        self.observe(&mut believed, &evidence);
        posterior::store(believed, open);
        open.keep(evidence);
        self.note_answer(state, heard);
        let preface = words::unknown(heard);
        self.decide(state, heard.prompt, &preface, heard.seq, at);
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

    /// A question counts as answered once, however much is said after it.
    fn note_answer(&self, state: &mut State, heard: &Heard) {
        let says = |reading: &Reading| {
            reading.response != Response::None
                || !reading.base.is_empty()
                || !reading.excluded.is_empty()
        };
        let open = state.open.as_mut();
        let prompts = open.map_or(&mut [][..], |open| &mut open.prompts[..]);
        let asked = prompts.iter_mut().find(|prompt| prompt.id == heard.prompt);
        if let Some(prompt) = asked
            && !prompt.answered
            && heard.readings.iter().any(|(_, reading)| says(reading))
        {
            prompt.answered = true;
            self.see_answer(state, true, heard.reaction_s);
        }
    }

    /// Where the person points, if gestures count.
    pub(super) fn pointed_at(&self, heard: &Heard) -> Option<[f64; 3]> {
        heard.gesture.filter(|_| self.pointing.is_some())
    }

    /// Whether the utterance can begin an interaction: nothing but answers means nothing where
    /// nothing was asked, and neither does a hand that does not count.
    fn is_request(&self, heard: &Heard) -> bool {
        let only_answers = heard.readings.iter().all(|(_, reading)| is_answer(reading));
        let only_gesture = heard.gesture.is_some()
            && heard.readings.iter().all(|(_, reading)| *reading == Reading::default());
        self.pointed_at(heard).is_some() || !(only_answers || only_gesture)
    }
}

/// Whether the reading is an answer and nothing else.
fn is_answer(reading: &Reading) -> bool {
    reading.response != Response::None && reading.base.is_empty() && reading.excluded.is_empty()
}
