//! A stop that outlives its giver.
//!
//! A giver repeats its stop only as long as it lives: a command line is interrupted, a page is
//! closed, a service is killed. An unconfirmed stop is left as a file in the group's folder. The
//! arm's service obeys the file when it starts, when it has come to rest, and before any release;
//! so it counts even if the arm's socket is full or gone. Its presence alone is the stop; its
//! content, the time at which the stop was given, only keeps it from undoing a later release.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::datagram::ClockOffset;
use super::{Progress, StopClient, StopOrder};
use crate::group::GroupPaths;
use crate::{Time, clock};
use messages::MotionOrder;

/// Returns whether a stop waits for the arm's service.
pub fn is_kept(paths: &GroupPaths) -> bool {
    is_there(&paths.kept_stop())
}

/// A link that leads nowhere exists, too.
fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Keeps a stop; `given_ns` is in the machine's time. The latest one is kept. A disk without space
/// may have room for an empty file.
pub(super) fn keep(paths: &GroupPaths, given_ns: u64) -> io::Result<()> {
    let path = paths.kept_stop();
    if is_there(&path) && read(&path).is_none_or(|kept| kept >= given_ns) {
        return Ok(());
    }
    let kept = safe_files::replace_private_synced(&path, format!("{given_ns}\n"));
    kept.or_else(|error| match safe_files::create_private(&path) {
        Ok(_) => Ok(()),
        Err(_) if is_there(&path) => Ok(()),
        Err(_) => Err(error),
    })
}

/// Returns when the kept stop was given, in the machine's time; `None` if the file has none.
fn read(path: &Path) -> Option<u64> {
    safe_files::read_private(path).ok()?.trim().parse().ok()
}

/// Removes a stop that the arm has carried out.
pub(super) fn forget(path: &Path) {
    let removed = fs::remove_file(path).or_else(|error| match error.kind() {
        ErrorKind::NotFound => Ok(()),
        _ => fs::remove_dir(path).map_err(|_| error),
    });
    if let Err(error) = removed {
        tracing::warn!(%error, path = %path.display(), "kept stop not removed; help: remove it by hand");
    }
}

/// The arm's end: a stop that was kept while its service did not listen.
#[derive(Debug)]
pub struct KeptStop {
    client: StopClient,
    progress: Progress,
    path: PathBuf,
}

impl KeptStop {
    /// Returns the group's kept stop, if any. One with an unreadable time counts as given now.
    /// # Errors
    /// The process or the system has no descriptor left.
    pub fn find(paths: &GroupPaths) -> io::Result<Option<Self>> {
        let path = paths.kept_stop();
        if !is_there(&path) {
            return Ok(None);
        }
        let now = clock::now();
        let own = |machine_ns| Time(ClockOffset::of_process().own_ns(machine_ns));
        let given = read(&path).map_or(now, own).min(now);
        let progress = Progress::new(MotionOrder::Stop, given, None);
        tracing::warn!(
            "a stop was given while the arm's service did not listen; the arm obeys it now"
        );
        Ok(Some(Self { client: StopClient::open(paths)?, progress, path }))
    }

    /// The order.
    pub fn order(&self) -> StopOrder {
        StopOrder::new(MotionOrder::Stop, self.progress.given())
    }

    /// Repeats the stop on the arm's socket if due. Returns true once it is carried out, or
    /// overruled, and its file is removed.
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
