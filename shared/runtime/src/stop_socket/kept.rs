//! A stop that outlives whoever gave it.
//!
//! A giver repeats its stop only as long as it lives: a command line is interrupted, a page is closed, a service is
//! killed. What it cannot get confirmed it leaves as a file in the group's folder, and the arm's service obeys the file
//! before it moves. Its presence alone is the stop; its content, the time at which the stop was given, only keeps it
//! from undoing a later release.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::datagram::ClockOffset;
use super::{Progress, StopClient};
use crate::group::GroupPaths;
use crate::{Time, clock};
use messages::MotionOrder;

/// Returns whether a stop waits for the arm's service.
pub fn is_kept(paths: &GroupPaths) -> bool {
    paths.kept_stop().exists()
}

/// Keeps a stop; `given_ns` is in the machine's time. A later one replaces an earlier one.
pub(super) fn keep(paths: &GroupPaths, given_ns: u64) -> io::Result<()> {
    safe_files::replace_private_synced(&paths.kept_stop(), format!("{given_ns}\n"))
}

/// Removes a stop that the arm has carried out.
pub(super) fn forget(path: &Path) {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            tracing::warn!(%error, path = %path.display(), "kept stop not removed");
        }
        _ => {}
    }
}

/// The arm's end: a stop that was kept while its service was away, given to it as any other.
#[derive(Debug)]
pub struct KeptStop {
    client: StopClient,
    progress: Progress,
    path: PathBuf,
}

impl KeptStop {
    /// Returns the group's kept stop, after sending it to the arm's socket, which must be bound. One that cannot be read
    /// counts as given now.
    /// # Errors
    /// The process or the system has no descriptor left.
    pub fn open(paths: &GroupPaths) -> io::Result<Option<Self>> {
        let path = paths.kept_stop();
        if !path.exists() {
            return Ok(None);
        }
        let text = safe_files::read_private(&path).unwrap_or_default();
        let now = clock::now();
        let own = |machine_ns| Time(ClockOffset::of_process().own_ns(machine_ns));
        let given = text.trim().parse().map_or(now, own).min(now);
        let mut kept = Self {
            client: StopClient::open(paths)?,
            progress: Progress::new(MotionOrder::Stop, given, None),
            path,
        };
        tracing::warn!("a stop was given while the arm's service was away; the arm obeys it now");
        kept.pass();
        Ok(Some(kept))
    }

    /// Repeats the stop where that is due. Returns true once it is carried out, or overruled, and its file is removed.
    pub fn pass(&mut self) -> bool {
        let now = clock::now();
        self.progress.advance(&self.client, now);
        let is_over = self.progress.is_settled(now);
        if is_over {
            forget(&self.path);
        }
        is_over
    }
}
