//! What a lab has decided before the first participant comes.

use serde::{Deserialize, Serialize};

use super::Item;

/// The protocol of a study. Every participant's journal holds the one that was in force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Protocol {
    /// The study's name, for participants and pictures.
    pub title: String,
    /// What participants agree to; empty for no such page.
    pub consent: String,
    /// The steps of the instructions.
    pub instructions: Vec<String>,
    /// Interactions that count: of a participant, within a design that compares within, of a
    /// participant and policy.
    pub interactions: u32,
    /// Practice interactions before them.
    pub warmup: u32,
    /// How the desired object is drawn.
    pub objects: Objects,
    /// Who meets which policy.
    pub design: Design,
    /// The policies, at least one.
    pub policies: Vec<String>,
    /// In which order they are met, within a participant.
    pub order: Order,
    /// Longest interaction, seconds.
    pub seconds_max: f64,
    /// Whether participants see what the robot believes.
    pub show_belief: bool,
    /// Whether the words said and asked are kept.
    pub keep_words: bool,
    /// What is asked at the end.
    pub questionnaire: Vec<Item>,
}

/// How the desired object is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Objects {
    /// Each time anew, every object alike.
    Uniform,
    /// Among those that this participant, and then the whole study, has had least often.
    Balanced,
}

/// Who meets which policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Design {
    /// Everybody meets all.
    Within,
    /// Everybody meets one.
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
