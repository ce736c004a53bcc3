//! Recordings of a group: MCAP files that robotics tools open.
//!
//! [`channels`] lists the possible content of a file: every topic of the group with the schema of
//! its messages, and the [`picture`] of the group in schemas that viewers draw. [`file`] writes one
//! file, [`ring`] a ring of them in bounded space, [`recover`] completes the file of a killed
//! writer, and [`list`] reads them. [`group_reader`] reads the messages of all channels from a
//! running group, for a recorder and for a live view, whose messages are those of [`live`];
//! [`log_tail`] reads the log of one service.
//!
//! Times in a file are wall-clock times. The messages themselves keep the machine's monotonic
//! clock; the offset between both is constant within a file and part of its metadata.

use std::io::ErrorKind;

use service::exit::{Exit, Failure};

pub mod channels;
pub mod clock;
pub mod file;
pub mod foxglove;
mod frames;
pub mod group_reader;
pub mod journals;
mod json_schema;
pub mod list;
pub mod live;
mod log_lines;
pub mod log_tail;
pub mod payload;
pub mod picture;
mod records;
pub mod recover;
pub mod ring;
pub mod settings;
mod zstd;

pub use records::LeftOut;

/// End of the name of a complete recording.
pub const EXTENSION: &str = "mcap";
/// End of the name of a recording that is being written, or whose writer was killed.
pub const UNFINISHED: &str = "mcap.part";

/// A recording cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// An error of the operating system.
    #[error("{0}: {1}")]
    Io(std::path::PathBuf, std::io::Error),
    /// The file is not MCAP, or is damaged.
    #[error("{0}: {1}")]
    Mcap(std::path::PathBuf, mcap::McapError),
    /// A payload that does not match its topic.
    #[error("topic {0}: {1}")]
    Payload(String, String),
}

impl From<RecordingError> for Failure {
    fn from(error: RecordingError) -> Self {
        match &error {
            RecordingError::Io(path, cause) if cause.kind() == ErrorKind::AlreadyExists => {
                let help = "help: name another file, or remove this one";
                let what = format!("{}: it exists already; {help}", path.display());
                Self::new(Exit::Storage, what)
            }
            _ => Self::new(Exit::Storage, error.to_string()),
        }
    }
}

impl RecordingError {
    pub(crate) fn io(path: &std::path::Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |error| Self::Io(path, error)
    }

    pub(crate) fn mcap(path: &std::path::Path) -> impl FnOnce(mcap::McapError) -> Self + use<> {
        let path = path.to_owned();
        move |error| match error {
            mcap::McapError::Io(error) => Self::Io(path, error),
            error => Self::Mcap(path, error),
        }
    }
}
