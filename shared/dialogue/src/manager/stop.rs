//! The motion stop in the dialogue's state, and its form in journals.

use serde::{Deserialize, Serialize};
use vocabulary::time::Time;

/// The motion stop, as the arm reports it and as a user ordered it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "StoredStop", into = "StoredStop")]
pub struct Stop {
    /// State of the motion stop as the arm reports it.
    pub motion: MotionStop,
    /// A stop that a user ordered in words and whose effect the robot has not reported yet.
    pub order: Option<StopOrder>,
}

/// The motion stop as the arm reports it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum MotionStop {
    /// The arm may move.
    #[default]
    Released,
    /// Latched, and the arm is at rest.
    Stopped,
    /// Latched; the arm is not at rest yet.
    Stopping,
}

impl MotionStop {
    /// Returns whether the arm accepts no motion until it is released.
    pub fn is_latched(self) -> bool {
        self != Self::Released
    }
}

/// A stop that a user ordered in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StopOrder {
    /// When its words were accepted; only a later report of the arm confirms it.
    pub accepted: Time,
    /// Whether the user was warned that it is not confirmed.
    pub is_late: bool,
}

/// The stop in a journal; earlier journals have `stopped: bool`, which the same bytes encode.
/// Orders are variants that came later.
#[derive(Serialize, Deserialize)]
enum StoredStop {
    Released,
    Stopped,
    Stopping,
    ReleasedOrdered(StopOrder),
    StoppedOrdered(StopOrder),
    StoppingOrdered(StopOrder),
}

impl From<StoredStop> for Stop {
    fn from(stored: StoredStop) -> Self {
        let (motion, order) = match stored {
            StoredStop::Released => (MotionStop::Released, None),
            StoredStop::Stopped => (MotionStop::Stopped, None),
            StoredStop::Stopping => (MotionStop::Stopping, None),
            StoredStop::ReleasedOrdered(order) => (MotionStop::Released, Some(order)),
            StoredStop::StoppedOrdered(order) => (MotionStop::Stopped, Some(order)),
            StoredStop::StoppingOrdered(order) => (MotionStop::Stopping, Some(order)),
        };
        Self { motion, order }
    }
}

impl From<Stop> for StoredStop {
    fn from(Stop { motion, order }: Stop) -> Self {
        match (motion, order) {
            (MotionStop::Released, None) => Self::Released,
            (MotionStop::Stopped, None) => Self::Stopped,
            (MotionStop::Stopping, None) => Self::Stopping,
            (MotionStop::Released, Some(order)) => Self::ReleasedOrdered(order),
            (MotionStop::Stopped, Some(order)) => Self::StoppedOrdered(order),
            (MotionStop::Stopping, Some(order)) => Self::StoppingOrdered(order),
        }
    }
}
