//! Foundations of the planners: the reduced problem, bounds, one-step look-ahead, and search.
//!
//! All of it is deterministic and counts its work in beliefs looked at, never in time.

mod announced;
mod block;
mod bound;
mod channel;
mod doubt;
mod equivalence_classes;
mod one_step_lookahead;
mod outcome;
mod partition;
mod reduced;
mod revealed;
mod search;
mod told;

#[cfg(test)]
mod tests;

pub(crate) use bound::{Bound, Value};
pub(crate) use channel::{Price, Query};
pub(crate) use one_step_lookahead::{Choice, OneStepEvaluator, OneStepLookahead};
pub(crate) use outcome::outcomes;
pub(crate) use reduced::Reduced;
pub(crate) use revealed::Revealed;
pub(crate) use search::{Certify, Effort, Move, Search};
