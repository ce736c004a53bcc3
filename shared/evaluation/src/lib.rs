//! Evaluation of the robot's decisions with simulated users; with people in `user_study`.
//!
//! This crate is pure: no IO, no clock, no threads.
//!
//! | module | contents |
//! |---|---|
//! | [`simulation`] | simulated users, and interactions with them |
//! | [`export`] | the decision problem for public solvers |

pub mod export;
pub mod simulation;
