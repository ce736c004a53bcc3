//! Dialogues in real time: who speaks when, and which question an answer counts for.
//!
//! In a dialogue of turns, as [`crate::simulation::interact`] conducts it, an answer follows its
//! question. In real time the robot listens for a while, plans, and may ask the next question just
//! as the person answers the last. The paper lost many of its interactions to that (section 6).
//! This is a simulation of discrete events with the robot's rules of turn-taking as parts to be
//! combined. A pick is final in it.
//!
//! | file | holds |
//! |---|---|
//! | `rules.rs` | the rules and their names |
//! | `talk.rs` | the robot's side, and the dialogue |

mod rules;
mod talk;

pub use rules::{Rules, UnknownRule};

use crate::simulation::draw::{Stream, stream};
use crate::simulation::room::Room;
use crate::simulation::tally::Tally;
use crate::simulation::users::TimedKind;
use dialogue::manager::Manager;

/// Counts the dialogues `numbers` under these rules.
pub fn dialogues(
    room: &Room<'_>,
    manager: &mut Manager,
    rules: &Rules,
    kind: &TimedKind,
    seed: u64,
    numbers: std::ops::Range<u64>,
) -> Tally {
    let mut tally = Tally::default();
    for number in numbers {
        let rng = stream(seed, Stream::Turns, number);
        tally.add(&talk::talk(room, manager, rules, kind, rng));
    }
    tally
}

#[cfg(test)]
mod tests;
