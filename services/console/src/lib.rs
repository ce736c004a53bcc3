//! The console: a page in a browser from which a user talks to the robot and sees its belief.
//!
//! Two halves that never wait for each other. The [`bridge`] is the main thread: it owns every
//! topic, folds messages into a [`view_model`] and carries out the commands of viewers. The
//! [`server`] is a small asynchronous runtime that serves pages and sockets. Between them is the
//! [`hub`]: the bridge puts the newest text of each section on a board, from which every viewer
//! takes the unseen ones; a slow viewer skips versions, and no queue grows. The [`live`] view shows
//! robotics viewers every message; slow ones lose some. Studies, the history, the editor of scenes,
//! the interface for programs and the metrics are crates of their own.

#![allow(
    unreachable_pub,
    missing_docs,
    reason = "a program has no interface in Rust; `inputs` is for its tests"
)]

mod bridge;
mod hub;
mod live;
mod server;
mod service;
mod view_model;
mod viewer;
mod voice;

pub mod inputs;

pub use self::service::run;
