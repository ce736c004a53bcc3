//! An utterance with what the rules ask of it.

use scene::{Intent, Reference};
use vocabulary::time::Time;

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::references::reference;
use super::state::{State, Utterance};

/// An utterance while it is handled.
pub(super) struct Turn<'a> {
    pub(super) utterance: &'a Utterance,
    /// Shares of the questions that it may answer, and last the share of none.
    pub(super) shares: Vec<f64>,
    /// The most probable intent.
    pub(super) intent: Intent,
    /// What it says of the wanted object.
    pub(super) heard: Heard<'a>,
    /// What its likeliest reading points to.
    pub(super) refers: Reference,
    /// The refusal of what was handed over last, if it is likely to be one.
    pub(super) refusal: Option<Heard<'static>>,
    /// Objects spoken of before that it points to, if no interaction is open.
    pub(super) spoken_of: Option<Mark>,
    /// Whether it can open an interaction, if none is open.
    pub(super) is_request: bool,
    /// The time.
    pub(super) at: Time,
}

impl Manager {
    /// Returns the turn of an utterance.
    pub(super) fn turn<'a>(
        &self,
        state: &State,
        utterance: &'a Utterance,
        shares: Vec<f64>,
        at: Time,
    ) -> Turn<'a> {
        let heard = self.interpret(state, utterance, &shares);
        let mut turn = Turn {
            intent: self.intent(state, utterance, &shares),
            refers: reference(&heard),
            refusal: None,
            spoken_of: None,
            is_request: false,
            utterance,
            shares,
            heard,
            at,
        };
        if state.open.is_none() {
            turn.is_request = self.is_request(utterance);
            let heard = &turn.heard;
            turn.spoken_of = self.accepted(state, heard).or_else(|| self.resolve(state, heard));
            turn.refusal = self.refusal(state, heard);
            if turn.refusal.is_none() && turn.is_request && turn.spoken_of.is_none() {
                turn.spoken_of = self.listed(state, heard);
            }
        }
        turn
    }

    /// Returns the turn of an utterance that answers nothing.
    pub(super) fn turn_alone<'a>(
        &self,
        state: &State,
        utterance: &'a Utterance,
        at: Time,
    ) -> Turn<'a> {
        let mut shares = vec![0.0; utterance.presentations.len()];
        shares.push(1.0);
        self.turn(state, utterance, shares, at)
    }
}
