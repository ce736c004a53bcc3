//! A node in a simulated process: it can die at any point between an event and the last of its
//! effects, and comes back from what its journal had synced by then.

use config::Settings;
use service::lifecycle::Environment;
use service::{Effects, Event, Node, Time};

use super::Faults;

/// The point of a pass at which the process dies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crash {
    /// After deciding, before the sync: the records are gone and nothing was seen.
    BeforeSync,
    /// After the sync and this many outputs.
    AfterOutputs(usize),
}

/// A node, its journal, and the configuration that each start gets.
#[allow(missing_debug_implementations, reason = "nodes have none")]
pub struct Host<N: Node> {
    config: Box<dyn Fn() -> N::Config>,
    node: Option<N>,
    journal: Vec<N::Record>,
    /// Number of starts.
    pub incarnation: u32,
}

impl<N: Node> Host<N>
where
    N::Record: Clone,
{
    /// A process that is not started yet.
    pub fn new(config: impl Fn() -> N::Config + 'static) -> Self {
        Self { config: Box::new(config), node: None, journal: Vec::new(), incarnation: 0 }
    }

    /// Starts the process, if it is not up. Returns the outputs of its start.
    ///
    /// # Panics
    /// If recovery from its journal fails.
    pub fn start(&mut self, now: Time) -> Vec<N::Out> {
        if self.node.is_some() {
            return Vec::new();
        }
        self.incarnation += 1;
        let node = N::recover((self.config)(), self.journal.clone());
        self.node = Some(node.unwrap_or_else(|e| panic!("recovery: {e}")));
        self.pass(vec![Event::Started], now, None)
    }

    /// Kills the process; the next one starts with another configuration.
    pub fn replace(&mut self, config: impl Fn() -> N::Config + 'static) {
        (self.node, self.config) = (None, Box::new(config));
    }

    /// Kills the process.
    pub fn kill(&mut self) {
        self.node = None;
    }

    /// Returns whether the process runs.
    pub fn is_up(&self) -> bool {
        self.node.is_some()
    }

    /// The records that were synced.
    pub fn journal(&self) -> &[N::Record] {
        &self.journal
    }

    /// Time of the next tick.
    pub fn deadline(&self) -> Option<Time> {
        self.node.as_ref().and_then(Node::deadline)
    }

    /// The running node.
    pub fn node(&self) -> Option<&N> {
        self.node.as_ref()
    }

    /// One pass of the main loop if there is anything to do: the inbox, and a tick that is due. The
    /// process may die in it.
    pub fn wake(&mut self, inbox: Vec<N::In>, now: Time, faults: &mut Faults) -> Vec<N::Out> {
        let due = self.deadline().is_some_and(|deadline| deadline <= now);
        if inbox.is_empty() && !due {
            return Vec::new();
        }
        let tick = due.then_some(Event::Tick);
        let events = inbox.into_iter().map(Event::Message).chain(tick).collect();
        let crash = if self.is_up() { faults.crash(now) } else { None };
        self.pass(events, now, crash)
    }

    /// One pass of the main loop: the events and their urgent outputs, then the sync, then the other
    /// outputs, in the order of the real driver. Returns the outputs that became visible.
    pub fn pass(
        &mut self,
        events: Vec<Event<N::In>>,
        now: Time,
        crash: Option<Crash>,
    ) -> Vec<N::Out> {
        let Some(node) = &mut self.node else { return Vec::new() };
        let mut effects = Effects::default();
        events.into_iter().for_each(|event| node.on(event, now, &mut effects));
        if crash == Some(Crash::BeforeSync) {
            self.node = None;
            return effects.take_urgent();
        }
        self.journal.extend(effects.take_records());
        node.on_durable();
        let mut outputs = effects.take_outputs();
        if let Some(Crash::AfterOutputs(count)) = crash {
            self.node = None;
            outputs.truncate(count);
        }
        outputs
    }
}

/// Returns the configuration that the real program gives its node.
///
/// # Panics
/// If the settings are invalid for it.
pub fn configured<P: service::service_loop::Program>(
    settings: &Settings,
) -> impl Fn() -> <P::Node as Node>::Config + use<P> {
    let settings = settings.clone();
    move || P::config(&Environment::nowhere(), &settings).unwrap_or_else(|e| panic!("{e}"))
}
