//! Judgement of numbers that another process has written: none is believed for its type alone.
//!
//! | number | rule | where |
//! |---|---|---|
//! | enum, count of entries, share, question, word, point | within its range | [`wire`](crate::wire), the message's own conversions |
//! | identifier | no larger than [`COUNT_MAX`] | [`RobotAct::judge`](crate::RobotAct::judge) |
//! | position of an utterance | the next one | [`inbox`](crate::inbox) |
//! | applied mark | not above what was sent | [`outbox`](crate::outbox) |
//! | time | one in the future counts as now | receivers |
//! | incarnation | one that the supervisor has started | readers of topics |
//!
//! Undetectable forgeries are accepted: a peer that holds a topic's only writer slot, in a running
//! incarnation, with the next number.

use crate::wire::WireError;

/// Largest number of events. No group counts that far, so a larger number is a defect of its
/// writer; JSON and browsers hold every number up to here.
pub const COUNT_MAX: u64 = 1 << 53;

/// Returns the number.
///
/// # Errors
/// Larger than [`COUNT_MAX`].
pub fn count(field: &'static str, number: u64) -> Result<u64, WireError> {
    if number <= COUNT_MAX { Ok(number) } else { Err(WireError::count(field, number)) }
}
