//! Studies with simulated people: how often, how soon and with how many questions a robot that
//! decides by a certain policy brings the wanted object.
//!
//! This crate is pure: no IO, no clock, no threads. Interaction `n` of a study depends on the seed
//! and on `n` alone, so that interactions can be shared out among threads as one likes, and every
//! policy meets the same people. Interactions are counted in [`Tally`]s of a fixed number of them,
//! merged in their order: sums of floating-point numbers then do not depend on the threads either.
//! The crate `durations` has the durations.
//!
//! | what | where |
//! |---|---|
//! | one interaction with the dialogue manager, from the request to the hand-over | `interaction.rs` |
//! | several interactions with one person, whom the robot comes to know | `people.rs` |
//! | a planner that remembers its decisions | `cached_planner.rs` |
//! | the simulated user: errors, wording, recogniser, timing | `users/` |
//! | the same dialogues with people and robot talking in real time | `turns/` |
//! | sums over interactions, histograms | `tally.rs` |

mod cached_planner;
mod draw;
mod interaction;
mod people;
#[cfg(test)]
mod relations;
mod room;
mod tally;
#[cfg(test)]
mod testing;
pub mod turns;
pub mod users;

use dialogue::manager::Manager;
pub use interaction::{SimulatedInteraction, interact};
pub use people::acquainted;
pub use room::Room;

pub use cached_planner::{CachedPlanner, SharedDecisions};
pub use tally::{HISTOGRAM, Tally};
pub use users::{SimulatedUser, UserKind};

/// Interactions that are counted together.
pub const CHUNK: u64 = 500;

/// Counts the interactions `numbers` of `kind`'s people with the policy of `manager`.
pub fn interactions(
    room: &Room<'_>,
    manager: &mut Manager,
    kind: UserKind,
    seed: u64,
    numbers: std::ops::Range<u64>,
) -> Tally {
    let mut tally = Tally::default();
    for number in numbers {
        let mut user = kind.user(room.domain(), seed, number);
        let mut clock = draw::stream(seed, draw::Stream::Clock, number);
        tally.add(&interact(room, manager, &mut user, &mut clock));
    }
    tally
}
