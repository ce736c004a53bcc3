//! The group's shared memory: one iceoryx2 node per process, opened with the group's own prefix and
//! folder so that groups never see each other.

use crate::cleaner::await_cleanup;
use crate::group::{GroupPaths, ShmName};
use crate::shm_cleanup;
use crate::wakes::Wakes;
use iceoryx2::prelude::*;
use messages::topics::{self, Topic};
use messages::{Epoch, Incarnation, Service, Stamp};
use std::cell::{Cell, RefCell};
use std::os::unix::fs::MetadataExt;
use std::rc::{Rc, Weak};

mod any;
mod encoded;
mod fixed;
mod gate;
mod open;
mod own_files;
mod port;
mod raw;
mod receiver;
mod renewed;
mod segment;
mod segment_error;
mod sender;
mod variant;
mod wake;

pub use any::{AnyMessage, AnyReader, lost};
pub use encoded::{EncodedReader, EncodedWriter};
pub use fixed::{Reader, Writer};
pub use gate::rejected;
pub use open::Topics;
pub use raw::{RawReader, RawWriter};
pub use segment_error::SegmentError;
pub(crate) use variant::Ipc;
pub use wake::{Joined, WakeListener, WakeNotifier, Woken};

/// A process's access to the group's topics. Not shared between threads.
#[derive(Debug)]
pub struct Bus {
    node: Rc<Node<Ipc>>,
    identity: Identity,
    paths: GroupPaths,
    /// Services that are woken beyond the topics' own table.
    wakes: Wakes,
    /// How this process joins: as a service or as a client.
    joins: Joined,
    /// Notifiers that are open, one for each service that is woken.
    notifiers: RefCell<Vec<(Service, Rc<WakeNotifier>)>>,
    /// Writers that are open.
    writers: RefCell<Vec<Weak<dyn Connect>>>,
}

/// A writer that connects readers which have joined since its last message.
trait Connect: std::fmt::Debug {
    /// Connects them, and so hands them the latest messages.
    fn connect(&self);

    /// Wakes the topic's readers.
    fn wake_readers(&self);
}

/// Identity of a process in its group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// Epoch of the group.
    pub epoch: Epoch,
    /// Incarnation of the service; 0 for clients and the supervisor.
    pub incarnation: Incarnation,
}

/// A topic cannot be opened.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BusError {
    /// Schema mismatch: the topic was created with another build.
    #[error(
        "topic {topic}: this program's {payload} has schema {ours}, the group's topic has another \
         one ({cause}); use programs of one build in a group"
    )]
    Schema {
        /// The topic.
        topic: String,
        /// Payload type known to this program.
        payload: &'static str,
        /// Schema key known to this program.
        ours: String,
        /// Reason given by iceoryx2.
        cause: String,
    },
    /// A segment of shared memory cannot be created or used.
    #[error("{what}: {cause}")]
    Segment {
        /// Operation that failed.
        what: String,
        /// The reason.
        cause: SegmentError,
    },
    /// Any other error of iceoryx2.
    #[error("shared memory, {what}: {cause}")]
    Ipc {
        /// Operation that failed.
        what: String,
        /// Reason given by iceoryx2.
        cause: String,
    },
}

impl BusError {
    /// An error of iceoryx2, with the segment's error if there was one.
    pub(crate) fn ipc(what: &str, cause: String) -> Self {
        let what = what.to_owned();
        match segment_error::of_failure() {
            Some(cause) => Self::Segment { what, cause },
            None => Self::Ipc { what, cause },
        }
    }
}

/// Creates a port. For lack of a segment, iceoryx2 may return one that reaches only some of its
/// peers; here that is an error.
fn create<T, E: std::fmt::Debug>(
    what: &str,
    create: impl FnOnce() -> Result<T, E>,
) -> Result<T, BusError> {
    segment_error::take();
    let port = create().map_err(|error| BusError::ipc(what, format!("{error:?}")))?;
    match segment_error::take() {
        Some(cause @ (SegmentError::Room { .. } | SegmentError::Foreign { .. })) => {
            Err(BusError::Segment { what: what.to_owned(), cause })
        }
        _ => Ok(port),
    }
}

/// Failure to send or receive a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("topic {topic}: {cause}")]
pub struct PortError {
    topic: &'static str,
    cause: String,
}

impl PortError {
    /// An error of iceoryx2, with the segment's error if there was one.
    pub(crate) fn new(topic: &'static str, cause: String) -> Self {
        let cause = segment_error::take().map_or(cause, |error| error.to_string());
        Self { topic, cause }
    }
}

/// The configuration with which every process of the group opens iceoryx2.
pub(crate) fn config(name: &ShmName) -> Result<Config, BusError> {
    set_log_level(LogLevel::Fatal);
    let mut config = Config::default();
    let bad = |what: &str| BusError::ipc(what, "not usable as a name".to_owned());
    config.global.prefix = FileName::new(name.prefix().as_bytes()).map_err(|_| bad("prefix"))?;
    let folder = name.folder();
    let root = Path::new(folder.as_os_str().as_encoded_bytes());
    config.global.set_root_path(&root.map_err(|_| bad("iceoryx2 folder"))?);
    // Only the supervisor cleans up after the dead: right after it has reaped them, before a
    // successor opens topics. Others would race it at every start.
    config.global.node.cleanup_dead_nodes_on_creation = false;
    config.global.node.cleanup_dead_nodes_on_destruction = false;
    config.global.service.cleanup_dead_nodes_on_open = false;
    // Writers of a topic that may end between two looks of a reader without loss. Each reader
    // initialises this room, 1.5 kB a writer: iceoryx2's 128 took most of its start.
    config.defaults.publish_subscribe.subscriber_expired_connection_buffer = topics::CLIENTS_MAX;
    Ok(config)
}

