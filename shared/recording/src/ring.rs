//! A ring of recordings in bounded space: the oldest give way, and the disk is never filled.
//!
//! Order and age of the files follow from the amount recorded since, not from the wall clock, which
//! may be wrong by years until it is set.

use std::collections::HashMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use service::{Span, Time};

use crate::RecordingError;
use crate::channels::{self, Channel};
use crate::clock::WallClock;
use crate::file::{Attached, Recording};
use crate::group_reader::Sample;
use crate::list::{Entry, entries, number};
use crate::settings::Recorder;

/// Interval of [`Ring::tend`]; a writer that is killed loses as much at most.
pub const TEND_EVERY: Span = Span::from_ms(1_000);
/// Pause after a failure to write.
const RETRY_AFTER: Span = Span::from_ms(5_000);
/// Interval between two searches for old files, in addition to those before new files.
const DELETE_EVERY: Span = Span::from_ms(600_000);
/// Files that share the space of the ring at least: a full one is a small part of it.
const FILES_MIN: u64 = 8;
/// Space that must be free beyond the minimum before a paused recording continues, bytes.
const RESUME_MARGIN: u64 = 32 << 20;

/// Free space of the file system of a folder, bytes.
pub type FreeSpace = Box<dyn Fn(&Path) -> io::Result<u64>>;

/// Asks the operating system for the free space.
///
/// # Errors
/// The folder does not exist.
pub fn free_space(folder: &Path) -> io::Result<u64> {
    let stat = rustix::fs::statvfs(folder)?;
    Ok(stat.f_bavail * stat.f_frsize)
}

/// Files of one recorder, the newest of which is written.
pub struct Ring {
    folder: PathBuf,
    limits: Recorder,
    attached: Attached,
    channels: Vec<Channel>,
    free_space: FreeSpace,
    current: Option<Recording>,
    /// Why nothing is written, and until when nothing is tried.
    paused: Option<(String, Time)>,
    next_deletion: Time,
    /// Number and recorded nanoseconds of other files.
    others: HashMap<PathBuf, (u64, u64)>,
}

impl Ring {
    /// A ring in `folder`, which exists. Nothing is written before the first [`Ring::tend`].
    pub fn new(
        folder: PathBuf,
        limits: Recorder,
        attached: Attached,
        free_space: FreeSpace,
    ) -> Self {
        let channels = channels::all();
        let (current, paused, next_deletion, others) = (None, None, Time(0), HashMap::new());
        Self {
            folder,
            limits,
            attached,
            channels,
            free_space,
            current,
            paused,
            next_deletion,
            others,
        }
    }

    /// Why nothing is recorded, if so.
    pub fn paused(&self) -> Option<&str> {
        self.paused.as_ref().map(|(why, _)| why.as_str())
    }

    /// Returns the file being written.
    pub fn current(&self) -> Option<&Path> {
        self.current.as_ref().map(Recording::path)
    }

    /// The clock of the file that is being written.
    pub fn clock(&self) -> Option<WallClock> {
        self.current.as_ref().map(Recording::clock)
    }

    /// Adds a message. It is dropped while nothing is recorded.
    pub fn write(&mut self, sample: Sample<'_>, now: Time) {
        let Some(recording) = &mut self.current else { return };
        let Sample { channel, sequence, at_ns, data } = sample;
        let channel = (channel, &self.channels[channel.0]);
        if let Err(error) = recording.write(channel, sequence, at_ns, data) {
            self.on_failure(&error, now);
        }
    }

    /// Flushes, begins the next file if one is due, deletes old ones, and checks the free space.
    /// Returns whether a file has begun.
    pub fn tend(&mut self, now: Time, clock: WallClock) -> bool {
        if let Some(error) = self.current.as_mut().and_then(|current| current.flush().err()) {
            self.on_failure(&error, now);
        }
        if now >= self.next_deletion {
            self.delete_old(now);
        }
        self.look_at_space(now);
        if self.paused.is_some() {
            return false;
        }
        let is_due = |recording: &Recording| {
            let age_ns = clock.wall_ns(now).saturating_sub(recording.began_ns());
            u128::from(age_ns) >= self.limits.file_max.as_nanos()
                || recording.bytes() >= self.limits.bytes_max / FILES_MIN
                || recording.clock().has_jumped(clock)
        };
        if self.current.as_ref().is_some_and(is_due) {
            self.finish(now);
        }
        self.current.is_none() && self.paused.is_none() && self.begin(now, clock)
    }

