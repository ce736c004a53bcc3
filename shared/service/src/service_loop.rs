//! The main loop of every service, the same for first start and restart:
//! recover → open topics → ready → (wait, drain everything, decide, commit, beat)*.
//!
//! Durability comes before visibility: the records of a pass are durable before its outputs are
//! published ([`crate::commit`]). The loop does not wait for the disk: meanwhile it publishes urgent
//! outputs and takes in further passes, as far as their number is bounded.

use crate::bus::{Bus, Identity, PortError, WakeListener};
use crate::clock;
use crate::commit::Commit;
use crate::exit::{Exit, Failure};
use crate::flight::{Decision, Head, Ring, Tap};
use crate::inspection::{self, Finding, Part, SharedFacts};
use crate::journal_record::JournalRecord;
use crate::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use crate::logging;
use crate::notify::Notifier;
use crate::worker_channel::{self, DeviceReceiver, DeviceSender};
use crate::{Effects, Event, Node, SetAside, Span, Time, journal_set};
use config::Settings;
use journal::Journal;
use messages::Service;
use std::ops::ControlFlow;
use std::os::fd::BorrowedFd;
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

/// Maximum events per pass; the others wait for the next pass, so that heartbeats and signals are not
/// delayed.
const PASS_EVENTS_MAX: usize = 256;
/// Maximum sleep: inputs are polled this often even if a wake-up was lost.
const LOOK_EVERY: Span = Span::from_ms(500);
/// The disk, as a service reports it to be short.
const SHORT_OF_DISK: &str = "disk";
/// Time that a topic may fail without a break before the service gives up: a restart may help then.
const PORT_PATIENCE: Span = Span::from_ms(10_000);

/// A service: a node and the shell around it.
pub trait Program: Sized {
    /// The service.
    const SERVICE: Service;
    /// Kind of record in its journal; none for a stateless node. A changed record
    /// type needs a changed name.
    const RECORD: Option<&'static str>;
    /// One paragraph for `--help`.
    const ABOUT: &'static str;
    /// Whether its flights are recorded: not where the reducer only passes things on.
    const RECORDS_FLIGHTS: bool = true;
    /// The reducer.
    type Node: Node;
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

    /// Returns when a journal record was written.
    fn recorded_at(_record: &Record<Self>) -> Time {
        Time(0)
    }

    /// Renders a journal record as one line for `whichone journal`, without its time, with the settings
    /// that were in force, newest first.
    fn describe(_settings: &[Settings], _record: &Record<Self>) -> String {
        String::new()
    }

    /// Returns a journal record as `whichone journal --json` prints it, with the settings that were in
    /// force, newest first; none for a stateless service.
    fn explain(_settings: &[Settings], _record: &Record<Self>) -> Option<JournalRecord> {
        None
    }

    /// What was decided with a journal record, as far as that is for replays with other settings to compare.
    fn decision(_settings: &Settings, _record: &Record<Self>) -> Option<Decision> {
        None
    }

    /// Checks the invariants of the journal, oldest part first, with the settings that were in force,
    /// newest first. Returns the verified facts.
    ///
    /// # Errors
    /// The first broken invariant, or settings of which none fit.
    fn verify(
        _settings: &[Settings],
        _parts: &[Part<Record<Self>>],
    ) -> Result<Vec<String>, Failure> {
        Ok(Vec::new())
    }

