//! Cleanup after a killed group.

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::shm_cleanup;

/// Interval at which the end of the last service is polled.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Removes what is left of a group that has no supervisor, once its last service has ended; they
/// shut down when their supervisor is gone. Returns the removed paths.
pub(super) fn remove(paths: &GroupPaths, timeout: Duration) -> Result<Vec<PathBuf>, Failure> {
    let until = Instant::now() + timeout;
    while some_service_lives(paths) {
        if Instant::now() >= until {
            let what =
                format!("group {}: services without a supervisor are still running", paths.name());
            let help = "help: wait, or start the group and stop it again";
            return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
        }
        thread::sleep(LOOK_EVERY);
    }
    let run = paths.run();
    let mut removed = shm_cleanup::remove_leftovers(paths);
    match std::fs::remove_dir_all(&run) {
        Ok(()) => removed.push(run),
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(Failure::file(&run, &error)),
    }
    Ok(removed)
}

/// Returns true if a service of the group still runs: each holds a shared lock for its life.
pub(super) fn some_service_lives(paths: &GroupPaths) -> bool {
    let Ok(file) = File::open(paths.alive_lock()) else { return false };
    matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths() -> (tempfile::TempDir, GroupPaths) {
        let (home, paths) = super::super::lab();
        std::fs::create_dir_all(paths.run()).unwrap();
        (home, paths)
    }

    #[test]
    fn run_folder_of_a_dead_group_is_removed_and_journals_kept() {
        let (_home, paths) = paths();
        std::fs::create_dir_all(paths.journal()).unwrap();
        assert_eq!(remove(&paths, Duration::ZERO).unwrap(), [paths.run()]);
        assert!(!paths.run().exists() && paths.journal().is_dir());
        assert!(remove(&paths, Duration::ZERO).unwrap().is_empty());
    }

    #[test]
    fn run_folder_is_kept_while_a_service_lives() {
        let (_home, paths) = paths();
        let service = File::create(paths.alive_lock()).unwrap();
        service.lock_shared().unwrap();
        let error = remove(&paths, Duration::from_millis(60)).unwrap_err();
        assert!(error.to_string().contains("still running"), "{error}");
        assert!(paths.run().is_dir());
        drop(service);
        remove(&paths, Duration::ZERO).unwrap();
    }
}
