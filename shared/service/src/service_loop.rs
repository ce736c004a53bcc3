//! The main loop of every service, the same for first start and restart:
//! recover → open topics → ready → (wait, drain everything, decide, commit, beat)*.
//!
//! Durability comes before visibility: all records of a pass are appended and synced once, and only
//! then are its outputs published.

use crate::bus::{Bus, Identity, PortError, WakeListener};
use crate::clock;
use crate::exit::{Exit, Failure};
use crate::inspection::{self, Finding, Part};
use crate::lifecycle::{Cycle, Environment, Health, Lifecycle, drive};
use crate::logging;
use crate::worker_channel::{self, DeviceReceiver, DeviceSender};
use crate::{Effects, Event, Node, Span, Time};
use config::Settings;
use journal::{Header, Journal, JournalOpenError};
use messages::Service;
use serde::{Serialize, de::DeserializeOwned};
use std::ops::ControlFlow;
use std::os::fd::BorrowedFd;
use std::process::ExitCode;

/// Maximum events per pass; the others wait for the next pass, so that heartbeats and signals are not
/// delayed.
const PASS_EVENTS_MAX: usize = 256;
/// Maximum sleep: inputs are polled this often even if a wake-up was lost.
const LOOK_EVERY: Span = Span::from_ms(500);
/// Size at which journals are compacted, if the node offers a snapshot.
const JOURNAL_BYTES: u64 = 1 << 20;
/// Timeout for the previous incarnation to release its journal.
const LOCK_PATIENCE: Span = Span::from_ms(3_000);

/// A service: a node and the shell around it.
pub trait Program: Sized {
    /// The service.
    const SERVICE: Service;
    /// Kind of record in its journal; none for a stateless node. A changed record
    /// type needs a changed name.
    const RECORD: Option<&'static str>;
    /// One paragraph for `--help`.
    const ABOUT: &'static str;
    /// The reducer.
    type Node: Node<Record: Serialize + DeserializeOwned>;
    /// Its topics and devices.
    type Shell: Shell<Self::Node>;

    /// The node's configuration.
    ///
    /// # Errors
    /// Arguments that the service does not know.
    fn config(
        environment: &Environment,
        settings: &Settings,
    ) -> Result<<Self::Node as Node>::Config, Failure>;

    /// Renders a journal record as one line for `whichone journal`, with the settings in force if
    /// they are known.
    fn describe(_settings: Option<&Settings>, _record: &Record<Self>) -> String {
        String::new()
    }

    /// Checks the invariants of the journal, oldest part first. Returns the verified facts.
    ///
    /// # Errors
    /// The first broken invariant, or settings that do not fit.
    fn verify(_settings: Settings, _parts: &[Part<Record<Self>>]) -> Result<Vec<String>, Failure> {
        Ok(Vec::new())
    }

    /// Examines the devices that the service needs, for `whichone doctor`.
    fn doctor(_settings: &Settings) -> Vec<Finding> {
        Vec::new()
    }
}

/// The topics and devices of one node.
pub trait Shell<N: Node>: Sized {
    /// Opens them.
    ///
    /// # Errors
    /// A topic of another schema, or a device that is needed and missing.
    fn open(context: &Context<'_, N::In>) -> Result<Self, Failure>;

    /// Hands every waiting message to `take`.
    ///
    /// # Errors
    /// A topic cannot be read.
    fn drain(&mut self, take: &mut dyn FnMut(N::In)) -> Result<(), PortError>;

    /// Sends one output or gives it to a device.
    ///
    /// # Errors
    /// A topic cannot be written.
    fn publish(&mut self, output: N::Out) -> Result<(), PortError>;
}

/// Resources of a shell.
#[derive(Debug)]
pub struct Context<'a, In> {
    /// The group's shared memory.
    pub bus: &'a Bus,
    /// The settings in force.
    pub settings: &'a Settings,
    /// For device threads.
    pub devices: DeviceSender<In>,
    /// Environment of the process: group, epoch and incarnation.
    pub environment: &'a Environment,
}

/// Runs the service until it is asked to shut down, or the inspection that the arguments name.
pub fn run<P: Program>() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(exit) = inspection::run::<P>(&arguments) {
        return exit.code();
    }
    program(P::SERVICE.name(), P::ABOUT, serve::<P>)
}

/// Runs a service's program: prints `--help` with its name and `about`, or initialises logging, calls
/// `serve` with the arguments and returns its exit code.
pub fn program(
    name: &str,
    about: &str,
    serve: impl FnOnce(Vec<String>) -> Result<(), Failure>,
) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|a| a == "--help" || a == "-h") {
        return help(name, about);
    }
    logging::init();
    match serve(arguments) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            tracing::error!(exit = failure.exit as u8, "{failure}");
            failure.exit.code()
        }
    }
}

fn help(name: &str, about: &str) -> ExitCode {
    use std::io::Write;
    let text = format!(
        "whichone-{name}: {about}\n\nStarted by the group's supervisor (whichone up); put your own in \
         its place with:\n  whichone swap {name} -- COMMAND…\n"
    );
    // A closed pipe is the reader's choice.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Exit::Ok.code()
}

