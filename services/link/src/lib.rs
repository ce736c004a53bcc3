//! A group over the internet: a robot's group seen and commanded from another machine.
//!
//! The crate has the messages and their rules: [`frame`] and [`mirrored`] (state), [`line`] (the
//! robot's voice), [`say`] (words), [`motion`] (orders to the motion stop), [`offset`] (time),
//! [`names`] and [`identity`], without transport and IO except for reading keys. The feature
//! `zenoh` adds the link: its ends `robot` and `mirror`, `router` between, and `keyring`.

pub mod frame;
pub mod identity;
pub mod line;
pub mod mirrored;
pub mod motion;
pub mod names;
pub mod offset;
pub mod presence;
pub mod say;
pub mod settings;
pub mod trouble;

#[cfg(feature = "zenoh")]
pub mod cli;
#[cfg(feature = "zenoh")]
pub mod fleet;
#[cfg(feature = "zenoh")]
pub mod keyring;
#[cfg(feature = "zenoh")]
pub mod mirror;
#[cfg(feature = "zenoh")]
pub mod robot;
#[cfg(feature = "zenoh")]
pub mod router;
#[cfg(feature = "zenoh")]
pub mod session;
#[cfg(feature = "zenoh")]
pub mod simulated;
#[cfg(feature = "zenoh")]
pub mod watch;

use config::{EVERYTHING, Part, PartService, Registered};

/// The service and the section of its settings. Each mirror begins with the settings in force.
pub static PART: Part = Part {
    name: settings::NAME,
    service: Some(PartService { reads: EVERYTHING, is_client: true }),
    sections: &[Registered::of::<settings::Settings>()],
};

/// The program, or the feature that a build needs for it.
#[cfg(feature = "zenoh")]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Ok(cli::run);
/// The program, or the feature that a build needs for it.
#[cfg(not(feature = "zenoh"))]
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Err("zenoh");
