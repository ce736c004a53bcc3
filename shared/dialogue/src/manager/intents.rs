//! Dispatch of an utterance by the user's intent.

use scene::Intent;

use super::Manager;
use super::acts::{call_off, interject, repeat};
use super::attribution::share_of;
use super::line::{Content, Preface, Remark};
use super::state::{Basis, State, Utterance};
use crate::ids::UtteranceSeq;
use crate::time::Time;
use crate::{ActKind, Outcome};

impl Manager {
    /// Processes one utterance. Whatever its content, it counts as applied.
    pub(super) fn hear(&mut self, state: &mut State, utterance: &Utterance, at: Time) {
        state.applied = utterance.seq;
        let shares = self.attribute(state, utterance);
        match intent(utterance, &shares) {
            Intent::Inform => self.inform(state, utterance, &shares, at),
            // "That one over there" has no word of the scene, but the gesture counts.
            Intent::None if self.is_pointing(utterance) => {
                self.inform(state, utterance, &shares, at);
            }
            Intent::None | Intent::Greet | Intent::Thank | Intent::PutBack => {}
            // The speech service has already stopped the arm. An ordered pick continues once the
            // operator releases the stop, so its order must stand.
            Intent::Stop => interject(state, Remark::Stopped, at),
            Intent::Cancel => self.cancel(state, at),
            Intent::Repeat => {
                if state.act.line.content != Content::Silence {
                    repeat(state, at);
                }
            }
            Intent::StartOver => self.start_over(state, utterance.seq, at),
            Intent::AskBack
            | Intent::AskCount
            | Intent::AskWhich
            | Intent::AskWhere
            | Intent::AskWhy
            | Intent::AskStatus
            | Intent::AskHelp => interject(state, Remark::Inventory, at),
        }
    }

    fn cancel(&self, state: &mut State, at: Time) {
        let Some(open) = &mut state.open else { return };
        // Another object may have been wanted instead of the one being left: no longer.
        open.corrected = false;
        if open.pick.is_none() {
            self.close(state, Outcome::Cancelled, at, Content::Cancelled);
        } else if state.act.kind == ActKind::Pick {
            call_off(state, Content::CallingOff, at);
        }
    }

    fn start_over(&mut self, state: &mut State, utterance: UtteranceSeq, at: Time) {
        if state.open.as_ref().is_none_or(|open| open.pick.is_some()) {
            return;
        }
        let beginning = self.beginning(state);
        if let Some(open) = &mut state.open {
            open.silences = 0;
            open.evidence.clear();
            open.forgotten = 0;
            open.posterior = beginning;
        }
        let (heard, preface) = (state.act.prompt, Preface::StartingOver);
        self.decide(state, Basis { heard, preface, utterance }, at);
    }
}

/// Returns the most probable intent, over all interpretations.
fn intent(utterance: &Utterance, shares: &[f64]) -> Intent {
    let mut sums: Vec<(Intent, f64)> = Vec::new();
    for interpretation in &utterance.interpretations {
        let share = interpretation.weight * share_of(interpretation, shares);
        match sums.iter_mut().find(|(intent, _)| *intent == interpretation.reading.intent) {
            Some((_, sum)) => *sum += share,
            None => sums.push((interpretation.reading.intent, share)),
        }
    }
    let likeliest = sums.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
    likeliest.map_or(Intent::None, |(intent, _)| intent)
}
