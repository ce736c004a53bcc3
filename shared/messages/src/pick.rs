//! The arm's answers to an ordered pick: the idempotent half of "never picks twice".

use crate::{PickId, PickOutcome, PickPhase};
use scene::ObjectId;
use serde::{Deserialize, Serialize};

/// The latest pick that the arm took on, as it is in the arm's journal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Its key.
    pub id: PickId,
    /// The object.
    pub object: ObjectId,
    /// Progress of the pick.
    pub phase: PickPhase,
    /// Outcome of the pick.
    pub outcome: PickOutcome,
}

/// Treatment of an ordered pick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Take it on.
    Accept,
    /// It is this one already; nothing to do but to report where it stands.
    Known,
    /// Another pick is still running; the order will come again.
    Busy,
    /// An older interaction than the latest; obsolete.
    Obsolete,
    /// The same key for another object: an invariant broke upstream.
    Conflict,
}

/// Judges the order `id` for `object` against the latest pick. A repeated key is known, whatever
/// became of it: that is what makes a re-sent order harmless.
pub fn judge(latest: Option<&Pick>, id: PickId, object: ObjectId) -> Order {
    let Some(pick) = latest else { return Order::Accept };
    if id == pick.id {
        return if object == pick.object { Order::Known } else { Order::Conflict };
    }
    if id < pick.id {
        return Order::Obsolete;
    }
    if pick.phase == PickPhase::Done { Order::Accept } else { Order::Busy }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InteractionId;

    fn id(interaction: u64, attempt: u32) -> PickId {
        PickId { interaction: InteractionId(interaction), attempt }
    }

    fn latest(phase: PickPhase) -> Pick {
        Pick { id: id(5, 1), object: ObjectId(2), phase, outcome: PickOutcome::Pending }
    }

    #[test]
    fn pick_order_repeated_never_starts_again() {
        for phase in [PickPhase::Accepted, PickPhase::Closing, PickPhase::Done] {
            assert_eq!(judge(Some(&latest(phase)), id(5, 1), ObjectId(2)), Order::Known);
        }
    }

    #[test]
    fn pick_order_waits_for_the_current_pick() {
        let order = |phase| judge(Some(&latest(phase)), id(6, 1), ObjectId(0));
        assert_eq!(order(PickPhase::Holding), Order::Busy);
        assert_eq!(order(PickPhase::Done), Order::Accept);
        assert_eq!(judge(Some(&latest(PickPhase::Done)), id(5, 2), ObjectId(2)), Order::Accept);
    }

    #[test]
    fn pick_orders_that_are_old_or_contradictory_are_distinguished() {
        let pick = latest(PickPhase::Done);
        assert_eq!(judge(Some(&pick), id(4, 1), ObjectId(2)), Order::Obsolete);
        assert_eq!(judge(Some(&pick), id(5, 1), ObjectId(3)), Order::Conflict);
        assert_eq!(judge(None, id(1, 1), ObjectId(3)), Order::Accept);
    }
}
