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

/// Checks the latest records in a row that were decided under the settings with that key, which are
/// to be those of `mind`; how many they are. The record before them is taken as it is, and the change
/// to these settings is checked like every other step: it rests on that record and on what holds
/// since.
///
/// # Errors
/// As [`refold`], with the place in `records`.
pub fn refold_since(
    mind: &mut Mind,
    records: &[Record],
    settings_key: u64,
) -> Result<usize, Mismatch> {
    let others = records.iter().rposition(|record| record.state.settings_key != settings_key);
    let from = others.map_or(0, |last| last + 1);
    let start = from.saturating_sub(1);
    let mut own = records[start..].to_vec();
    if let (Some(first), true) = (own.first_mut(), from > 0) {
        first.cause = Cause::Snapshot;
    }
    refold(mind, &own).map_err(|m| Mismatch { index: start + m.index, ..m })?;
    Ok(records.len() - from)
}

/// What differs, comparing numbers by their bits.
fn difference(folded: &State, recorded: &State) -> Option<&'static str> {
    let bits = |state: &State| -> Vec<u64> {
        let belief = state.open.iter().flat_map(|open| open.belief.iter());
        belief.map(|weight| weight.to_bits()).collect()
    };
    // Whether other settings hold is for the caller to judge: most of them change no state.
    let folded = &State { settings_key: recorded.settings_key, ..folded.clone() };
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
