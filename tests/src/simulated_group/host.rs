//! A node in a simulated process: it can die at any point between an event and the last of its
//! effects, and comes back from what its disk has kept of its journal by then.

use std::path::{Path, PathBuf};

use config::Settings;
use serde::Serialize;
use serde::de::DeserializeOwned;
use service::flight::{Head, Ring, Tap};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::{Effects, Event, Node, Time};

use super::Faults;
use super::disk::Disk;

/// Most passes that wait for the disk: with more nothing new is taken in, as in the real loop.
const WAITING_MAX: usize = 256;

/// The point of a pass at which the process dies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crash {
    /// After deciding, before a byte is written.
    BeforeWrite,
    /// While the records are written: the disk may have any part of them, and nothing was seen.
    DuringSync,
    /// After the sync and this many outputs.
    AfterOutputs(usize),
}

/// Records and outputs of one pass.
type Batch<N> = (Vec<<N as Node>::Record>, Vec<<N as Node>::Out>);

/// Begins the flight of a start in a folder.
type Record<N> = dyn Fn(&Path, &[<N as Node>::Record], Time) -> Tap;

/// A node, its journal, and the configuration that each start gets.
#[allow(missing_debug_implementations, reason = "nodes have none")]
pub struct Host<N: Node> {
    config: Box<dyn Fn() -> N::Config>,
    record: Box<Record<N>>,
    /// Folder of the flights, if they are recorded, and how many passes each file holds.
    flights: Option<(PathBuf, u64)>,
    passes: u64,
    files: u64,
    tap: Tap,
    node: Option<N>,
    disk: Disk<N::Record>,
    /// Passes that wait for room on the disk.
    waiting: Vec<Batch<N>>,
    /// Until when the disk is full.
    full_until: Time,
    /// Number of starts.
    pub incarnation: u32,
}

