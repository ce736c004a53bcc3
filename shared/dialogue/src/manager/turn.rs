//! An utterance while it is handled, with the facts that the rules ask for.

use scene::{Intent, ObjectId, Reference, Response};
use vocabulary::time::Time;

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::references::reference;
use super::state::State;
use super::utterance::Utterance;

/// An utterance and the intent that the manager handles.
pub(super) struct Turn<'a> {
    pub(super) utterance: &'a Utterance,
    /// Shares of the questions that it may answer, and last the share of none.
    pub(super) shares: Vec<f64>,
    /// The most probable intent.
    pub(super) intent: Intent,
    pub(super) at: Time,
}

impl<'a> Turn<'a> {
    /// Returns the turn of an utterance that answers nothing and informs.
    pub(super) fn alone(utterance: &'a Utterance, at: Time) -> Self {
        let mut shares = vec![0.0; utterance.presentations.len()];
        shares.push(1.0);
        Self { utterance, shares, intent: Intent::Inform, at }
    }
}

/// An utterance about the wanted object.
pub(super) struct Statement<'a> {
    pub(super) utterance: &'a Utterance,
    /// Shares of the questions that it may answer, and last the share of none.
    pub(super) shares: Vec<f64>,
    /// Content of the utterance.
    pub(super) heard: Heard<'a>,
    /// The reference in the utterance's likeliest reading.
    pub(super) refers: Reference,
    /// The answer to a line about the object that goes back to its place.
    pub(super) of_put_back: Option<Response>,
    /// The object of the pick that was held back, if this confirms it.
    pub(super) confirmed: Option<ObjectId>,
    /// The refusal of the object handed over last, if the utterance is likely to be one.
    pub(super) refusal: Option<Heard<'static>>,
    /// Objects spoken of before that it points to, if no interaction is open.
    pub(super) spoken_of: Option<Mark>,
    /// Whether the utterance can open an interaction.
    pub(super) is_request: bool,
    pub(super) at: Time,
}

impl Manager {
    /// Returns the statement of a turn in the present state.
    pub(super) fn statement<'a>(&self, state: &State, turn: Turn<'a>) -> Statement<'a> {
        let Turn { utterance, shares, at, .. } = turn;
        let heard = self.interpret(state, utterance, &shares);
        let is_request = state.open.is_none() && self.is_request(utterance);
        let refusal = self.refusal(state, &heard);
        let spoken_of = || {
            let listed = || self.listed(state, &heard).filter(|_| is_request && refusal.is_none());
            let accepted = self.accepted(state, &heard);
            accepted.or_else(|| self.resolve(state, &heard)).or_else(listed)
        };
        Statement {
            refers: reference(&heard),
            of_put_back: self.put_back_answer(state, &heard),
            confirmed: self.confirmed(state, &heard),
            spoken_of: if state.open.is_none() { spoken_of() } else { None },
            utterance,
            shares,
            refusal,
            is_request,
            heard,
            at,
        }
    }
}
