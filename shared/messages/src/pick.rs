//! The arm's answers to an ordered pick: the idempotent half of "never picks twice".

use crate::{PickId, PickOutcome, PickPhase, Task};
use scene::ObjectId;
use serde::{Deserialize, Serialize};

/// The latest pick that the arm took on, as it is in the arm's journal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Its key.
    pub id: PickId,
    /// The object.
    pub object: ObjectId,
    /// What is done with it.
    pub task: Task,
    /// Progress of the pick.
    pub phase: PickPhase,
    /// Outcome of the pick.
    pub outcome: PickOutcome,
}

impl Pick {
    /// Returns whether the object is let go in its place: it is to be put back, or was called off
    /// while it was held.
    pub fn ends_at_place(&self) -> bool {
        self.task == Task::PutBack || self.phase == PickPhase::Returning
    }
}

/// Treatment of an ordered pick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Accept the order.
    Accept,
    /// The order is known already; only its state is to be reported.
    Known,
    /// Another pick is still running; the order will come again.
    Busy,
    /// An older interaction than the latest; obsolete.
    Obsolete,
    /// The same key for another object or task: an invariant broke upstream.
    Conflict,
}

/// Judges the order `id` of `task` for `object` against the latest pick. A repeated key is known,
/// whatever its outcome, so a re-sent order is harmless. A cancelled order has no task.
pub fn judge(latest: Option<&Pick>, id: PickId, object: ObjectId, task: Option<Task>) -> Order {
    let Some(pick) = latest else { return Order::Accept };
    if id == pick.id {
        // An order cancelled before it arrived never had a task.
        let called_off = pick.outcome == PickOutcome::Cancelled;
        let same_task = called_off || task.is_none_or(|task| task == pick.task);
        return if object == pick.object && same_task { Order::Known } else { Order::Conflict };
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
        let (object, outcome) = (ObjectId(2), PickOutcome::Pending);
        Pick { id: id(5, 1), object, task: Task::Fetch, phase, outcome }
    }

    fn judge(latest: Option<&Pick>, id: PickId, object: ObjectId) -> Order {
        super::judge(latest, id, object, Some(Task::Fetch))
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

    #[test]
    fn pick_key_is_of_one_task_and_what_was_called_off_has_none() {
        let judge = |pick: &Pick, task| super::judge(Some(pick), id(5, 1), ObjectId(2), task);
        let moving = latest(PickPhase::Moving);
        assert_eq!(judge(&moving, Some(Task::PutBack)), Order::Conflict);
        assert_eq!(judge(&moving, None), Order::Known);
        let outcome = PickOutcome::Cancelled;
        let called_off = Pick { outcome, ..latest(PickPhase::Done) };
        assert_eq!(judge(&called_off, Some(Task::PutBack)), Order::Known);
    }
}
