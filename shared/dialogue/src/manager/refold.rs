//! Check of a journal: every state must follow from the previous one and its cause, bit for bit.

use super::{Cause, Manager, Record, State};

/// A record whose state does not follow from the previous one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("record {index}: the state does not follow from the one before it ({part} differs)")]
pub struct Mismatch {
    /// Index of the record, from 0.
    pub index: usize,
    /// The part that differs.
    pub part: &'static str,
}

/// Checks every record against the transition.
///
/// # Errors
/// The first record that does not follow.
pub fn refold(manager: &mut Manager, records: &[Record]) -> Result<(), Mismatch> {
    let mut state = manager.first();
    for (index, record) in records.iter().enumerate() {
        if record.cause == Cause::Snapshot {
            state = record.state.clone();
            continue;
        }
        manager.step(&mut state, &record.cause, record.at);
        if let Some(part) = difference(&mut state, &record.state) {
            return Err(Mismatch { index, part });
        }
    }
    Ok(())
}

/// Checks the latest consecutive records that were decided under the settings with that key, which
/// must be those of `manager`, and returns their number. The record before them is taken as it is,
/// and the change to these settings is checked like every other step: it rests on that record and
/// on the settings since.
///
/// # Errors
/// As [`refold`], with the place in `records`.
pub fn refold_since(
    manager: &mut Manager,
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
    refold(manager, &own).map_err(|m| Mismatch { index: start + m.index, ..m })?;
    Ok(records.len() - from)
}

/// Returns the first difference, comparing numbers by their bits.
fn difference(folded: &mut State, recorded: &State) -> Option<&'static str> {
    let bits = |state: &State| -> Option<Vec<u64>> {
        let belief = state.open.as_ref()?.belief();
        Some(belief.log_weights().iter().map(|weight| weight.to_bits()).collect())
    };
    // Whether other settings hold is for the caller to judge: most of them change no state.
    folded.settings_key = recorded.settings_key;
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
