//! The real supervisor and the real processes, driven as their users drive them: through the
//! command line. Every test has a group of its own, so they run side by side.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod absence;
mod batch;
mod changes;
mod config;
mod console;
mod console_study;
mod console_voice;
mod dialogues;
mod export;
mod gestures;
mod hearing;
mod isolation;
mod people;
mod person;
mod planners;
mod python;
mod recovery;
mod robot;
mod speech;
mod spoken;
mod supervision;
mod swap;
