//! Identifiers of the dialogue. Each is assigned once, by the service that owns it, and made
//! durable before its first use, so that a restart never assigns one twice.

use std::fmt;

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
            /// Returns the next identifier.
            #[must_use]
            pub fn next(self) -> Self {
                Self(self.0.saturating_add(1))
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
    /// Position of an accepted utterance: 1, 2, 3 … without a gap. 0: none yet.
    UtteranceSeq
}
id! {
    /// One interaction, from the first request to its outcome; increasing, never reused. 0: none.
    InteractionId
}
id! {
    /// One decision of the policy, increasing. 0: none.
    ActId
}
id! {
    /// One line of the robot. A repeated question keeps its id. 0: none.
    PromptId
}
id! {
    /// One motion stop, increasing: a release names the one that its giver saw. 0: none, or any.
    StopId
}

/// One attempt to fetch one object, or to put it back. The pair is the motion's idempotency key.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct PickId {
    /// The interaction that decided the pick.
    pub interaction: InteractionId,
    /// 1 for the first order. Another follows only if the previous one ended without a grasp,
    /// because the scene changed or the user wants another object, or to put an object back.
    pub attempt: u32,
}

/// "3.1": the first order of interaction 3.
impl fmt::Display for PickId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.interaction.0, self.attempt)
    }
}
