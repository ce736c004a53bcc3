//! Shared memory of a group, as managed by the supervisor: creation, checks, cleanup after
//! dead processes, and removal.

use crate::bus::{Bus, BusError, Identity, Topics, config};
use crate::cleaner::{self, Cleaner};
use crate::folders::make_private;
use crate::group::{GroupPaths, SHM, ShmName};
use messages::Epoch;
use rustix::fs::{FallocateFlags, fallocate};
use rustix::process::geteuid;
use std::ffi::OsStr;
use std::fs::{self, DirBuilder, File};
use std::io::{self, ErrorKind};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};

/// Memory kept for restarts, bytes: a successor needs its connections before its peers let go of
/// those of its predecessor.
const SPARE: u64 = 1 << 20;

/// iceoryx2's bookkeeping of a group as a whole.
const MANAGEMENT: &str = "global_mgmt";

/// The supervisor's handle to the group's shared memory.
#[derive(Debug)]
pub struct Admin {
    /// Ends before the memory is let go of.
    cleaner: Cleaner,
    bus: Bus,
    _topics: Topics,
    paths: GroupPaths,
    place: ShmName,
    /// Files that every process of the group opens.
    shared: Vec<SharedFile>,
    spare: File,
}

/// A file in shared memory as it was made: one that is cut short or was made again is not the one
/// that the running processes have mapped.
#[derive(Debug)]
struct SharedFile {
    path: PathBuf,
    inode: u64,
    bytes: u64,
}

impl SharedFile {
    /// Returns the file's present state; `None` if it is gone already.
    fn now(path: PathBuf) -> Option<Self> {
        let found = path.symlink_metadata().ok()?;
        Some(Self { path, inode: found.ino(), bytes: found.len() })
    }

    fn is_whole(&self) -> io::Result<bool> {
        let found = self.path.symlink_metadata()?;
        Ok(found.ino() == self.inode && found.len() >= self.bytes)
    }
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

/// Checks for free shared memory before a start, so that a lack shows before anything runs.
///
/// # Errors
/// Less than `needed_mib` free.
pub fn check_room(needed_mib: u64) -> Result<(), NoRoom> {
    let Ok(stat) = rustix::fs::statvfs(SHM) else { return Ok(()) };
    let free_mib = (stat.f_bavail * stat.f_frsize) >> 20;
    if free_mib < needed_mib {
        return Err(NoRoom { path: SHM.to_owned(), free_mib, needed_mib });
    }
    Ok(())
}

impl Admin {
    /// Removes remains of earlier runs, and creates the group's shared memory under a new name,
    /// with every topic.
    ///
    /// # Errors
    /// iceoryx2 refuses.
    pub fn open(paths: &GroupPaths, epoch: Epoch) -> Result<Self, BusError> {
        remove_leftovers(paths);
        let failed = |error: io::Error| BusError::ipc("folder in shared memory", error.to_string());
        let place = create_place(paths).map_err(failed)?;
        let spare = File::create_new(place.folder().join("spare")).map_err(failed)?;
        fallocate(&spare, FallocateFlags::empty(), 0, SPARE).map_err(|e| failed(e.into()))?;
        let cleaner = Cleaner::start(paths.cleanup_lock(), config(&place)?)
            .map_err(|error| BusError::ipc("cleanup", error.to_string()))?;
        let identity = Identity { epoch, ..Identity::default() };
        let bus = Bus::open(paths, messages::SUPERVISOR, identity)?;
        let topics = Topics::create(&bus)?;
        let is_shared = |path: &PathBuf| is_management(path) || is_topic(path);
        let files = entries(place.prefix()).filter(is_shared).filter_map(SharedFile::now);
        // A folder's size says nothing.
        let folder = SharedFile::now(place.folder()).map(|it| SharedFile { bytes: 0, ..it });
        let shared = files.chain(folder).collect();
        Ok(Self { bus, _topics: topics, paths: paths.clone(), place, shared, spare, cleaner })
    }

    /// Begins to remove the remains of dead processes. Until that is done, starting services wait
    /// before they open topics: a successor loads meanwhile. Returns false if they would not wait;
    /// then nothing has begun.
    pub fn begin_cleanup(&self) -> bool {
        self.cleaner.begin()
    }

    /// Returns the number of processes that have joined the group and not left, even if dead.
    pub fn joined(&self) -> usize {
        let nodes = fs::read_dir(self.place.folder().join("nodes")).into_iter().flatten().flatten();
        let is_monitor = |name: &OsStr| name.as_bytes().ends_with(b".node_monitor");
        nodes.filter(|entry| is_monitor(&entry.file_name())).count()
    }

    /// Removes the remains of dead processes, after the cleanups that have begun.
    pub fn clean_dead(&self) {
        self.cleaner.await_end();
        cleaner::clean(self.bus.node().config());
    }

    /// Frees the memory that is kept for restarts. Called after each reap, before the successor is
    /// started.
    pub fn make_way(&self) {
        let _ = self.spare.set_len(0);
    }

    /// Takes back the memory that is kept for restarts, as soon as there is some.
    pub fn keep_spare(&self) {
        if self.spare.metadata().is_ok_and(|file| file.len() < SPARE) {
            let _ = fallocate(&self.spare, FallocateFlags::empty(), 0, SPARE);
        }
    }

