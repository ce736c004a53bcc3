//! Evaluation of the robot's decisions, with simulated users and with people.
//!
//! This crate is pure: no IO, no clock, no threads.
//!
//! | module | contents |
//! |---|---|
//! | [`simulation`] | simulated users, and interactions with them |
//! | [`user_study`] | studies with people: journals, results |
//! | [`charts`] | charts of both |
//! | [`export`] | the decision problem for public solvers |

pub mod charts;
pub mod export;
pub mod simulation;
pub mod user_study;
mod verdict;

pub use verdict::Verdict;

/// Returns the items in order of appearance, each once.
pub fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    for item in items {
        if !list.contains(&item) {
            list.push(item);
        }
    }
    list
}