impl<N: Node> Host<N>
where
    N::Record: Clone + PartialEq + Serialize + DeserializeOwned,
{
    /// A program's process that is not started yet.
    pub fn new<P: Program<Node = N>>(settings: &Settings) -> Self {
        Self {
            config: configured::<P>(settings),
            record: recorded::<P>(settings),
            flights: None,
            passes: 0,
            files: 0,
            tap: Tap::default(),
            node: None,
            disk: Disk::new(P::RECORD.unwrap_or("none")),
            waiting: Vec::new(),
            full_until: Time(0),
            incarnation: 0,
        }
    }

    /// Starts the process, if it is not up. Returns the outputs of its start.
    ///
    /// # Panics
    /// If recovery from its journal fails.
    pub fn start(&mut self, now: Time, faults: &mut Faults) -> Vec<N::Out> {
        if self.node.is_some() {
            return Vec::new();
        }
        self.incarnation += 1;
        let records = self.disk.open();
        if let Some((folder, _)) = &self.flights {
            self.tap = (self.record)(folder, &records, now);
            self.passes = 0;
        }
        let node = N::recover((self.config)(), records);
        self.node = Some(node.unwrap_or_else(|e| panic!("recovery: {e}")));
        let crash = faults.crash(now);
        self.pass(vec![Event::Started], now, crash, faults)
    }

    /// Kills the process; the next one starts with another configuration.
    pub fn replace<P: Program<Node = N>>(&mut self, settings: &Settings) {
        self.kill();
        self.config = configured::<P>(settings);
        self.record = recorded::<P>(settings);
    }

    /// Records flights of all further starts in a folder: another one after so many passes, once the node
    /// can be described.
    pub fn record(&mut self, folder: &Path, passes: u64) {
        self.flights = Some((folder.to_owned(), passes));
    }

    fn go_on_recording(&mut self, now: Time) {
        self.passes += 1;
        let longest = self.flights.as_ref().map_or(u64::MAX, |(_, passes)| *passes);
        if self.passes >= longest
            && let Some(checkpoint) = self.node.as_ref().and_then(Node::checkpoint)
        {
            self.passes = 0;
            // Files are named by milliseconds, and several passes may be at one time.
            self.files += 1;
            self.tap.go_on(&checkpoint, now, now.ns() + self.files * 1_000_000);
        }
    }

    /// Kills the process.
    pub fn kill(&mut self) {
        self.node = None;
        self.tap = Tap::default();
        self.waiting.clear();
        self.disk.close();
    }

    /// Returns whether the process runs.
    pub fn is_up(&self) -> bool {
        self.node.is_some()
    }

    /// Every record that was durable.
    pub fn journal(&self) -> &[N::Record] {
        self.disk.all()
    }

    /// Time of the next tick.
    pub fn deadline(&self) -> Option<Time> {
        self.node.as_ref().and_then(Node::deadline)
    }

    /// The running node.
    pub fn node(&self) -> Option<&N> {
        self.node.as_ref()
    }

    /// One pass of the main loop if there is anything to do: what has waited for the disk, the inbox,
    /// and a tick that is due. The process may die in it.
    pub fn wake(
        &mut self,
        inbox: Vec<N::In<'static>>,
        now: Time,
        faults: &mut Faults,
    ) -> Vec<N::Out> {
        if !self.is_up() {
            return Vec::new();
        }
        let has_room = !self.waiting.is_empty() && now >= self.full_until;
        let due = self.deadline().is_some_and(|deadline| deadline <= now);
        let is_behind = self.waiting.len() >= WAITING_MAX;
        if !has_room && (is_behind || inbox.is_empty() && !due) {
            return Vec::new();
        }
        let tick = due.then_some(Event::Tick);
        let events = inbox.into_iter().map(Event::Message).chain(tick).collect();
        let crash = faults.crash(now);
        self.pass(events, now, crash, faults)
    }

    /// One pass of the main loop: the events and their urgent outputs, then the sync, then the other
    /// outputs, in the order of the real driver. Returns the outputs that became visible.
    ///
    /// On a full disk the node goes on, and everything but urgent outputs waits for room.
    fn pass(
        &mut self,
        events: Vec<Event<N::In<'static>>>,
        now: Time,
        crash: Option<Crash>,
        faults: &mut Faults,
    ) -> Vec<N::Out> {
        let Some(node) = &mut self.node else { return Vec::new() };
        let mut effects = Effects::default();
        for event in events {
            self.tap.event(&event, now);
            node.on(event, now, &mut effects);
        }
        self.tap.stated(&effects);
        self.tap.end_pass();
        let mut visible = effects.take_urgent();
        if let Some(until) = faults.disk_full(now) {
            self.full_until = until;
        }
        self.waiting.push((effects.take_records(), effects.take_outputs()));
        let has_records = self.waiting.iter().any(|(records, _)| !records.is_empty());
        if has_records && now < self.full_until {
            if crash.is_some() {
                self.kill();
            }
            return visible;
        }
        visible.extend(self.commit(crash, faults));
        self.go_on_recording(now);
        visible
    }

    fn commit(&mut self, crash: Option<Crash>, faults: &mut Faults) -> Vec<N::Out> {
        let (records, outputs): (Vec<_>, Vec<_>) = self.waiting.drain(..).unzip();
        let records: Vec<_> = records.into_iter().flatten().collect();
        let mut outputs: Vec<_> = outputs.into_iter().flatten().collect();
        match crash {
            Some(Crash::BeforeWrite) => {
                self.kill();
                return Vec::new();
            }
            Some(Crash::DuringSync) if !records.is_empty() => {
                self.disk.tear(records, faults.rng());
                self.kill();
                return Vec::new();
            }
            _ if records.is_empty() => {}
            _ => self.disk.write(records),
        }
        match (crash, &mut self.node) {
            (Some(Crash::AfterOutputs(count)), _) => {
                outputs.truncate(count);
                self.kill();
            }
            (Some(_), _) => {
                outputs.clear();
                self.kill();
            }
            (None, Some(node)) => {
                node.on_durable();
                self.tap.durable();
                self.disk.shorten(|| node.snapshot());
            }
            (None, None) => {}
        }
        outputs
    }
}

/// Returns what records the flights of the program.
fn recorded<P: Program>(settings: &Settings) -> Box<Record<P::Node>> {
    let settings = settings.clone();
    Box::new(move |folder, records, now| {
        let ring = Ring { folder: folder.to_owned(), bytes_max: 1 << 30, free_min: 0 };
        let head = Head::of::<P>(&Environment::nowhere(), &settings, now, now.ns());
        Tap::start(ring, &head, records)
    })
}

/// Returns the configuration that the real program gives its node.
fn configured<P: Program>(settings: &Settings) -> Box<dyn Fn() -> <P::Node as Node>::Config> {
    let settings = settings.clone();
    Box::new(move || {
        P::config(&Environment::nowhere(), &settings).unwrap_or_else(|e| panic!("{e}"))
    })
}
