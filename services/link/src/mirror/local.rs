//! The local group: its folders, shared memory and settings.

use std::fs::{self, File};
use std::io::Write;
use std::path::PathBuf;

use config::Settings;
use messages::{Epoch, Incarnation, Service};
use roster::Name;
use rustix::fs::{FlockOperation, flock};
use service::exit::{Exit, Failure};
use service::folders::{make_private, make_root};
use service::group::GroupPaths;
use service::journal_set::JournalSet;
use service::shm_cleanup::{Admin, check_room, remove_leftovers};

use super::{Options, own_settings};
use crate::keyring::storage;
use crate::presence::Hello;

/// The start of every service that the mirror writes as.
pub(super) const INCARNATION: Incarnation = Incarnation(1);

/// File in the group's folder that says which robot it mirrors.
const MARK: &str = "mirror";

/// Locks the group's name for this process, as a supervisor would; kept for as long as it mirrors.
pub(super) fn hold(paths: &GroupPaths, robot: &Name) -> Result<File, Failure> {
    let mark = paths.root().join(MARK);
    let group = paths.name();
    if paths.epoch_file().exists() && !mark.exists() {
        let what = format!(
            "group {group} is a robot of this machine; help: choose another name for the mirror: --group {robot}"
        );
        return Err(Failure::new(Exit::Usage, what));
    }
    make_root(paths.root()).map_err(storage)?;
    let path = paths.supervisor_lock();
    let failed = |error: std::io::Error| Failure::file(&path, &error);
    let mut lock = safe_files::open_lock(&path).map_err(failed)?;
    if flock(&lock, FlockOperation::NonBlockingLockExclusive).is_err() {
        let what =
            format!("group {group} is already running; help: choose another name: --group {robot}");
        return Err(Failure::new(Exit::NotReached, what));
    }
    lock.set_len(0).map_err(failed)?;
    writeln!(lock, "{}", std::process::id()).map_err(failed)?;
    safe_files::replace_private(&mark, format!("{robot}\n"))
        .map_err(|error| Failure::file(&mark, &error))?;
    Ok(lock)
}

/// The settings that local programs read.
pub(super) fn settings(
    paths: &GroupPaths,
    hello: &Hello,
    options: &Options,
) -> Result<Settings, Failure> {
    own_settings(&hello.settings, paths, options).map_err(|failure| {
        let Hello { version, .. } = hello;
        let own = build_info::full_version();
        let what = format!(
            "{failure}\nhelp: the robot runs whichone {version}, this is {own}; install the same version"
        );
        Failure::new(Exit::Config, what)
    })
}

/// The group's folder `run/` and shared memory, which are removed at its end.
pub(super) struct Local {
    pub(super) paths: GroupPaths,
    pub(super) epoch: Epoch,
    admin: Option<Admin>,
}

impl Local {
    /// Creates the mirror's local resources.
    pub(super) fn raise(
        paths: &GroupPaths,
        hello: &Hello,
        settings: &Settings,
        options: &Options,
    ) -> Result<Self, Failure> {
        check_room(u64::from(settings.group.shared_memory_free_min_mib))
            .map_err(|error| Failure::new(Exit::NotReached, error.to_string()))?;
        // Leftovers of a mirror that was killed.
        remove_leftovers(paths);
        let run = paths.run();
        if run.exists() {
            fs::remove_dir_all(&run).map_err(|error| Failure::file(&run, &error))?;
        }
        for folder in [run.clone(), paths.log(), paths.journal()] {
            make_private(&folder).map_err(storage)?;
        }
        let epoch = Epoch(hello.epoch);
        let stored = |path: PathBuf| move |error: std::io::Error| Failure::file(&path, &error);
        JournalSet::new(hello.epoch).save(paths).map_err(stored(paths.epoch_file()))?;
        settings.write_snapshot(&run).map_err(stored(run.clone()))?;
        let admin = Admin::open(paths, epoch)?;
        // Readers accept a service's start only with the supervisor's socket for it.
        for service in Service::DIALOGUE {
            let socket = paths.notify_socket(service.name(), INCARNATION.0);
            safe_files::create_private(&socket).map_err(stored(socket.clone()))?;
        }
        tracing::info!(robot = %options.robot, group = %paths.name(), "mirrored");
        Ok(Self { paths: paths.clone(), epoch, admin: Some(admin) })
    }

    /// Removes the shared memory of dead clients.
    pub(super) fn clean(&self) {
        self.admin.iter().for_each(Admin::clean_dead);
    }
}

impl Drop for Local {
    fn drop(&mut self) {
        self.admin = None;
        remove_leftovers(&self.paths);
        let run = self.paths.run();
        if let Err(error) = fs::remove_dir_all(&run) {
            tracing::warn!(folder = %run.display(), %error, "not removed");
        }
    }
}