fn serve<P: Program>(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let config = P::config(&environment, &settings)?;
    let (journal, records) = open_journal::<P>(&environment)?;
    let node = P::Node::recover(config, records)?;
    let identity = Identity { epoch: environment.epoch, incarnation: environment.incarnation };
    let bus = Bus::open(&environment.paths, P::SERVICE.name(), identity)?;
    let wake_listener = bus.wake_listener(P::SERVICE)?;
    let (devices, inbox) =
        worker_channel::channel().map_err(|e| Failure::new(Exit::NotReached, e.to_string()))?;
    let context = Context { bus: &bus, settings: &settings, devices, environment: &environment };
    let shell = P::Shell::open(&context)?;
    let mut service =
        Loop::<P> { node, shell, journal, inbox, wake_listener, effects: Effects::default() };
    service.node.on(Event::Started, clock::now(), &mut service.effects);
    service.commit()?;
    drive(lifecycle, &mut service)
}

/// Journal record of a program's node.
pub type Record<P> = <<P as Program>::Node as Node>::Record;
type In<P> = <<P as Program>::Node as Node>::In;
type Out<P> = <<P as Program>::Node as Node>::Out;
/// The journal of a service, if it has one, and its records.
type Recovered<P> = (Option<Journal<Record<P>>>, Vec<Record<P>>);

fn open_journal<P: Program>(environment: &Environment) -> Result<Recovered<P>, Failure> {
    let Some(record) = P::RECORD else { return Ok((None, Vec::new())) };
    let path = environment.paths.journal_file(P::SERVICE.name());
    let header = Header {
        record: record.to_owned(),
        group: environment.paths.name().to_string(),
        epoch: environment.epoch.0,
    };
    let until = clock::now() + LOCK_PATIENCE;
    loop {
        match Journal::open(&path, &header) {
            Ok((journal, recovered)) => {
                if recovered.truncated_bytes > 0 {
                    tracing::warn!(bytes = recovered.truncated_bytes, "torn tail cut off");
                }
                tracing::info!(records = recovered.records.len(), "journal recovered");
                return Ok((Some(journal), recovered.records));
            }
            Err(JournalOpenError::Locked { .. }) if clock::now() < until => {
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            Err(error) => {
                let exit = match error {
                    JournalOpenError::Locked { .. } | JournalOpenError::Io { .. } => Exit::Storage,
                    _ => Exit::Config,
                };
                return Err(Failure::new(exit, format!("{}: {error}", path.display())));
            }
        }
    }
}

struct Loop<P: Program> {
    node: P::Node,
    shell: P::Shell,
    journal: Option<Journal<Record<P>>>,
    inbox: DeviceReceiver<In<P>>,
    wake_listener: WakeListener,
    effects: Effects<Out<P>, Record<P>>,
}

impl<P: Program> Cycle for Loop<P> {
    fn wake(&self, now: Time) -> (Vec<BorrowedFd<'_>>, Time) {
        let latest = now + LOOK_EVERY;
        let until = self.node.deadline().map_or(latest, |deadline| deadline.min(latest));
        (vec![self.wake_listener.fd(), self.inbox.fd()], until)
    }

    fn shut_down(&mut self) {
        self.node.on(Event::Shutdown, clock::now(), &mut self.effects);
    }

    fn pass(&mut self) -> Result<ControlFlow<()>, Failure> {
        self.take_in()?;
        self.commit()?;
        Ok(if self.effects.exits() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(self.node.pending_since())
    }
}

impl<P: Program> Loop<P> {
    /// Feeds everything that waits to the node.
    fn take_in(&mut self) -> Result<(), Failure> {
        self.wake_listener.clear();
        self.inbox.clear();
        let mut arrived = Vec::new();
        self.shell.drain(&mut |message| arrived.push(message))?;
        while arrived.len() < PASS_EVENTS_MAX
            && let Some(message) = self.inbox.take()
        {
            arrived.push(message);
        }
        for message in arrived {
            self.node.on(Event::Message(message), clock::now(), &mut self.effects);
        }
        if self.node.deadline().is_some_and(|deadline| deadline <= clock::now()) {
            self.node.on(Event::Tick, clock::now(), &mut self.effects);
        }
        Ok(())
    }

    /// Makes the pass durable, then visible. Never the other way round.
    fn commit(&mut self) -> Result<(), Failure> {
        let records = self.effects.take_records();
        if let Some(journal) = &mut self.journal
            && !records.is_empty()
        {
            let storage = |e: String| Failure::new(Exit::Storage, e);
            for record in &records {
                journal.append(record).map_err(|e| storage(e.to_string()))?;
            }
            journal.sync().map_err(|e| storage(e.to_string()))?;
        }
        for output in self.effects.take_outputs() {
            self.shell.publish(output)?;
        }
        self.shorten()
    }

    /// Cuts a long journal short where nothing is in progress.
    fn shorten(&mut self) -> Result<(), Failure> {
        let Some(journal) = &mut self.journal else { return Ok(()) };
        if journal.bytes() < JOURNAL_BYTES {
            return Ok(());
        }
        let Some(snapshot) = self.node.snapshot() else { return Ok(()) };
        journal.rotate(&snapshot).map_err(|e| Failure::new(Exit::Storage, e.to_string()))?;
        tracing::info!(records = snapshot.len(), "journal rotated with a snapshot");
        Ok(())
    }
}
