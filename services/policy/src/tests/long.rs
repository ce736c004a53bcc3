//! Interactions of thousands of utterances.

use super::*;

/// Bytes of the state in a journal record.
fn bytes(state: &State) -> usize {
    postcard::to_allocvec(state).unwrap().len()
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

#[test]
fn policy_is_recovered_from_a_snapshot_in_the_middle_of_an_interaction() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let record = Record { cause: Cause::Silence, at: at(1), state };
    let node = PolicyNode::recover(manager.into(), vec![record.clone()]).unwrap();
    let snapshot = node.snapshot().expect("a snapshot");
    let again = PolicyNode::recover(super::manager().into(), snapshot).unwrap();
    assert_eq!(again.state(), &record.state);
}