    /// What the journals of the others must agree with.
    fn shared_facts(_parts: &[Part<Record<Self>>]) -> SharedFacts {
        SharedFacts::default()
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
    fn open(context: &Context<'_, N::In<'static>>) -> Result<Self, Failure>;

    /// Hands every waiting urgent message to `take`, where it lies: inputs that come before all others, and are taken
    /// even while the service waits for storage. `is_readable` is that of [`Shell::urgent_fd`].
    ///
    /// # Errors
    /// A topic cannot be read.
    fn drain_urgent(
        &mut self,
        _is_readable: bool,
        _take: &mut dyn FnMut(N::In<'_>),
    ) -> Result<(), PortError> {
        Ok(())
    }

    /// Returns the descriptor that is readable while an urgent message waits, beside the topics.
    fn urgent_fd(&self) -> Option<BorrowedFd<'_>> {
        None
    }

    /// Hands every other waiting message to `take`, where it lies.
    ///
    /// # Errors
    /// A topic cannot be read.
    fn drain(&mut self, take: &mut dyn FnMut(N::In<'_>)) -> Result<(), PortError>;

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
    let _log = logging::init();
    match serve(arguments) {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            tracing::error!(exit = failure.exit as u8, "{failure}");
            if failure.exit == Exit::Storage
                && let Ok(mut supervisor) = Notifier::from_environment()
            {
                supervisor.say(&format!("X_SHORTAGE={failure}"));
            }
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
    let (journal, records, set_aside) = open_journal::<P>(&environment)?;
    let tap = start_tap::<P>(&environment, &settings, &records);
    let node = P::Node::recover(config, records)?;
    let failed = |e: std::io::Error| Failure::new(Exit::NotReached, e.to_string());
    let file = environment.paths.journal_file(P::SERVICE.name());
    let commit = Commit::start(journal, &file).map_err(failed)?;
    let identity = Identity { epoch: environment.epoch, incarnation: environment.incarnation };
    let (devices, inbox) = worker_channel::channel().map_err(failed)?;
    let (bus, shell, wake_listener) = open_topics::<P>(&environment, identity, &settings, devices)?;
    let mut service = Loop::<P> {
        node,
        shell,
        commit,
        inbox,
        wake_listener,
        effects: Effects::default(),
        tap,
        port_error: None,
        port_failure: None,
        bus,
    };
    if let Some(set_aside) = set_aside {
        service.feed(Event::SetAside(set_aside));
    }
    service.feed(Event::Started);
    service.commit()?;
    service.tap.end_pass();
    drive(lifecycle, &mut service)
}

/// Begins the recording of this start.
fn start_tap<P: Program>(
    environment: &Environment,
    settings: &Settings,
    records: &[Record<P>],
) -> Tap {
    let config::Flight { enabled, bytes_max, free_min } = settings.group.flight;
    if !enabled || !P::RECORDS_FLIGHTS {
        return Tap::default();
    }
    let head = Head::of::<P>(environment, settings, clock::now(), wall_ns());
    let ring = Ring { folder: environment.paths.flights(), bytes_max, free_min };
    Tap::start(ring, &head, records)
}

/// Returns the wall time, nanoseconds since 1970.
fn wall_ns() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos() as u64
}

/// Gives the node an event, and records it.
fn feed<N: Node>(
    node: &mut N,
    tap: &mut Tap,
    event: Event<N::In<'_>>,
    effects: &mut Effects<N::Out, N::Record>,
) {
    let now = clock::now();
    tap.event(&event, now);
    node.on(event, now, effects);
}

fn open_topics<P: Program>(
    environment: &Environment,
    identity: Identity,
    settings: &Settings,
    devices: DeviceSender<In<P>>,
) -> Result<(Bus, P::Shell, WakeListener), Failure> {
    let bus = Bus::open(&environment.paths, P::SERVICE.name(), identity)?;
    let wake_listener = bus.wake_listener(P::SERVICE)?;
    let shell = P::Shell::open(&Context { bus: &bus, settings, devices, environment })?;
    Ok((bus, shell, wake_listener))
}

/// Journal record of a program's node.
pub type Record<P> = <<P as Program>::Node as Node>::Record;
/// What devices hand over.
type In<P> = <<P as Program>::Node as Node>::In<'static>;
type Out<P> = <<P as Program>::Node as Node>::Out;
/// The journal of a service, if it has one, its records, and the numbers that are over.
type Recovered<P> = (Option<Journal<Record<P>>>, Vec<Record<P>>, Option<SetAside>);

fn open_journal<P: Program>(environment: &Environment) -> Result<Recovered<P>, Failure> {
    let Some(record) = P::RECORD else { return Ok((None, Vec::new(), None)) };
    let (journal, recovered, set_aside) =
        journal_set::open(environment, P::SERVICE.name(), record)?;
    if recovered.truncated_bytes > 0 {
        tracing::warn!(bytes = recovered.truncated_bytes, "torn tail cut off");
    }
    tracing::info!(records = recovered.records.len(), "journal recovered");
    Ok((Some(journal), recovered.records, set_aside))
}

struct Loop<P: Program> {
    node: P::Node,
    shell: P::Shell,
    commit: Commit<Out<P>, Record<P>>,
    inbox: DeviceReceiver<In<P>>,
    wake_listener: WakeListener,
    effects: Effects<Out<P>, Record<P>>,
    tap: Tap,
    /// Failure of a topic in this pass.
    port_error: Option<PortError>,
    /// Failure of a topic in the last pass, and since when passes have had one.
    port_failure: Option<(String, Time)>,
    bus: Bus,
}

impl<P: Program> Cycle for Loop<P> {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        let latest = now + LOOK_EVERY;
        let deadline = self.node.deadline().filter(|_| self.takes_ticks());
        let until = deadline.map_or(latest, |deadline| deadline.min(latest));
        let Self { shell, commit, inbox, .. } = self;
        ([shell.urgent_fd(), Some(commit.fd()), Some(inbox.fd())], until)
    }

    fn shut_down(&mut self) {
        self.feed(Event::Shutdown);
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        let [is_urgent, _, _] = ready.sources;
        if ready.by_wake
            && let Some(joined) = self.wake_listener.take()
        {
            self.bus.connect(joined);
        }
        self.port_error = self.take_in(is_urgent).err();
        self.commit()?;
        self.end_recorded_pass();
        self.judge_ports()?;
        // What waits for a full disk was never acknowledged, and is given up as by a kill.
        let is_done = self.commit.is_settled() || self.commit.is_short();
        let ends = self.effects.exits() && is_done;
        Ok(if ends { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn is_ready(&self) -> bool {
        self.node.is_ready()
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(self.node.pending_since())
    }

    fn shortage(&self) -> Option<&str> {
        let port_failure = self.port_failure.as_ref().map(|(what, _)| what.as_str());
        self.commit.is_short().then_some(SHORT_OF_DISK).or(port_failure)
    }
}

impl<P: Program> Loop<P> {
    fn feed(&mut self, event: Event<In<P>>) {
        feed(&mut self.node, &mut self.tap, event, &mut self.effects);
    }

    /// Ends a pass of the flight, which continues in another file where that one is long.
    fn end_recorded_pass(&mut self) {
        self.tap.end_pass();
        if self.tap.wants_checkpoint()
            && self.effects.is_empty()
            && let Some(checkpoint) = self.node.checkpoint()
        {
            self.tap.go_on(&checkpoint, clock::now(), wall_ns());
        }
    }

    /// Returns whether new inputs are taken, beside urgent ones.
    fn takes_inputs(&self) -> bool {
        !self.commit.is_behind() && !self.effects.exits()
    }

    /// Returns whether time passes for the node. What moves is brought to rest whatever waits.
    fn takes_ticks(&self) -> bool {
        let is_urgent = self.shell.urgent_fd().is_some();
        (is_urgent || !self.commit.is_behind()) && !self.effects.exits()
    }

    /// Feeds everything that waits to the node.
    fn take_in(&mut self, is_urgent: bool) -> Result<(), PortError> {
        self.inbox.clear();
        let takes_inputs = self.takes_inputs();
        let Self { node, shell, inbox, effects, tap, .. } = self;
        let mut handled = 0;
        // A message is handled where it lies in shared memory, before the next one is taken.
        let mut handle = |message: <P::Node as Node>::In<'_>| {
            feed(node, tap, Event::Message(message), effects);
            handled += 1;
        };
        let mut result = shell.drain_urgent(is_urgent, &mut handle);
        if takes_inputs {
            result = result.and(shell.drain(&mut handle));
            let left = PASS_EVENTS_MAX.saturating_sub(handled);
            for message in std::iter::from_fn(|| inbox.take()).take(left) {
                feed(node, tap, Event::Message(message), effects);
            }
        }
        if self.takes_ticks() && self.node.deadline().is_some_and(|due| due <= clock::now()) {
            self.feed(Event::Tick);
        }
        result
    }

    /// Publishes what waits for no record, hands over the records of the pass, and publishes what is
    /// backed by durable ones. Never the other way round.
    fn commit(&mut self) -> Result<(), Failure> {
        self.tap.stated(&self.effects);
        let urgent = self.effects.take_urgent();
        self.publish(urgent);
        let settled = self.commit.settle()?;
        self.publish(settled);
        let now_durable = self.commit.state(&mut self.effects)?;
        self.publish(now_durable);
        if self.commit.is_settled() {
            self.node.on_durable();
            self.tap.durable();
        }
        if self.commit.wants_snapshot()
            && let Some(snapshot) = self.node.snapshot()
        {
            self.commit.rotate(snapshot)?;
        }
        Ok(())
    }

    /// A topic that cannot be written loses a message, as one does whose reader is slow.
    fn publish(&mut self, outputs: Vec<Out<P>>) {
        for output in outputs {
            let failure = self.shell.publish(output).err();
            self.port_error = self.port_error.take().or(failure);
        }
    }

    /// Bears with a failing topic for a while: shared memory or descriptors may be short, and what
    /// moves has to be stopped all the same.
    fn judge_ports(&mut self) -> Result<(), Failure> {
        let Some(error) = self.port_error.take() else {
            self.port_failure = None;
            return Ok(());
        };
        let now = clock::now();
        let (what, since) = self.port_failure.get_or_insert_with(|| {
            tracing::error!(%error, "a topic fails; trying again");
            (error.to_string(), now)
        });
        if now.since(*since) < PORT_PATIENCE {
            return Ok(());
        }
        Err(Failure::new(Exit::NotReached, std::mem::take(what)))
    }
}
