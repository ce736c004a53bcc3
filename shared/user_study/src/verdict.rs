//! Verdicts on interactions, given the desired object.

use serde::{Deserialize, Serialize};
use vocabulary::{Costs, Outcome};

/// Verdict on an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The desired object was handed over.
    Right,
    /// Another one was.
    Wrong,
    /// The arm could not.
    Failed,
    /// The participant cancelled.
    Cancelled,
    /// The participant fell silent, or no question helped.
    Abandoned,
    /// The robot concluded that the object is not there.
    NotHere,
    /// The interaction took longer than the protocol allows.
    TooLong,
}

impl Verdict {
    /// Every verdict with its name in the data.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Right, "right"),
        (Self::Wrong, "wrong"),
        (Self::Failed, "failed"),
        (Self::Cancelled, "cancelled"),
        (Self::Abandoned, "abandoned"),
        (Self::NotHere, "not_here"),
        (Self::TooLong, "too_long"),
    ];

    /// Returns the verdict on an interaction with that outcome; `None` if the scene was changed.
    /// `right` says whether the object that was handed over is the desired one.
    pub fn of(outcome: Outcome, right: bool) -> Option<Self> {
        Some(match outcome {
            Outcome::Delivered if right => Self::Right,
            Outcome::Delivered | Outcome::Refused => Self::Wrong,
            Outcome::Failed => Self::Failed,
            Outcome::Cancelled => Self::Cancelled,
            Outcome::Abandoned => Self::Abandoned,
            Outcome::NotHere => Self::NotHere,
            Outcome::SceneChanged => return None,
        })
    }

    /// Returns the verdict's name in the data.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(verdict, _)| *verdict == self).map_or("", |(_, name)| name)
    }

    /// Returns the reward of an interaction that ends so; without a pick it is that of waiting for
    /// ever.
    pub fn worth(self, costs: &Costs) -> f64 {
        match self {
            Self::Right => costs.correct,
            Self::Wrong => -costs.wrong,
            _ => costs.wait_value(),
        }
    }
}
