//! A group of its own for the service under test: folder, shared memory and settings as a
//! supervisor makes them, and no other process.

use std::os::fd::{AsRawFd, OwnedFd, RawFd};
use std::path::{Path, PathBuf};

use config::Settings;
use messages::{Epoch, Incarnation, Service, Topic, topics};
use rustix::io::FdFlags;
use rustix::pipe::{PipeFlags, pipe_with};
use safe_files::TemporaryFolder;
use service::bus::{Bus, Identity, RawReader};
use service::exit::{Exit, Failure};
use service::folders::{make_private, make_root};
use service::group::{GroupName, GroupPaths};
use service::journal_set::JournalSet;
use service::kept_settings;
use service::shm_cleanup::{Admin, remove_leftovers};

/// Epoch of the group.
pub(super) const EPOCH: Epoch = Epoch(7);

/// The group of a test. Its files are removed with it.
pub(super) struct Bench {
    pub(super) paths: GroupPaths,
    pub(super) settings: Settings,
    /// The service under test.
    pub(super) service: Service,
    /// The end that a service inherits; its reading end of file means that the supervisor is gone.
    lifeline: OwnedFd,
    /// The supervisor's end.
    alive: Option<OwnedFd>,
    /// Every topic, whoever writes to it.
    watched: Vec<Watched>,
    admin: Option<Admin>,
    /// Holds everything; removed last.
    _home: TemporaryFolder,
}

/// A topic that is read from any writer.
struct Watched {
    topic: Topic,
    reader: RawReader,
}

/// A message of the service under test, or of another writer of the topic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Written {
    pub(super) topic: Topic,
    pub(super) epoch: Epoch,
    pub(super) incarnation: u32,
}

impl Bench {
    /// Makes the group.
    pub(super) fn new(settings: Settings, service: &str) -> Result<Self, Failure> {
        let home = TemporaryFolder::new().map_err(|error| {
            Failure::new(Exit::Storage, format!("temporary folder for the group: {error}"))
        })?;
        let name = GroupName::new("conform")?;
        let paths = GroupPaths::in_home(home.path(), &name)?;
        let failed = |error: std::io::Error| Failure::file(paths.root(), &error);
        let private = |folder: &Path| {
            make_private(folder).map_err(|error| Failure::new(Exit::Storage, error.to_string()))
        };
        make_root(paths.root()).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
        [paths.run(), paths.log(), paths.journal()].iter().try_for_each(|it| private(it))?;
        safe_files::open_lock(&paths.alive_lock()).map_err(failed)?;
        JournalSet::new(EPOCH.0).save(&paths).map_err(failed)?;
        kept_settings::put_in_force(&paths, &settings).map_err(failed)?;
        let admin = Admin::open(&paths, EPOCH)?;
        let (lifeline, alive) = pipe_with(PipeFlags::CLOEXEC).map_err(|e| failed(e.into()))?;
        // Only the reading end is inherited, by every process that is started from now on.
        rustix::io::fcntl_setfd(&lifeline, FdFlags::empty()).map_err(|e| failed(e.into()))?;
        let mut bench = Self {
            service: Service::named(service),
            lifeline,
            alive: Some(alive),
            watched: Vec::new(),
            admin: Some(admin),
            settings,
            paths,
            _home: home,
        };
        let bus = bench.bus("watcher", EPOCH)?;
        bench.watched = topics::ALL
            .iter()
            .chain(&topics::robot::ALL)
            .map(|topic| Ok(Watched { topic: *topic, reader: bus.raw_reader(topic)? }))
            .collect::<Result<_, Failure>>()?;
        Ok(bench)
    }

    /// Joins the group as `name`, with messages of `epoch`.
    pub(super) fn bus(&self, name: &str, epoch: Epoch) -> Result<Bus, Failure> {
        let identity = Identity { epoch, incarnation: Incarnation(u32::from(name != "watcher")) };
        Ok(Bus::open(&self.paths, name, identity)?)
    }

    /// Number of the descriptor that a service inherits.
    pub(super) fn lifeline(&self) -> RawFd {
        self.lifeline.as_raw_fd()
    }

    /// Ends as a supervisor that is killed: services see the end of their lifeline.
    pub(super) fn end_lifeline(&mut self) {
        self.alive = None;
    }

    /// The log of the service under test.
    pub(super) fn log_file(&self) -> PathBuf {
        self.paths.log_file(self.service.name())
    }

    /// Returns the messages since the last call, except those of the tester's topics `own`.
    pub(super) fn written(&self, own: &[Topic]) -> Result<Vec<Written>, Failure> {
        let mut written = Vec::new();
        for Watched { topic, reader } in &self.watched {
            let is_own = own.iter().any(|own| own.name == topic.name);
            reader.drain(&mut |stamp, _| {
                if !is_own {
                    let (epoch, incarnation) = (Epoch(stamp.epoch), stamp.incarnation);
                    written.push(Written { topic: *topic, epoch, incarnation });
                }
            })?;
        }
        Ok(written)
    }

    /// Removes the shared memory of a killed process, as the supervisor does after each.
    pub(super) fn clean_dead(&self) {
        if let Some(admin) = &self.admin {
            admin.make_way();
            admin.clean_dead();
        }
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        self.watched.clear();
        self.admin = None;
        remove_leftovers(&self.paths);
    }
}
