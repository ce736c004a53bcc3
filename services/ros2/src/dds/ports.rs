//! Publishers, subscriptions and services, none of which waits.

use crate::types::{Empty, Triggered};
use ros2_client::{Message, MessageInfo, Publisher, Server, Subscription};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

/// Most messages of a topic that one pass takes.
const TAKEN_MAX: usize = 32;

impl Message for Empty {}
impl Message for Triggered {}

/// A publisher that never waits.
pub(crate) struct Outlet<M: Serialize>(pub(super) Publisher<M>);

impl<M: Serialize + Debug> Outlet<M> {
    /// Publishes, or counts the message as dropped where there is no room.
    pub(crate) fn publish(&self, message: M, dropped: &mut u64) {
        if let Err(error) = self.0.publish(message) {
            *dropped += 1;
            tracing::debug!(?error, "a message is dropped");
        }
    }
}

/// A subscription.
pub(crate) struct Inlet<M>(pub(super) Subscription<M>);

impl<M: DeserializeOwned + 'static> Inlet<M> {
    /// Hands waiting messages to `take`, up to a bound. Returns whether there may be more.
    pub(crate) fn drain(
        &self,
        unreadable: &mut u64,
        mut take: impl FnMut(M, &MessageInfo),
    ) -> bool {
        for _ in 0..TAKEN_MAX {
            match self.0.take() {
                Ok(Some((message, info))) => take(message, &info),
                Ok(None) => return false,
                Err(error) => {
                    *unreadable += 1;
                    tracing::debug!(?error, "a message is not readable");
                }
            }
        }
        true
    }
}

/// A service of type `std_srvs/Trigger`.
pub(crate) struct Trigger(pub(super) Server<Empty, Triggered>);

/// A call that waits for its response.
pub(crate) type Call = ros2_client::RmwRequestId;

impl Trigger {
    /// Returns waiting calls, up to a bound.
    pub(crate) fn calls(&self, unreadable: &mut u64) -> Vec<Call> {
        let mut calls = Vec::new();
        for _ in 0..TAKEN_MAX {
            match self.0.receive_request() {
                Ok(Some((call, _))) => calls.push(call),
                Ok(None) => break,
                Err(error) => {
                    *unreadable += 1;
                    tracing::debug!(?error, "a call is not readable");
                }
            }
        }
        calls
    }

    /// Responds to a call.
    pub(crate) fn respond(&self, call: Call, response: Triggered, dropped: &mut u64) {
        if let Err(error) = self.0.send_response(call, response) {
            *dropped += 1;
            tracing::debug!(?error, "a response is dropped");
        }
    }
}
