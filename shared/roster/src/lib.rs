//! The list of robots: names of robots and people, and what each robot says of itself.
//!
//! The link makes the list, and the gateway reads it: as lines of `whichone fleet --watch`, so that it knows no transport.

mod name;

use serde::{Deserialize, Serialize};

pub use name::{Name, NameError};

/// A robot in a few words.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Presence {
    /// Its name.
    pub robot: String,
    /// Its version of whichone.
    pub version: String,
    /// State of its group, as `whichone status` shows it; empty while its supervisor does not answer.
    pub state: String,
    /// The scene.
    pub scene: String,
    /// What the dialogue is at: `idle`, or the kind of the standing decision (`ask`, `pick` …).
    pub dialogue: String,
    /// The question that stands, or the robot's last line; empty for none.
    pub line: String,
    /// The likeliest object and its probability, while an interaction is open.
    pub likeliest: Option<(String, f64)>,
    /// What the arm does: the phase of its pick; `rest` for none.
    pub arm: String,
    /// Whether the motion stop is latched.
    pub stopped: bool,
}

/// A line of `whichone fleet --watch`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[expect(clippy::large_enum_variant, reason = "one is held at a time")]
pub enum Change {
    /// A robot is connected no more.
    Gone {
        /// Its name.
        gone: Name,
    },
    /// A robot is connected, or says something else of itself.
    Here {
        /// Its name.
        robot: Name,
        /// What it says of itself; `None` until it does.
        presence: Option<Presence>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_of_the_fleet_are_lines() {
        let r1 = Name::new("r1").unwrap();
        let here = Change::Here { robot: r1.clone(), presence: Some(Presence::default()) };
        let gone = Change::Gone { gone: r1.clone() };
        let silent = Change::Here { robot: r1, presence: None };
        for change in [here, gone, silent] {
            let line = serde_json::to_string(&change).unwrap();
            assert_eq!(serde_json::from_str::<Change>(&line).unwrap(), change, "{line}");
        }
    }
}
