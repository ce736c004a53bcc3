//! The group as a ROS 2 node: joint states, objects and dialogue as topics of standard types, words and
//! orders in, objects of detectors in.
//!
//! The crate is [`types`], the conversions to and from them, [`hear`] and [`orders`], all without a DDS
//! implementation. The node itself comes with the feature `dds`.

pub mod clock;
pub mod detectors;
pub mod diagnostics;
pub mod hear;
pub mod joints;
pub mod objects;
pub mod orders;
pub mod settings;
pub mod trajectory;
pub mod types;

#[cfg(feature = "dds")]
mod dds;
#[cfg(feature = "dds")]
pub mod node;
#[cfg(feature = "dds")]
mod process;

use config::{Part, PartService, Registered};

/// The service and its section.
pub static PART: Part = Part {
    name: settings::NAME,
    service: Some(PartService { reads: &["ros2", "arm"], is_client: true }),
    sections: &[Registered::of::<settings::Ros2>()],
};

/// The program, or the feature that a build needs for it.
#[cfg(feature = "dds")]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Ok(node::run);
/// The program, or the feature that a build needs for it.
#[cfg(not(feature = "dds"))]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Err("dds");
