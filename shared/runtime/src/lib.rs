//! Foundation of every process of a group: shared memory with its topics and wake-ups, the group's
//! folders, the lifecycle under a supervisor, clients, and the motion stop's own path.
//!
//! It reads no configuration and keeps no journal, so that a program outside this repository can be
//! built on it with few dependencies (`whichone-sdk`). Only this crate uses iceoryx2.

pub mod bus;
mod cleaner;
pub mod client;
pub mod clock;
pub mod epoch;
pub mod exit;
pub use safe_files::folders;
pub mod group;
pub mod lifecycle;
pub mod notify;
pub mod port_failures;
pub mod shm_cleanup;
pub mod stop_socket;
pub mod submission;
pub mod sync_time;
pub mod wakes;

pub use vocabulary::time::{Span, Time};