    /// Returns false if the files by which new processes find the group are known to be gone,
    /// damaged or made again: new processes would join a second group of the same name, or none
    /// could start. Files that cannot be examined now count as intact.
    pub fn intact(&self) -> bool {
        let unless_gone =
            |looked: io::Result<bool>| looked.unwrap_or_else(|error| !is_gone(&error));
        let is_named = self.paths.shm_name().map(|place| place == self.place);
        let is_filled = fs::read_dir(self.place.folder()).map(|mut all| all.next().is_some());
        [is_named, is_filled].into_iter().all(unless_gone)
            && self.shared.iter().map(SharedFile::is_whole).all(unless_gone)
    }
}

fn is_gone(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidData)
}

/// Creates the folder of iceoryx2's files under a unique name, and writes the name down for the
/// group's processes.
///
/// # Errors
/// The operating system refuses.
pub fn create_place(paths: &GroupPaths) -> io::Result<ShmName> {
    make_private(&paths.run()).map_err(io::Error::other)?;
    let place = loop {
        let place = paths.draw_shm_name()?;
        match DirBuilder::new().mode(0o700).create(place.folder()) {
            Ok(()) => break place,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    };
    // Complete as soon as it is there: clients may look for it at any time.
    safe_files::replace_private(&paths.shm_name_file(), place.prefix())?;
    Ok(place)
}

/// Removes every trace of the group from shared memory, after its last process has ended. Returns
/// the entries left over by then, which had to be removed by name.
pub fn remove_leftovers(paths: &GroupPaths) -> Vec<PathBuf> {
    let place = paths.shm_name().ok();
    if let Some(config) = place.as_ref().and_then(|place| config(place).ok()) {
        cleaner::clean(&config);
    }
    // The folder goes first: a client that opens the group from now on removes its own files again.
    if let Some(place) = place {
        let _ = fs::remove_dir_all(place.folder());
    }
    // The bookkeeping of the group as a whole is always the last to go and not a leftover.
    let removed = remove_entries(&paths.shm_stem());
    removed.into_iter().filter(|path| !is_management(path)).collect()
}

/// Removes this user's entries in shared memory with names that begin with `prefix`. Returns them.
pub(crate) fn remove_entries(prefix: &str) -> Vec<PathBuf> {
    let all: Vec<_> = own_entries(prefix).collect();
    for path in &all {
        let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
    all
}

/// Files of the group in shared memory, of all its starts.
pub fn leftovers(paths: &GroupPaths) -> Vec<PathBuf> {
    own_entries(&paths.shm_stem()).collect()
}

fn own_entries(prefix: &str) -> impl Iterator<Item = PathBuf> {
    let user = geteuid().as_raw();
    entries(prefix).filter(move |path| path.symlink_metadata().is_ok_and(|file| file.uid() == user))
}

fn is_management(path: &Path) -> bool {
    path.to_string_lossy().ends_with(MANAGEMENT)
}

/// Returns whether the file is iceoryx2's bookkeeping of a topic.
fn is_topic(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "dynamic")
}

/// Entries of shared memory whose names begin with `prefix`.
fn entries(prefix: &str) -> impl Iterator<Item = PathBuf> {
    let all = fs::read_dir(SHM).into_iter().flatten().flatten();
    all.filter(move |entry| entry.file_name().to_string_lossy().starts_with(prefix))
        .map(|entry| entry.path())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::group::GroupName;
    use messages::Incarnation;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn process_that_opens_a_group_that_has_ended_leaves_nothing() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("ended").unwrap()).unwrap();
        drop(Admin::open(&paths, Epoch(1)).unwrap());
        assert_eq!(remove_leftovers(&paths), Vec::<PathBuf>::new());
        // It has read the name before.
        let opened = Bus::open(&paths, "client", Identity::default());
        assert!(opened.unwrap_err().to_string().contains("the group has ended"));
        assert_eq!(leftovers(&paths), Vec::<PathBuf>::new());
    }

    #[test]
    fn service_that_starts_during_the_cleanup_joins_after_it() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("held").unwrap()).unwrap();
        let admin = Admin::open(&paths, Epoch(1)).unwrap();
        let (joined, news) = mpsc::channel();
        let join = |incarnation: u32| {
            let identity = Identity { epoch: Epoch(1), incarnation: Incarnation(incarnation) };
            Bus::open(&paths, "policy", identity).unwrap();
            joined.send(incarnation).unwrap();
        };
        std::thread::scope(|scope| {
            scope.spawn(|| join(1)).join().unwrap();
            assert_eq!(news.recv(), Ok(1), "nobody is held back");
            assert_eq!(admin.joined(), 1, "the supervisor");
            // Two cleanups: the thread ends its own, the other one continues.
            assert!(admin.cleaner.hold_back() && admin.begin_cleanup());
            scope.spawn(|| join(2));
            // Clients do not wait for a service that starts.
            Bus::open(&paths, "client", Identity { epoch: Epoch(1), ..Identity::default() })
                .unwrap();
            assert!(news.recv_timeout(Duration::from_millis(100)).is_err());
            admin.cleaner.let_go();
            assert_eq!(news.recv(), Ok(2));
        });
        fs::remove_file(paths.cleanup_lock()).unwrap();
        assert!(!admin.begin_cleanup(), "nobody would wait");
        drop(admin);
        remove_leftovers(&paths);
    }
}
