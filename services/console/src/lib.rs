//! The console: a page in a browser from which a person talks to the robot and sees what it thinks.
//!
//! Two halves that never wait for each other. The [`bridge`] is the main thread: it owns every topic,
//! folds what arrives into a [`picture`] and carries out what viewers ask for. The [`server`] is a
//! small asynchronous runtime that serves pages and sockets. Between them lies the [`hub`]: the
//! bridge pins the newest text of each section on a board, and every viewer takes from it what it has
//! not seen, as fast as it can read; a slow one misses what lay between and nobody keeps a queue.

pub mod bridge;
pub mod hub;
pub mod picture;
pub mod server;
pub mod service;
pub mod study;
pub mod voice;
