//! Re-folds a journal: every state must follow from the one before it and its cause, bit for bit.

use crate::mind::Mind;
use crate::state::{Cause, Record, State};

/// A record whose state does not follow.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("record {index}: the state does not follow from the one before it ({part} differs)")]
pub struct Mismatch {
    /// Its place, from 0.
    pub index: usize,
    /// What differs first.
    pub part: &'static str,
}

/// Checks every record against the transition.
///
/// # Errors
/// The first record that does not follow.
pub fn refold(mind: &mut Mind, records: &[Record]) -> Result<(), Mismatch> {
    let mut state = mind.first();
    for (index, record) in records.iter().enumerate() {
        if record.cause == Cause::Snapshot {
            state = record.state.clone();
            continue;
        }
        let folded = mind.step(&state, &record.cause, record.at);
        if let Some(part) = difference(&folded, &record.state) {
            return Err(Mismatch { index, part });
        }
        state = record.state.clone();
    }
    Ok(())
}

/// What differs, comparing numbers by their bits.
fn difference(folded: &State, recorded: &State) -> Option<&'static str> {
    let bits = |state: &State| -> Vec<u64> {
        let belief = state.open.iter().flat_map(|open| open.belief.iter());
        belief.map(|weight| weight.to_bits()).collect()
    };
    if bits(folded) != bits(recorded) {
        Some("belief")
    } else if folded.act != recorded.act {
        Some("decision")
    } else if folded != recorded {
        Some("dialogue")
    } else {
        None
    }
}
