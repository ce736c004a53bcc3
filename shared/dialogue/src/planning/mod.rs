//! What planners look ahead with: the reduced problem, bounds, one step ahead, and search.
//!
//! All of it is deterministic and counts its work in beliefs looked at, never in time.

mod bound;
mod cell;
mod channel;
mod classes;
mod column;
mod doubt;
mod glance;
mod outcome;
mod reduced;
mod search;

#[cfg(test)]
mod tests;

pub(crate) use bound::Bound;
pub(crate) use channel::Query;
pub(crate) use glance::{Choice, Glance, Glancer};
pub(crate) use outcome::outcomes;
pub(crate) use reduced::Reduced;
pub(crate) use search::{Effort, Search};
