//! Flight recorder: inputs and statements of a reducer, so that another build, or the same one on a
//! desk, can get the same inputs and must make the same statements (docs/replay.md).
//!
//! A flight is one start of a service, or a part of it: one file, which can be replayed by itself,
//! because it begins with the journal or with a checkpoint of the reducer. Little-endian:
//!
//! ```text
//! file    magic 8 | format u32 | frame*
//! frame   len u32 | crc32c u32 | deflated bytes, one stream through all frames, flushed at each end
//! stream  Head | Beginning | Entry*                                        (postcard)
//! ```
//!
//! A frame holds a pass, after those of the last half second in which only time passed. It is
//! written as soon as the pass is over and is never synced: after a kill all finished passes are in
//! the file, after a power failure perhaps not.

mod difference;
mod reader;
mod replay;
mod tap;
mod writer;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use config::Settings;
use serde::{Deserialize, Serialize};

use crate::Time;
use crate::exit::{Exit, Failure};
use crate::lifecycle::Environment;
use crate::service_loop::Program;

pub use difference::first_difference;
pub use reader::{Direction, Line, head, lines, unread};
pub use replay::{Changed, Decision, Difference, Report, replay};
pub use tap::Tap;
pub use writer::{Ring, file_of, pack};

/// First bytes of a file.
const MAGIC: &[u8; 8] = b"WOFLIGHT";
/// Version of the file's layout.
const FORMAT: u32 = 1;
/// Bytes before a frame's content: length and checksum.
const FRAME_HEAD: usize = 8;
/// Most bytes of one frame, deflated and inflated.
const FRAME_BYTES_MAX: usize = 64 << 20;
/// End of a file's name.
pub const EXTENSION: &str = "flight";

/// Circumstances of a flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// The service, whose program replays the flight.
    pub service: String,
    /// Version of the program.
    pub version: String,
    /// Kind of record in the service's journal, if it has one.
    pub record: Option<String>,
    /// Name of the group.
    pub group: String,
    /// Epoch of the group.
    pub epoch: u64,
    /// Number of the start.
    pub incarnation: u32,
    /// Arguments of the program.
    pub arguments: Vec<String>,
    /// Time of the start, or of the checkpoint that the flight begins with; monotonic clock.
    pub started: Time,
    /// The same, nanoseconds since 1970.
    pub started_wall_ns: u64,
    /// The snapshot of the settings in force.
    pub settings: String,
}

impl Head {
    /// The circumstances of a program's start at `started`, which is `started_wall_ns` after 1970.
    pub fn of<P: Program>(
        environment: &Environment,
        settings: &Settings,
        started: Time,
        started_wall_ns: u64,
    ) -> Self {
        Self {
            service: P::SERVICE.name().to_owned(),
            version: build_info::full_version(),
            record: P::RECORD.map(str::to_owned),
            group: environment.paths.name().to_string(),
            epoch: environment.epoch.0,
            incarnation: environment.incarnation.0,
            arguments: environment.arguments.clone(),
            started,
            started_wall_ns,
            settings: settings.snapshot(),
        }
    }
}

/// Source from which a node was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Beginning<R, B> {
    /// The records of the node's journal.
    Journal(R),
    /// A checkpoint: the service had been started before.
    Checkpoint(B),
}

/// One step of a flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Entry<E, F> {
    /// The node was given this event at this time.
    Event(Time, E),
    /// The node learned that every record so far is durable.
    Durable,
    /// The statements of the node since the previous such entry: the end of a pass.
    Stated(F),
}

/// First byte of an encoded [`Entry::Stated`].
const STATED: u8 = 2;

/// Returns the flights of a folder, or the one that `source` is: by service, oldest first.
///
/// # Errors
/// The folder cannot be read.
pub fn list(source: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: io::Error| Failure::file(source, &error);
    if !fs::metadata(source).map_err(failed)?.is_dir() {
        return Ok(vec![source.to_owned()]);
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(source).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|extension| extension == EXTENSION) && path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Name of the file of a flight: names of one service sort by time.
fn file_name(service: &str, started_wall_ns: u64) -> String {
    format!("{service}-{:013}.{EXTENSION}", started_wall_ns / 1_000_000)
}

/// Returns whether `path` is named as a flight of `service`.
fn is_of(path: &Path, service: &str) -> bool {
    let number =
        path.file_stem().and_then(|stem| stem.to_str()?.strip_prefix(service)?.strip_prefix('-'));
    let is_flight = path.extension().is_some_and(|extension| extension == EXTENSION);
    is_flight && number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// A flight that this build cannot replay.
fn of_other_build(path: &Path, what: impl std::fmt::Display) -> Failure {
    let help = "help: replay it with the build that recorded it";
    Failure::new(Exit::Config, format!("{}: {what}; {help}", path.display()))
}
