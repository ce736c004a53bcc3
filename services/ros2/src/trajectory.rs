//! The bridge between the arm's driver `trajectory` and the controllers of ros2_control: a process of its own, so that
//! the death of either process brings the arm to rest (docs/robots.md).
//!
//! [`controller`] and [`fingers`] keep the goals and decide by what was answered, [`joints`] reads measurements; none of
//! them sends anything, so that they are tested in one thread. The bridge itself comes with the feature `dds`.

pub mod actions;
pub mod controller;
pub mod fingers;
pub mod joints;
pub mod types;

#[cfg(feature = "dds")]
pub mod bridge;
#[cfg(feature = "dds")]
mod dds;
#[cfg(test)]
mod tests;

use config::{Part, PartService};

/// Values whose change restarts the service.
const READS: &[&str] = &["ros2", "arm.trajectory", "arm.robot", "arm.limb"];

/// The service, which shares the section of the ROS 2 node, and the arm's.
pub static PART: Part = Part {
    name: trajectory_driver::BRIDGE,
    service: Some(PartService { reads: READS, is_client: false }),
    sections: &[],
};

/// The program, or the feature that a build needs for it.
#[cfg(feature = "dds")]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Ok(bridge::run);
/// The program, or the feature that a build needs for it.
#[cfg(not(feature = "dds"))]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Err("dds");
