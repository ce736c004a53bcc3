//! Recorder: writes every topic of the group into a ring of MCAP files.
//!
//! It is an observer: it writes no topic, no writer waits for it, and the group is whole without
//! it. It looks at all topics four to ten times a second, with buffers for the messages sent
//! meanwhile; missed ones show as a gap of sequence numbers.

mod service;

use config::{EVERYTHING, Part, PartService, Registered};

pub use self::service::run;

/// The service and the section of its settings. Each recording holds the settings in force.
pub static PART: Part = Part {
    name: "recorder",
    service: Some(PartService { reads: EVERYTHING, is_client: false }),
    sections: &[Registered::of::<recording::settings::Recorder>()],
};

/// The program.
pub const PROGRAM: Result<fn() -> std::process::ExitCode, &str> = Ok(run);
