//! Evaluation of the robot's decisions, with simulated users and with people.
//!
//! This crate is pure: no IO, no clock, no threads.
//!
//! | module | contents |
//! |---|---|
//! | [`simulation`] | simulated users, and interactions with them |
//! | [`user_study`] | studies with people: journals, results |
//! | [`charts`] | charts of both |

pub mod charts;
pub mod simulation;
pub mod user_study;
