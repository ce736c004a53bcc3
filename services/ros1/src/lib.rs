//! The bridge between a Baxter's ROS 1 topics and the group's: a ROS 1 client of its own, with threads
//! and without asynchronous code, which goes on through restarts of robot, master and network.
//!
//! [`node`] registers at the master, [`subscription`] and [`publication`] hold the connections,
//! [`convert`] copies fields, [`detectors`] reads objects, and [`bridge`] is the service.

pub mod address;
pub mod bridge;
pub mod connection;
pub mod convert;
pub mod detectors;
pub mod node;
pub mod publication;
pub mod settings;
mod slots;
pub mod subscription;
#[cfg(test)]
mod tests;
pub mod types;
pub mod xmlrpc;

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use config::{Part, Registered};
use service::exit::Exit;

/// The section of the bridge; its service is `baxter`, whose program it replaces.
pub static PART: Part =
    Part { name: "ros1", service: None, sections: &[Registered::of::<settings::Ros1>()] };

/// The program.
pub const PROGRAM: Result<fn() -> ExitCode, &str> = Ok(run);

static REPLACED: AtomicBool = AtomicBool::new(false);

/// Runs the service's program.
pub fn run() -> ExitCode {
    let code = service::service_loop::run::<bridge::Ros1Program>();
    if was_replaced() { Exit::Config.code() } else { code }
}

/// Notes that the master has asked this node to end.
fn replaced(reason: &str) {
    let help = "stop the other one, then `whichone start baxter`";
    tracing::error!(reason, "the ROS master has asked {} to end; help: {help}", node::NAME);
    REPLACED.store(true, Ordering::Release);
}

/// Returns whether the bridge ends because another node has taken its place. Restarted, it would take
/// the place back, and so on.
fn was_replaced() -> bool {
    REPLACED.load(Ordering::Acquire)
}

/// Locks; what a panicking thread left behind is a whole value.
fn guarded<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