    fn begin(&mut self, now: Time, clock: WallClock) -> bool {
        self.delete_old(now);
        let last = self.others.values().map(|(number, _)| *number).max();
        let number = last.unwrap_or(0).saturating_add(1);
        let now_ns = clock.wall_ns(now);
        let begun = Recording::begin(&self.folder, number, now_ns, clock, &self.attached);
        match begun {
            Ok(recording) => {
                tracing::debug!(file = %recording.path().display(), "recording");
                self.current = Some(recording);
                true
            }
            Err(error) => {
                self.on_failure(&error, now);
                false
            }
        }
    }

    /// Completes the file that is being written.
    pub fn finish(&mut self, now: Time) {
        if let Some(Err(error)) = self.current.take().map(Recording::finish) {
            self.on_failure(&error, now);
        }
    }

    /// Deletes the oldest files until no more than the age is recorded after the others, and they
    /// leave room for the one that is written.
    fn delete_old(&mut self, now: Time) {
        self.next_deletion = now + DELETE_EVERY;
        let mut others = entries(&self.folder);
        others.retain(|file| file.is_own() && Some(file.path.as_path()) != self.current());
        let known = std::mem::take(&mut self.others);
        for file in &others {
            let known = known.get(&file.path).copied();
            let facts = known.unwrap_or_else(|| (number(&file.path), self.recorded_ns(file)));
            self.others.insert(file.path.clone(), facts);
        }
        let facts = |file: &Entry| self.others.get(&file.path).copied().unwrap_or_default();
        others.sort_by_key(|file| (facts(file).0, file.began_ns));
        let bytes_max = self.limits.bytes_max;
        // The current file grows by the messages sent until the next look.
        let most = bytes_max - bytes_max / FILES_MIN - bytes_max / 64;
        let mut bytes: u64 = others.iter().map(|file| file.bytes).sum();
        let mut since_ns: u128 = others.iter().map(|file| u128::from(facts(file).1)).sum();
        for file in others {
            since_ns -= u128::from(facts(&file).1);
            if bytes <= most && since_ns <= self.limits.age_max.as_nanos() {
                break;
            }
            let Entry { path, bytes: own, .. } = file;
            match fs::remove_file(&path) {
                Ok(()) => {
                    let why = if bytes > most { "space" } else { "age" };
                    tracing::info!(file = %path.display(), why, "deleted");
                    bytes -= own;
                }
                Err(error) => tracing::warn!(file = %path.display(), %error, "not deleted"),
            }
        }
    }

    /// Returns the recorded time of a file, nanoseconds: at most that of the longest file.
    fn recorded_ns(&self, file: &Entry) -> u64 {
        let most = self.limits.file_max;
        file.seconds().map_or(0, |s| Duration::from_secs_f64(s).min(most).as_nanos() as u64)
    }

    /// Pauses when the disk is nearly full, and resumes when it is not.
    fn look_at_space(&mut self, now: Time) {
        let free_min = self.limits.free_min;
        let free = match (self.free_space)(&self.folder) {
            Ok(free) => free,
            Err(error) => {
                let error = RecordingError::Io(self.folder.clone(), error);
                return self.on_failure(&error, now);
            }
        };
        let enough = free_min + if self.paused.is_some() { RESUME_MARGIN } else { 0 };
        if free_min > 0 && free < enough {
            let folder = self.folder.display();
            let (free, least) = (free >> 20, free_min >> 20);
            let why =
                format!("disk: {free} MiB free in {folder}, recorder.free_min_mib is {least}");
            self.finish(now);
            self.pause(why, now);
        } else if self.paused.as_ref().is_some_and(|(_, until)| now >= *until) {
            self.paused = None;
            tracing::info!("recording again");
        }
    }

    fn on_failure(&mut self, error: &RecordingError, now: Time) {
        // Flushed data are completed at the next start.
        self.current = None;
        self.pause(format!("{error}{}", help(error)), now + RETRY_AFTER);
    }

    fn pause(&mut self, why: String, until: Time) {
        if self.paused.is_none() {
            tracing::error!(why, "recording is paused");
        }
        self.paused = Some((why, until));
    }
}

/// Returns advice to a person about a failure to write.
fn help(error: &RecordingError) -> &'static str {
    let RecordingError::Io(_, error) = error else { return "" };
    match error.kind() {
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "; help: make the folder writable for the user who runs the group"
        }
        ErrorKind::NotFound => "; help: create the folder again",
        _ => "",
    }
}

#[cfg(test)]
mod tests;
