//! The main loop of every service, the same for first start and restart:
//! recover → open topics → ready → (wait, drain everything, decide, commit, beat)*.
//!
//! Durability comes before visibility: the records of a pass are durable before its outputs are
//! published (`commit`). The loop does not wait for the disk: meanwhile it publishes urgent
//! outputs and takes in further passes, as far as their number is bounded.

use crate::bus::{Bus, PortError, WakeListener};
use crate::clock;
use crate::commit::Commit;
use crate::exit::Failure;
use crate::flight::Tap;
use crate::lifecycle::{Cycle, Health, Ready, Sources};
use crate::worker_channel::DeviceReceiver;
use crate::{Effects, Event, Node, Span, Time};
use runtime::port_failures::PortFailures;
use std::ops::ControlFlow;
use std::time::{SystemTime, UNIX_EPOCH};

mod program;
mod start;

pub use program::{Context, Program, Record, Shell};
pub use start::{program, run};

/// Maximum events per pass; the others wait for the next pass, so that heartbeats and signals are
/// not delayed.
const PASS_EVENTS_MAX: usize = 256;
/// Maximum sleep: inputs are polled this often even if a wake-up was lost.
const LOOK_EVERY: Span = Span::from_ms(500);
/// The disk, as a service reports it to be short.
const SHORT_OF_DISK: &str = "disk";

/// Results of devices.
type In<P> = <<P as Program>::Node as Node>::In<'static>;
type Out<P> = <<P as Program>::Node as Node>::Out;
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
    port_failures: PortFailures,
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
        self.port_failures.judge(self.port_error.take(), clock::now())?;
        // Outputs that wait for a full disk were never acknowledged, and are given up as by a kill.
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

    fn status(&self) -> Option<&str> {
        self.node.status()
    }

    fn shortage(&self) -> Option<&str> {
        self.commit.is_short().then_some(SHORT_OF_DISK).or(self.port_failures.shortage())
    }

    fn rejected(&self) -> u64 {
        self.node.rejected()
    }
}

impl<P: Program> Loop<P> {
    fn feed(&mut self, event: Event<In<P>>) {
        feed(&mut self.node, &mut self.tap, event, &mut self.effects);
    }

    /// Ends a pass of the flight, which continues in another file if that one is long.
    fn end_recorded_pass(&mut self) {
        self.tap.end_pass();
        if self.tap.wants_checkpoint()
            && self.effects.is_empty()
            && let Some(checkpoint) = self.node.checkpoint()
        {
            self.tap.go_on(&checkpoint, clock::now(), wall_ns());
        }
    }

    /// Returns whether new inputs are taken, other than urgent ones.
    fn takes_inputs(&self) -> bool {
        !self.commit.is_behind() && !self.effects.exits()
    }

    /// Returns whether time passes for the node. Moving parts come to rest even if outputs wait.
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
        // A message is handled in place in shared memory, before the next one is taken.
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

    /// Publishes outputs without a record, hands over the records of the pass, and publishes
    /// outputs backed by durable ones. Never the other way round.
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
        if self.node.take_erasure() {
            self.commit.erase();
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
}
