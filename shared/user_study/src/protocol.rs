//! The protocol of a user study.

use serde::{Deserialize, Serialize};

use crate::Item;

/// The protocol of a study. Every participant's journal holds the one that was in force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Protocol {
    /// The study's name, for participants and pictures.
    pub title: String,
    /// Consent text; empty for none.
    pub consent: String,
    /// The steps of the instructions.
    pub instructions: Vec<String>,
    /// Interactions that count: of a participant, within a design that compares within, of a
    /// participant and policy.
    pub interactions: u32,
    /// Practice interactions before the trials.
    pub warmup: u32,
    /// Draw of the desired object.
    pub objects: Objects,
    /// Assignment of policies to participants.
    pub design: Design,
    /// The policies, at least one.
    pub policies: Vec<String>,
    /// Order of the policies within a participant.
    pub order: Order,
    /// Longest interaction, seconds.
    pub seconds_max: f64,
    /// Show the belief to participants.
    pub show_belief: bool,
    /// Store the words of user and robot.
    pub keep_words: bool,
    /// The questionnaire at the end.
    pub questionnaire: Vec<Item>,
}

/// Draw of the desired object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Objects {
    /// Independent each time, uniform.
    Uniform,
    /// Among those that this participant, and then the whole study, has had least often.
    Balanced,
}

/// Assignment of policies to participants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Design {
    /// Every participant meets all.
    Within,
    /// Every participant meets one.
    Between,
}

/// The order of the policies within a participant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// Shuffled for each participant.
    Random,
    /// Rows of a Latin square in turn, in which each policy also follows each other alike.
    Latin,
}
