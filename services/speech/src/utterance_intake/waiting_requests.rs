//! Requests that wait for their turn, so that a client with many delays no other.
//!
//! Each client has a share of the utterances that are accepted and not yet applied. Its further
//! requests wait here, in order, and the clients take turns. A request that does not fit is not
//! acknowledged, and its client resends it.

use std::collections::VecDeque;

use messages::{ClientId, RequestKey};

use service::Time;

use super::origin::Origin;
use crate::utterance_content::UtteranceContent;

/// Utterances of one client that are accepted and not yet applied: as many as keep speech,
/// grounding and policy busy.
pub(super) const SHARE: usize = 4;
/// Waiting requests of one client.
const EACH_MAX: usize = 16;
/// Clients whose requests wait.
const CLIENTS_MAX: usize = 32;

/// A valid request without a number.
#[derive(serde::Serialize, serde::Deserialize)]
pub(super) struct Request {
    pub(super) origin: Origin,
    pub(super) content: UtteranceContent,
    /// Time of arrival.
    pub(super) received: Time,
}

/// The waiting requests of every client, the client whose turn it is first; empty without requests.
#[derive(Default, serde::Serialize, serde::Deserialize)]
pub(super) struct WaitingRequests {
    clients: VecDeque<(ClientId, VecDeque<Request>)>,
}

impl WaitingRequests {
    /// Returns whether a request is waiting.
    pub(super) fn contains(&self, key: RequestKey) -> bool {
        let of_client = self.clients.iter().filter(|(client, _)| *client == key.client());
        of_client.flat_map(|(_, requests)| requests).any(|request| request.origin.key == key)
    }

    /// Adds a request behind the others of its client. Returns `false` without room.
    pub(super) fn push(&mut self, request: Request) -> bool {
        let client = request.origin.key.client();
        let at = match self.clients.iter().position(|(other, _)| *other == client) {
            Some(at) => at,
            None if self.clients.len() >= CLIENTS_MAX => return false,
            None => {
                self.clients.push_back((client, VecDeque::new()));
                self.clients.len() - 1
            }
        };
        let requests = &mut self.clients[at].1;
        let has_room = requests.len() < EACH_MAX;
        if has_room {
            requests.push_back(request);
        }
        has_room
    }

    /// Takes the next client's oldest request, if it `may` be accepted; then others follow.
    pub(super) fn take(&mut self, may: impl Fn(&Request) -> bool) -> Option<Request> {
        let mut oldest = self.clients.iter().map(|(_, requests)| requests.front());
        let next = oldest.position(|request| request.is_some_and(&may))?;
        let (client, mut requests) = self.clients.remove(next)?;
        let request = requests.pop_front();
        if !requests.is_empty() {
            self.clients.push_back((client, requests));
        }
        request
    }
}
