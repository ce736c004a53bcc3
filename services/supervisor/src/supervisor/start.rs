//! Startup of a group.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::time::{Duration, Instant};

use messages::Epoch;
use rustix::process::{Resource, Rlimit, getpid, set_child_subreaper, setrlimit};
use service::bus::BusError;
use service::exit::Exit;
use service::folders::{FolderError, make_private, make_root};
use service::group::GroupPaths;
use service::logging;
use service::notify::Notifier;
use service::shm_cleanup::{Admin, NoRoom, check_room, remove_leftovers};
use thiserror::Error;

use super::put_down::PutDown;
use super::{Supervisor, TICK};
use crate::configuration::GroupSpec;
use crate::configuration::{Configuration, Load};
use crate::epoch::{self, EpochError};
use crate::group::Group;
use crate::lifeline::Lifeline;
use crate::previous_run::{self, PreviousRunError};
use crate::schedule::ScheduleError;
use crate::server::Server;
use crate::service::{Service, Surroundings};
use crate::signals::Signals;

/// A group cannot be started.
#[derive(Debug, Error)]
pub enum StartError {
    /// An invalid configuration, with every problem.
    #[error("{}", .0.join("\n"))]
    Config(Vec<String>),
    /// The services cannot be put in order.
    #[error(transparent)]
    Order(#[from] ScheduleError),
    /// A previous supervisor, or a process that it started, is still running.
    #[error(transparent)]
    PreviousRun(#[from] PreviousRunError),
    /// Too little shared memory.
    #[error(transparent)]
    Room(#[from] NoRoom),
    /// The group's shared memory cannot be created.
    #[error("shared memory: {0}")]
    SharedMemory(#[from] BusError),
    /// The group's journals are lost, damaged or of another version.
    #[error("{0}")]
    Epoch(#[from] EpochError),
    /// A folder of the group is not its owner's alone.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A folder, file, socket or setting is refused by the operating system.
    #[error("{0}: {1}")]
    Io(&'static str, io::Error),
}

impl StartError {
    /// Returns the exit code for this error.
    pub fn exit(&self) -> Exit {
        match self {
            Self::Config(_) | Self::Order(_) => Exit::Config,
            Self::PreviousRun(_) | Self::Room(_) | Self::SharedMemory(_) => Exit::NotReached,
            Self::Epoch(EpochError::Journals(all)) if all.iter().all(|it| it.is_foreign) => {
                Exit::Config
            }
            Self::Epoch(_) | Self::Folder(_) | Self::Io(..) => Exit::Storage,
        }
    }
}

/// See [`Supervisor::start`].
pub(super) fn start(
    paths: GroupPaths,
    mut load: Load,
    fresh: bool,
) -> Result<Supervisor, StartError> {
    let started = Instant::now();
    // First: whoever looks for the group finds this process while it checks the configuration, which may take long.
    make_root(paths.root())?;
    let taken = previous_run::take_group(&paths)?;
    let configuration = load(None).map_err(StartError::Config)?;
    logging::set_json(configuration.spec.log.json);
    logging::identify();
    let group = Group::new(&configuration.spec)?;
    let put_down =
        PutDown::read(&paths.put_down()).map_err(failed("services that are put down"))?;
    let alive = previous_run::await_end(&paths, longest_stop(&configuration.spec))?;
    let raised = raise(&paths, &configuration, alive, fresh);
    let (admin, signals, server, around) = raised.inspect_err(|_| {
        remove_leftovers(&paths);
        // The folder says that a group runs. What cannot be removed is removed at the next start.
        let _ = fs::remove_dir_all(paths.run());
    })?;
    tracing::info!(group = %around.paths.name(), epoch = around.epoch, "supervisor started");
    let init_system = Notifier::from_environment().unwrap_or_else(|error| {
        tracing::warn!(%error, "NOTIFY_SOCKET cannot be used");
        Notifier::default()
    });
    let services = configuration.spec.services.iter().cloned().map(Service::new).collect();
    let now = started.elapsed();
    let mut supervisor = Supervisor {
        started,
        around,
        configuration,
        load,
        scene: None,
        group,
        services,
        admin: Some(admin),
        is_cleanup_begun: false,
        server,
        signals,
        init_system,
        put_down,
        waits: Vec::new(),
        replacements: BTreeMap::new(),
        orphans: Vec::new(),
        orphans_killed: 0,
        condemned: Vec::new(),
        ending: None,
        last_renewal: None,
        next_renewal: now,
        last_pass: now,
        next_tick: now + TICK,
        next_look: now,
        reported_ready: false,
        taken,
    };
    supervisor.start_group(now);
    Ok(supervisor)
}

/// Creates the resources that exist before the first service starts.
fn raise(
    paths: &GroupPaths,
    configuration: &Configuration,
    alive: File,
    fresh: bool,
) -> Result<(Admin, Signals, Server, Surroundings), StartError> {
    check_room(configuration.shared_memory_free_min_mib)?;
    make_folders(paths)?;
    let epoch = epoch::open(paths, fresh)?;
    (configuration.publish)(paths).map_err(failed("settings for the services"))?;
    let admin = Admin::open(paths, Epoch(epoch))?;
    let signals = Signals::new().map_err(failed("signals"))?;
    adopt_orphans().map_err(failed("process settings"))?;
    let server = Server::bind(&paths.control_socket()).map_err(failed("control socket"))?;
    let around = Surroundings {
        lifeline: Lifeline::new(alive).map_err(failed("lifeline"))?,
        epoch,
        log: configuration.spec.log.clone(),
        directory: std::env::current_dir().map_err(failed("current folder"))?,
        paths: paths.clone(),
    };
    Ok((admin, signals, server, around))
}

/// Services of a killed supervisor shut down on their own (an arm comes to rest first) within the
/// same deadline as on request.
fn longest_stop(spec: &GroupSpec) -> Duration {
    let deadlines = spec.services.iter().map(|service| service.stop_deadline);
    deadlines.max().unwrap_or_default()
}

/// Creates the folders that every group has.
pub(super) fn make_folders(paths: &GroupPaths) -> Result<(), FolderError> {
    [paths.run(), paths.log(), paths.journal()].iter().try_for_each(|folder| make_private(folder))
}

/// Makes this process the reaper of orphans of its services. No process below it
/// dumps core: a backtrace is in the log, and a core of a process with shared memory is large.
fn adopt_orphans() -> io::Result<()> {
    set_child_subreaper(Some(getpid()))?;
    setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) })?;
    Ok(())
}

fn failed(what: &'static str) -> impl Fn(io::Error) -> StartError {
    move |error| StartError::Io(what, error)
}
