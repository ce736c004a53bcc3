//! The whole state of the reducer, for flights that begin in the middle of a start.

use dialogue::manager::{Cause, Floor, Record, State};
use serde::{Deserialize, Serialize};
use service::{Node, NodeError, Time};
use vocabulary::ids::PromptId;

use crate::{Config, PolicyNode};

/// Content of a record, and further state.
#[derive(Serialize, Deserialize)]
struct Checkpoint {
    state: State,
    floor: Floor,
    said: (PromptId, u32),
    heard_of_speech: Time,
    rested: Option<Time>,
    rejected: u64,
    waiting_since: Option<Time>,
    next_send: Time,
    forgot: u64,
}

impl PolicyNode {
    /// Returns the state; `None` if objects are tracked, which checkpoints do not cover.
    pub(crate) fn whole_state(&self) -> Option<Vec<u8>> {
        if self.perceived.is_some() {
            return None;
        }
        let checkpoint = Checkpoint {
            state: self.state.clone(),
            floor: self.floor,
            said: self.said,
            heard_of_speech: self.heard_of_speech,
            rested: self.rested,
            rejected: self.rejected,
            waiting_since: self.waiting_since,
            next_send: self.next_send,
            forgot: self.forgot,
        };
        postcard::to_stdvec(&checkpoint).ok()
    }

    /// Returns the node of the checkpoint.
    pub(crate) fn with_whole_state(config: Config, bytes: &[u8]) -> Result<Self, NodeError> {
        let it: Checkpoint =
            postcard::from_bytes(bytes).map_err(|_| NodeError::foreign_checkpoint())?;
        let record = Record { cause: Cause::Snapshot, at: Time(0), state: it.state };
        let node = Self::recover(config, vec![record])?;
        Ok(Self {
            floor: it.floor,
            said: it.said,
            heard_of_speech: it.heard_of_speech,
            rested: it.rested,
            rejected: it.rejected,
            waiting_since: it.waiting_since,
            next_send: it.next_send,
            forgot: it.forgot,
            ..node
        })
    }
}
