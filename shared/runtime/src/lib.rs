//! The shell: the only place that opens topics, reads clocks, takes signals and writes files for
//! the services. iceoryx2 is reached through this crate alone.

pub mod admin;
pub mod audio;
pub mod bus;
pub mod client;
pub mod clock;
pub mod device;
pub mod driver;
pub mod exit;
pub mod group;
pub mod lifecycle;
pub mod logging;
mod notify;
