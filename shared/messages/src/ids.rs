//! Identifiers of the transport. Those of the dialogue are defined in [`vocabulary::ids`].

use serde::{Deserialize, Serialize};

/// Life of a group's journals: a new one begins when an operator starts the group afresh.
/// Messages and journals of another epoch are rejected, so old traffic can never match.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct Epoch(pub u64);

impl Epoch {
    /// Returns the epoch that follows.
    #[must_use]
    pub fn next(self) -> Self {
        Self(self.0.saturating_add(1))
    }
}

impl std::fmt::Display for Epoch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// Number of a service's start, assigned by its supervisor; a message of a lower one is stale.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct Incarnation(pub u32);

/// A client of the speech service, for its fair share: one program, or one viewer of the console.
/// Random.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct ClientId(pub u64);

/// Idempotency key of an injected utterance, kept through its retries: eight bytes that name the
/// client, and eight random ones that name the request.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct RequestKey(pub [u8; 16]);

impl RequestKey {
    /// A request of `client`; `request` is random.
    pub fn new(client: ClientId, request: u64) -> Self {
        let mut key = [0; 16];
        let (first, second) = key.split_at_mut(8);
        first.copy_from_slice(&client.0.to_le_bytes());
        second.copy_from_slice(&request.to_le_bytes());
        Self(key)
    }

    /// Returns the client that made the request.
    pub fn client(self) -> ClientId {
        let [a, b, c, d, e, f, g, h, ..] = self.0;
        ClientId(u64::from_le_bytes([a, b, c, d, e, f, g, h]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn request_key_names_its_client() {
        let key = RequestKey::new(ClientId(u64::MAX - 6), 5);
        assert_eq!(key.client(), ClientId(u64::MAX - 6));
        assert_ne!(key, RequestKey::new(ClientId(u64::MAX - 6), 6));
    }
}
