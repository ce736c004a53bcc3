//! Decision problems in Cassandra's `.pomdp` text, the format that public solvers read.
//!
//! [`of_dialogue`] makes a [`Pomdp`] of the problem that the planners solve, [`Pomdp::write`]
//! prints it, [`Pomdp::parse`] reads the format in general (A. R. Cassandra, "The POMDP file
//! format"). What is written parses to an equal problem, number by number.
//!
//! This crate is pure: no IO, no clock, no threads.

mod decision;
mod matrix;
mod model;
mod name;
mod parse;
mod reward;
mod write;

#[cfg(test)]
mod tests;

pub use decision::{TooLarge, of_dialogue};
pub use matrix::{Matrix, Row};
pub use model::{PAIRS_MAX, Pomdp, Start, Values};
pub use name::{escape, unescape};
pub use parse::ParseError;
pub use reward::{Reward, Rewards};
