//! The supervisor of a process group: starts its services in order, watches, restarts and stops
//! them, and answers the operator.
//!
//! One thread, one poll, and nothing in it ever waits for a service: datagrams come in, signals go
//! out. A second thread removes the shared memory of dead processes. Of a service there are never
//! two incarnations at once, it is never started more often than its limits allow, and when the group
//! is down no process of it is left. What to do is decided by pure state ([`machine`], [`group`],
//! [`swap`]); the rest carries it out.
//!

use std::time::Duration;

pub mod cli;
pub mod configuration;
pub mod group;
pub mod machine;
pub mod schedule;
pub mod swap;

mod before_exec;
mod child;
mod epoch;
mod lifeline;
mod notify;
mod previous_run;
mod procfs;
mod restart_limiter;
mod server;
mod service;
mod signals;
mod spawn;
mod supervisor;

pub use epoch::EpochError;
pub use previous_run::PreviousRunError;
pub use spawn::SpawnError;
pub use supervisor::{StartError, Supervisor};

/// Time since the supervisor's start, on the monotonic clock.
pub type Time = Duration;
