//! Identifiers. Each is made once, by the side that owns it, and persisted before its first use, so
//! that a restart never gives one out twice.

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
        )]
        #[serde(transparent)]
        pub struct $name(pub u64);

        impl $name {
            /// The one that follows.
            pub fn next(self) -> Self {
                Self(self.0 + 1)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id! {
    /// Life of a group's journals: a new one begins when an operator starts the group afresh.
    /// Messages and journals of another epoch are refused, so old traffic can never match.
    Epoch
}
id! {
    /// Position of an accepted utterance; 1, 2, 3 … without a gap. 0 stands for "none yet".
    UtteranceSeq
}
id! {
    /// One fetch, from the first request to its outcome; monotone, never reused. 0: none.
    InteractionId
}
id! {
    /// One decision of the policy's, monotone. 0: none.
    ActId
}
id! {
    /// One question of the robot's. A repeated question keeps its id. 0: none.
    PromptId
}

/// Number of a service's start, given by its supervisor; a message of a lower one is stale.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct Incarnation(pub u32);

/// One attempt to fetch one object. The pair is the idempotency key of the motion.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct PickId {
    /// The interaction that decided it.
    pub interaction: InteractionId,
    /// 1 for the first attempt; another only where the one before ended without a grasp, because the
    /// scene was changed under it or the person wants another object.
    pub attempt: u32,
}

/// Idempotency key of an injected utterance: random, made by the injecting client, kept through
/// its retries.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct RequestKey(pub [u8; 16]);
