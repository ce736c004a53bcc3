//! What an utterance asks of the dialogue itself, before it says anything about an object.

use super::acts::call_off;
use super::{Mind, posterior, repeat, say, words};
use crate::state::{Heard, State};
use messages::{ActKind, Outcome, UtteranceSeq};
use scene::Intent;
use service::Time;

impl Mind {
    /// Takes in one utterance. Whatever it is, it counts as applied.
    pub(super) fn hear(&mut self, state: &mut State, heard: &Heard, at: Time) {
        state.applied = heard.seq;
        match self.wanted(state, heard) {
            Intent::Inform => self.inform(state, heard, at),
            // "That one over there" holds no word of the scene, but the hand does.
            Intent::None if self.pointed_at(heard).is_some() => self.inform(state, heard, at),
            Intent::None => {}
            Intent::Stop => self.stopped(state, at),
            Intent::Cancel => self.cancel(state, at),
            Intent::Repeat => repeat_last(state, at),
            Intent::StartOver => self.start_over(state, heard.seq, at),
            Intent::AskBack => self.answer_back(state, at),
        }
    }

    /// What the person wants most likely, over all that the utterance may mean.
    fn wanted(&self, state: &State, heard: &Heard) -> Intent {
        let to = self.addressed(state, heard);
        let mut shares: Vec<(Intent, f64)> = Vec::new();
        for meant in &heard.meant {
            let share = meant.weight * meant.answers.map_or(to.none, |at| to.questions[at]);
            match shares.iter_mut().find(|(intent, _)| *intent == meant.reading.intent) {
                Some((_, sum)) => *sum += share,
                None => shares.push((meant.reading.intent, share)),
            }
        }
        let likeliest =
            shares.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
        likeliest.map_or(Intent::None, |(intent, _)| intent)
    }

    /// The arm has been stopped by the speech service already; here it is only said. An ordered
    /// pick goes on once the operator releases the stop, so its order must stand.
    fn stopped(&self, state: &mut State, at: Time) {
        if state.act.kind != ActKind::Pick {
            let text = "I have stopped. Release the motion stop to go on.";
            self.interject(state, text, at);
        }
    }

    fn cancel(&self, state: &mut State, at: Time) {
        let Some(open) = &mut state.open else { return };
        // Whatever was wanted in place of what is being left, nothing is wanted now.
        open.corrected = false;
        if open.pick.is_none() {
            self.close(state, Outcome::Cancelled, at, "All right.");
        } else if state.act.kind == ActKind::Pick {
            call_off(state, "I will leave it, unless I already hold it.", at);
        }
    }

    fn start_over(&mut self, state: &mut State, utterance: UtteranceSeq, at: Time) {
        let Some(open) = &mut state.open else { return };
        if open.pick.is_some() {
            return;
        }
        open.silences = 0;
        open.evidence.clear();
        open.forgotten = 0;
        let beginning = self.beginning(state);
        if let Some(open) = &mut state.open {
            posterior::store(beginning, open);
        }
        let heard = state.act.prompt;
        self.decide(state, heard, "From the beginning. ", utterance, at);
    }

    fn answer_back(&self, state: &mut State, at: Time) {
        let text = words::inventory(self.scene());
        self.interject(state, &text, at);
    }

    /// Says something, and asks the standing question again behind it.
    fn interject(&self, state: &mut State, text: &str, at: Time) {
        if state.act.kind == ActKind::Ask {
            let question = self.scene().phrase(state.act.question);
            repeat(state, at);
            state.act.text = format!("{text} {question}");
        } else if state.act.kind != ActKind::Pick {
            say(state, text, at);
        }
    }
}

fn repeat_last(state: &mut State, at: Time) {
    if !state.act.text.is_empty() {
        repeat(state, at);
    }
}
