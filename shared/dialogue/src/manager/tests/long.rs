//! Interactions of thousands of utterances.

use super::fixture::{answer, asked, manager, reply, words};
use crate::manager::State;
use scene::Response;

/// Bytes of the state, serialised.
fn bytes(state: &State) -> usize {
    serde_json::to_vec(state).unwrap().len()
}

/// A user who never makes up her mind.
#[test]
fn state_stays_bounded_however_long_an_interaction_is() {
    let mut manager = manager();
    let mut state = asked(&mut manager);
    let said = [words(&["white"]), words(&["plastic"]), words(&["metal"]), answer(Response::No)];
    let mut largest = [0; 2];
    for n in 0..1_600 {
        state = reply(&mut manager, &state, said[n % said.len()].clone());
        assert!(state.open.is_some(), "utterance {n} ended it");
        let half = &mut largest[n / 800];
        *half = bytes(&state).max(*half);
    }
    assert!(largest[1] < largest[0] * 11 / 10, "bytes of the state, by halves: {largest:?}");
}