fn open_node(place: &ShmName, name: &str) -> Result<Node<Ipc>, BusError> {
    let config = config(place)?;
    let name = NodeName::new(name).map_err(|e| BusError::ipc("node name", format!("{e:?}")))?;
    let node = NodeBuilder::new()
        .name(&name)
        .config(&config)
        .signal_handling_mode(SignalHandlingMode::Disabled);
    create("node", || node.create::<Ipc>())
}

impl Bus {
    /// Opens the group's shared memory as process `name`.
    ///
    /// # Errors
    /// The group is not running or ends meanwhile, or iceoryx2 fails: no memory, no permission.
    pub fn open(paths: &GroupPaths, name: &str, identity: Identity) -> Result<Self, BusError> {
        let place = paths.shm_name();
        let place = place.map_err(|error| {
            BusError::ipc(&paths.shm_name_file().display().to_string(), error.to_string())
        })?;
        let is_service = identity.incarnation.0 > 0 || Service::from_name(name).is_some();
        if is_service {
            await_cleanup(paths);
        }
        let folder = || place.folder().metadata().map(|folder| folder.ino()).ok();
        let ended = || {
            let help = "help: run the command again, or start the group with `whichone up`";
            BusError::ipc("opening", format!("the group has ended, or renews its memory; {help}"))
        };
        let found = folder().ok_or_else(ended)?;
        let node = open_node(&place, name);
        // iceoryx2 makes its files again if the group ends meanwhile.
        if folder() != Some(found) {
            drop(node);
            shm_cleanup::remove_entries(place.prefix());
            return Err(ended());
        }
        let node = Rc::new(node?);
        let joins = if is_service { Joined::Service } else { Joined::Client };
        let (notifiers, writers) = (RefCell::default(), RefCell::default());
        let (paths, wakes) = (paths.clone(), Wakes::load(paths));
        Ok(Self { node, identity, paths, wakes, joins, notifiers, writers })
    }

    /// Connects the readers that have joined since this process's writers last sent something, and
    /// so hands them the latest message of each topic now instead of with the next one.
    pub fn connect(&self, joined: Joined) {
        self.writers.borrow_mut().retain(|writer| writer.strong_count() > 0);
        let writers: Vec<_> = self.writers.borrow().iter().filter_map(Weak::upgrade).collect();
        writers.iter().for_each(|writer| writer.connect());
        // Clients poll.
        if joined == Joined::Service {
            writers.iter().for_each(|writer| writer.wake_readers());
        }
    }

    /// Asks the writer of a topic that this process has begun to read for its latest messages. If
    /// that fails, they come with its next one.
    fn greet(&self, topic: &Topic) {
        let Some(service) = topic.writer.filter(|_| topic.history > 0) else { return };
        match self.notifier(service) {
            Ok(notifier) => notifier.greet(self.joins),
            Err(error) => tracing::debug!(topic = topic.name, %error, "its writer is not asked"),
        }
    }

    /// Returns the notifier of a service, which is opened once: that of a client with its first
    /// wake-up, which comes after its message.
    fn notifier(&self, service: Service) -> Result<Rc<WakeNotifier>, BusError> {
        let is_of = |(of, _): &&(Service, _)| *of == service;
        if let Some((_, notifier)) = self.notifiers.borrow().iter().find(is_of) {
            return Ok(Rc::clone(notifier));
        }
        let notifier = Rc::new(match self.joins {
            Joined::Client => WakeNotifier::open_later(self, service),
            Joined::Service => WakeNotifier::open(self, service)?,
        });
        self.notifiers.borrow_mut().push((service, Rc::clone(&notifier)));
        Ok(notifier)
    }

    /// Returns the process's identity.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    pub(crate) fn node(&self) -> &Node<Ipc> {
        &self.node
    }

    fn stamps(&self) -> Stamps {
        let Identity { epoch, incarnation } = self.identity;
        Stamps(Cell::new(Stamp { epoch: epoch.0, incarnation: incarnation.0, ..Stamp::default() }))
    }
}

/// The stamps of one writer's messages, which it counts: a message that could not be sent is a gap.
#[derive(Debug)]
struct Stamps(Cell<Stamp>);

impl Stamps {
    /// Returns the stamp of a message that is sent now.
    fn next(&self) -> Stamp {
        let latest = self.0.get();
        // 0 would say that the writer does not count.
        let sequence = latest.sequence.checked_add(1).unwrap_or(1);
        let stamp = Stamp { sent_ns: crate::clock::now().ns(), sequence, ..latest };
        self.0.set(stamp);
        stamp
    }
}
