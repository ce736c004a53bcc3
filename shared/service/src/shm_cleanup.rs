//! Shared memory of a group, as managed by the supervisor: creation, checks, cleanup after
//! dead processes, and removal.

use crate::bus::{Bus, BusError, Identity, Topics, config};
use crate::group::GroupPaths;
use messages::Epoch;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Timeout for another process that is cleaning up.
const CLEANUP_PATIENCE: Duration = Duration::from_millis(200);

/// The supervisor's handle to the group's shared memory.
#[derive(Debug)]
pub struct Admin {
    bus: Bus,
    _topics: Topics,
    root: PathBuf,
}

/// Too little free shared memory for the group.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{path}: {free_mib} MiB of shared memory are free, {needed_mib} MiB are needed; free some, or \
     lower shared_memory.free_min_mib in group.toml"
)]
pub struct NoRoom {
    path: String,
    free_mib: u64,
    needed_mib: u64,
}

/// Checks for free shared memory before a start: running out of it later is not an error but kills the
/// process that touches it (SIGBUS).
///
/// # Errors
/// Less than `needed_mib` free.
pub fn check_room(needed_mib: u64) -> Result<(), NoRoom> {
    let path = "/dev/shm";
    let Ok(stat) = rustix::fs::statvfs(path) else { return Ok(()) };
    let free_mib = (stat.f_bavail * stat.f_frsize) >> 20;
    if free_mib < needed_mib {
        return Err(NoRoom { path: path.to_owned(), free_mib, needed_mib });
    }
    Ok(())
}

impl Admin {
    /// Opens the group's shared memory, cleans up after processes of an earlier run, and creates
    /// every topic.
    ///
    /// # Errors
    /// iceoryx2 refuses.
    pub fn open(paths: &GroupPaths, epoch: Epoch) -> Result<Self, BusError> {
        std::fs::create_dir_all(paths.ipc())
            .map_err(|e| BusError::ipc("iceoryx2 folder", e.to_string()))?;
        let identity = Identity { epoch, ..Identity::default() };
        let bus = Bus::open(paths, messages::SUPERVISOR, identity)?;
        bus.node().blocking_cleanup_dead_nodes(CLEANUP_PATIENCE);
        let topics = Topics::create(&bus)?;
        Ok(Self { bus, _topics: topics, root: paths.ipc() })
    }

    /// Removes what dead processes left behind. Called after each reap, before the successor is
    /// started.
    pub fn clean_dead(&self) {
        let state = self.bus.node().blocking_cleanup_dead_nodes(CLEANUP_PATIENCE);
        tracing::debug!(?state, "cleaned up after dead processes");
    }

    /// Returns true if the group's files are still there. If they were removed by
    /// hand, every new process would silently create a second group of the same name.
    pub fn intact(&self) -> bool {
        self.root.is_dir()
            && std::fs::read_dir(&self.root).is_ok_and(|mut entries| entries.next().is_some())
    }
}

/// Removes every trace of the group from shared memory, after its last process has ended. Returns
/// what was left over by then and had to be removed by name.
pub fn remove_leftovers(paths: &GroupPaths) -> Vec<PathBuf> {
    if let Ok(config) = config(paths) {
        let _ = iceoryx2::prelude::Node::<crate::bus::Ipc>::list(&config, |state| {
            if let iceoryx2::prelude::NodeState::Dead(view) = state {
                let _ = view.try_remove_stale_resources();
            }
            iceoryx2::prelude::CallbackProgression::Continue
        });
    }
    let left = leftovers(paths);
    left.iter().for_each(|path| {
        let _ = std::fs::remove_file(path);
    });
    // iceoryx2's bookkeeping of the group as a whole is always the last to go and not a leftover.
    left.into_iter().filter(|path| !path.to_string_lossy().ends_with("global_mgmt")).collect()
}

/// Files of the group in shared memory.
pub fn leftovers(paths: &GroupPaths) -> Vec<PathBuf> {
    let prefix = paths.ipc_prefix();
    let named = |path: &PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().contains(&prefix))
    };
    let Ok(entries) = std::fs::read_dir(Path::new("/dev/shm")) else { return Vec::new() };
    entries.filter_map(|entry| Some(entry.ok()?.path())).filter(named).collect()
}
