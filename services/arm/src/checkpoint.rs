//! The whole state of a reducer at rest, for flights that begin in the middle of a start.

use messages::MotionInhibit;
use scene::ObjectId;
use serde::{Deserialize, Serialize};
use service::{NodeError, Time};

use crate::goal::PlanFailures;
use crate::orders::StandingAct;
use crate::publish::Published;
use crate::state::ArmState;
use crate::trajectory_view::MotionView;
use crate::{ArmNode, Config};

/// What a record holds, and what it does not.
#[derive(Serialize, Deserialize)]
struct Checkpoint {
    state: ArmState,
    driver: Vec<u8>,
    published: Published,
    motion_view: MotionView,
    act: StandingAct,
    aimed: Option<ObjectId>,
    /// Number of the latest plan.
    planned: u64,
    plan_failures: PlanFailures,
    stepped: Time,
    recorded: Time,
    urgent: bool,
    scene_changed: bool,
    inhibit: MotionInhibit,
}

impl ArmNode {
    /// Returns the state; `None` where the arm moves, plans, waits for the disk or for an answer, or where
    /// objects come from perception.
    pub(crate) fn whole_state(&self) -> Option<Vec<u8>> {
        let Self { config, state, driver, executor, publisher, motion_view, act, aimed, .. } = self;
        let Self { planning, plan_failures, stepped, recorded, urgent, scene_changed, .. } = self;
        let Self { inhibit, ending, unsynced, phase_unsynced, callers, .. } = self;
        let waits = *ending || *unsynced || *phase_unsynced || !callers.is_empty();
        if waits || config.perceives || !executor.is_standing() || !planning.is_idle() {
            return None;
        }
        let checkpoint = Checkpoint {
            state: state.clone(),
            driver: driver.checkpoint()?,
            published: publisher.published.clone(),
            motion_view: motion_view.clone(),
            act: *act,
            aimed: *aimed,
            planned: planning.number(),
            plan_failures: *plan_failures,
            stepped: *stepped,
            recorded: *recorded,
            urgent: *urgent,
            scene_changed: *scene_changed,
            inhibit: *inhibit,
        };
        postcard::to_stdvec(&checkpoint).ok()
    }

    /// Returns the node of this state.
    pub(crate) fn with_whole_state(config: Config, bytes: &[u8]) -> Result<Self, NodeError> {
        let foreign = NodeError::foreign_checkpoint;
        let it: Checkpoint = postcard::from_bytes(bytes).map_err(|_| foreign())?;
        let mut driver = config.open(&it.state);
        driver.resume(&it.driver).ok_or_else(foreign)?;
        let mut node = Self::with_driver(config, it.state, driver);
        node.publisher.published = it.published;
        node.planning.go_on_from(it.planned);
        Ok(Self {
            motion_view: it.motion_view,
            act: it.act,
            aimed: it.aimed,
            plan_failures: it.plan_failures,
            stepped: it.stepped,
            recorded: it.recorded,
            urgent: it.urgent,
            scene_changed: it.scene_changed,
            inhibit: it.inhibit,
            ..node
        })
    }
}
