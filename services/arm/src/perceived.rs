//! Objects from perception: the arm plans to where they are estimated to be, plans again when the one
//! that it fetches has moved, and gives up when that is gone.

use crate::executor::Purpose;
use crate::world::World;
use crate::{ArmNode, Fx};
use messages::pick::Pick;
use messages::{PickOutcome, PickPhase, TableView, Task};
use service::{Span, Time};
use std::sync::Arc;

/// Time for which the arm waits for a table that has the ordered object.
const UNKNOWN_MAX: Span = Span::from_ms(3_000);

impl ArmNode {
    /// Takes over the objects of a table.
    pub(crate) fn lay(&mut self, table: &TableView) {
        if !self.config.perceives {
            return;
        }
        let world = World::of_table(&self.config.setup.robot, &self.config.scene, table);
        self.urgent |= world != *self.world;
        self.world = Arc::new(world);
    }

    /// Watches the ordered object until the fingers close on it.
    pub(crate) fn watch_target(&mut self, now: Time, fx: &mut Fx) {
        let target = self.target().copied().filter(|_| self.config.perceives);
        let Some(pick) = target else {
            self.unknown_since = None;
            return;
        };
        if !self.world.has(pick.object) {
            let since = *self.unknown_since.get_or_insert(now);
            if now >= since + UNKNOWN_MAX {
                tracing::error!(object = pick.object.0, "the table does not have the object");
                self.end(PickOutcome::Vanished, now, fx);
            }
            return;
        }
        self.unknown_since = None;
        if self.world.is_gone(pick.object) {
            tracing::warn!(object = pick.object.0, "the object is no longer there");
            return self.end(PickOutcome::Vanished, now, fx);
        }
        let is_under_way = self.executor.purpose() == Some(Purpose::Pick(pick.id));
        if is_under_way && self.world.has_moved(pick.object, &self.planned_world) {
            tracing::info!(object = pick.object.0, "the object has moved; planning again");
            self.executor.halt();
        }
    }

    /// Returns the pick whose object is still to be grasped, with fingers that have not begun to close.
    fn target(&self) -> Option<&Pick> {
        let pick = self.state.open_pick().filter(|pick| pick.task == Task::Fetch)?;
        (pick.phase <= PickPhase::Moving).then_some(pick)
    }

    /// Returns whether the pick's object is known to the arm, so that its motion can be planned.
    pub(crate) fn knows_target(&self) -> bool {
        !self.config.perceives || self.target().is_none_or(|pick| self.world.has(pick.object))
    }
}
