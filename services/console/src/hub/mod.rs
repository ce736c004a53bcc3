//! The hub between bridge and server: the board, the viewers, the lease of control, and the
//! channels to the main loop.

pub mod board;
pub mod command;
pub mod lease;
pub mod outbound;
mod viewers;

#[cfg(test)]
pub(crate) mod tests;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use group_metrics::Metrics;
use messages::StopId;
use serde::Serialize;
use service::worker_channel::DeviceSender;
use service::{Span, Time};
use tokio::sync::{mpsc, watch};

use board::Board;
use command::{Command, Motion, Verb};
use lease::{Lease, Taken};
use outbound::{Answer, PageMessage};
pub use service::view::ms;
use viewers::Viewers;
pub use viewers::{OutboundFrame, Role};

/// A viewer's number, in a page `v3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ViewerId(pub u64);

impl std::fmt::Display for ViewerId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "v{}", self.0)
    }
}

impl std::str::FromStr for ViewerId {
    type Err = std::num::ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.strip_prefix('v').unwrap_or_default().parse().map(Self)
    }
}

/// Channels to the main loop and to the supervisor's thread.
#[derive(Debug)]
pub struct Channels {
    pub commands: DeviceSender<Command>,
    /// To the main loop, before everything else.
    pub motions: DeviceSender<Motion>,
    /// To the thread that talks to the supervisor: restarts that viewers ask for.
    pub restarts: crossbeam_channel::Sender<(ViewerId, u64, String)>,
}

#[derive(Debug, Serialize)]
struct ControlSection<'a> {
    operator: Option<String>,
    name: Option<&'a String>,
    /// Whether the operator's page is gone: nobody is in control until its return or the end.
    away: bool,
    viewers: usize,
    asked_by: Option<String>,
    asked_name: Option<&'a String>,
    expires_ms: Option<f64>,
    /// Whether the operator's page is that of a study's participant.
    participant: bool,
}

/// Shared by bridge and server.
#[derive(Debug)]
pub struct Hub {
    pub board: Board,
    pub metrics: Metrics,
    channels: Channels,
    control: Mutex<Control>,
    viewers_max: usize,
    ending: watch::Sender<bool>,
    /// Beats of the web server's tasks.
    pub progress: AtomicU64,
    /// Time of the main loop's last pass, nanoseconds.
    alive: AtomicU64,
}

#[derive(Debug)]
struct Control {
    viewers: Viewers,
    lease: Lease,
}

/// Returns whether a command concerns the participant of the page that gives it, which proves
/// itself by its secret. All others need control of the robot.
fn is_of_own_participant(verb: &Verb) -> bool {
    const OWN: [&str; 7] = ["find", "begin", "consent", "next", "start", "answer", "withdraw"];
    matches!(verb, Verb::Study(verb, _) if OWN.contains(&verb.as_str()))
}

impl Hub {
    pub fn new(channels: Channels, viewers_max: usize, handover: Span, metrics: Metrics) -> Self {
        let control = Control { viewers: Viewers::default(), lease: Lease::new(handover) };
        let hub = Self {
            board: Board::default(),
            metrics,
            channels,
            control: Mutex::new(control),
            viewers_max,
            ending: watch::Sender::new(false),
            progress: AtomicU64::new(0),
            alive: AtomicU64::new(0),
        };
        hub.show(&hub.control());
        hub
    }

    /// Admits a page; returns its number and the frames for it alone. One place is reserved for a
    /// page that may operate the robot; if all are taken, the page that was idle for the longest
    /// time gives way.
    pub fn join(
        &self,
        name: &str,
        session: &str,
        role: Role,
        now: Time,
    ) -> Result<(ViewerId, mpsc::Receiver<OutboundFrame>), String> {
        let mut control = self.control();
        let Control { viewers, lease } = &mut *control;
        // The server does so only once a second without connections.
        lease.tick(now, |viewer| viewers.session(viewer));
        if !viewers.has_session(session) {
            let places = match role {
                Role::Operator => self.viewers_max,
                Role::Viewer | Role::Screen => self.viewers_max - 1,
            };
            match role {
                _ if viewers.len() < places => {}
                Role::Operator => viewers.give_way(lease.operator()),
                Role::Viewer | Role::Screen => {
                    let most = self.viewers_max;
                    return Err(format!(
                        "{most} pages are open, or reserved; help: close one, or raise console.viewers_max"
                    ));
                }
            }
        }
        let (viewer, frames) = viewers.add(name.to_owned(), session.to_owned(), role, now);
        lease.joined(viewer, session, role == Role::Operator);
        self.show(&control);
        Ok((viewer, frames))
    }

    /// Notes that a viewer's user does something.
    pub fn note(&self, viewer: ViewerId, now: Time) {
        self.control().viewers.note(viewer, now);
    }

    pub fn leave(&self, viewer: ViewerId, now: Time) {
        let mut control = self.control();
        control.viewers.remove(viewer);
        control.lease.left(viewer, now);
        self.show(&control);
        drop(control);
        // A lost `Left` is covered by the timeout of the stream.
        let _ = self.channels.commands.offer(Command::Left(viewer));
    }

    pub fn viewers(&self) -> usize {
        self.control().viewers.len()
    }

    pub fn tick(&self, now: Time) {
        let mut control = self.control();
        let Control { viewers, lease } = &mut *control;
        if lease.tick(now, |viewer| viewers.session(viewer)) {
            self.show(&control);
        }
    }

    /// Sends a message to one page.
    pub fn send(&self, viewer: ViewerId, message: &PageMessage<'_>) {
        self.send_frame(viewer, OutboundFrame::Text(message.to_text()));
    }

    /// Sends a frame to one viewer; one that does not read is disconnected.
    fn send_frame(&self, viewer: ViewerId, frame: OutboundFrame) {
        let mut control = self.control();
        let Some(there) = control.viewers.get(viewer) else { return };
        if let Err(mpsc::error::TrySendError::Full(_)) = there.queue.try_send(frame) {
            tracing::warn!(%viewer, "disconnected: it does not read its answers");
            control.viewers.remove(viewer);
        }
    }

    pub fn answer(&self, viewer: ViewerId, id: u64, outcome: Result<Option<Answer>, String>) {
        self.send_frame(viewer, OutboundFrame::Answer(id, outcome));
    }

    /// Reports to a viewer that a message of its made no sense.
    pub fn error(&self, viewer: ViewerId, error: &str) {
        self.send(viewer, &PageMessage::Error { error });
    }

    /// Passes a command to the bridge, which answers by [`Hub::answer`].
    ///
    /// Words that tell the robot to stop go to the arm first, on the motion stop's own path,
    /// whoever may speak to it and whatever becomes of the words.
    pub fn ask(&self, viewer: ViewerId, id: u64, verb: Verb) -> Result<(), String> {
        let stops = matches!(&verb, Verb::Say(words) if language::is_stop(&words.text));
        if stops {
            self.order(Motion { viewer, id: None, stop: true, of: StopId(0) })?;
        }
        let asked = self.ask_verb(viewer, id, verb);
        asked.map_err(
            |why| if stops { format!("{why}; the stop is given all the same") } else { why },
        )
    }

    fn ask_verb(&self, viewer: ViewerId, id: u64, verb: Verb) -> Result<(), String> {
        match is_of_own_participant(&verb) {
            true => self.mark_participant(viewer),
            false => self.must_hold(viewer)?,
        }
        let offered = self.channels.commands.offer(Command::Do(viewer, id, verb));
        offered.map_err(|_| "the console is busy; help: try again".to_owned())
    }

    fn mark_participant(&self, viewer: ViewerId) {
        let mut control = self.control();
        if control.viewers.mark_participant(viewer) {
            self.show(&control);
        }
    }

    /// Latches the motion stop for every viewer; the bridge answers.
    pub fn stop(&self, viewer: ViewerId, id: u64) -> Result<(), String> {
        self.order(Motion { viewer, id: Some(id), stop: true, of: StopId(0) })
    }

    /// Releases this stop, 0 for any, for those who may; the bridge answers.
    pub fn release(&self, viewer: ViewerId, id: u64, of: StopId) -> Result<(), String> {
        self.must_release(viewer)?;
        self.order(Motion { viewer, id: Some(id), stop: false, of })
    }

    fn order(&self, motion: Motion) -> Result<(), String> {
        let offered = self.channels.motions.offer(motion);
        let help = "the console is busy; help: use the robot's emergency stop";
        offered.map_err(|_| help.to_owned())
    }

    /// Restarts a service; the supervisor's thread answers.
    pub fn restart(&self, viewer: ViewerId, id: u64, service: String) -> Result<(), String> {
        self.must_hold(viewer)?;
        let sent = self.channels.restarts.try_send((viewer, id, service));
        sent.map_err(|_| "the supervisor is busy; help: try again".to_owned())
    }

    pub fn sound(&self, viewer: ViewerId, frame: crate::voice::PcmFrame) -> Result<(), String> {
        self.must_hold(viewer)?;
        let offered = self.channels.commands.offer(Command::Sound(viewer, frame));
        offered.map_err(|_| "sound was lost: the console is busy".to_owned())
    }

    /// Handles a viewer's request for control.
    pub fn take_control(&self, viewer: ViewerId, now: Time) -> Result<Option<Answer>, String> {
        let mut control = self.control();
        let Control { viewers, lease } = &mut *control;
        let there = viewers.get(viewer).filter(|there| there.role != Role::Screen);
        let there = there.ok_or("a screen has no controls; help: open the console's own page")?;
        let taken = lease.take(viewer, &there.session, now)?;
        self.show(&control);
        Ok(Some(match taken {
            Taken::Granted => Answer::Control { granted: true, expires_ms: None },
            Taken::Asked(until) => Answer::Control { granted: false, expires_ms: Some(ms(until)) },
        }))
    }

    /// The operator hands control to another viewer.
    pub fn give_control(&self, viewer: ViewerId, to: ViewerId) -> Result<Option<Answer>, String> {
        self.must_hold(viewer)?;
        let mut control = self.control();
        let Control { viewers, lease } = &mut *control;
        let there = viewers.get(to).filter(|there| there.role != Role::Screen);
        let there = there.ok_or_else(|| format!("{to} is not an open page, or a screen"))?;
        lease.grant(to, &there.session);
        self.show(&control);
        Ok(None)
    }

    /// The operator keeps control despite a request.
    pub fn keep_control(&self, viewer: ViewerId) -> Result<Option<Answer>, String> {
        self.must_hold(viewer)?;
        let mut control = self.control();
        control.lease.keep();
        self.show(&control);
        Ok(None)
    }

    /// Checks that the page of a session is the operator's.
    pub fn must_operate(&self, session: &str) -> Result<(), String> {
        let control = self.control();
        let operator = control.lease.operator();
        let is_own = |operator| control.viewers.session(operator).as_deref() == Some(session);
        if operator.is_some_and(is_own) {
            return Ok(());
        }
        Err("this is for the page of the operator; help: take control first".to_owned())
    }

    /// Checks that a viewer may release the motion stop: the operator may. A participant of a study
    /// may not; meanwhile every other page may, so that the experimenter need not take control.
    fn must_release(&self, viewer: ViewerId) -> Result<(), String> {
        {
            let Control { viewers, lease } = &*self.control();
            let is_participant = |who| viewers.get(who).is_some_and(|there| there.is_participant);
            if is_participant(viewer) {
                return Err("this page is a participant's; help: call the experimenter".to_owned());
            }
            let is_screen = viewers.get(viewer).is_none_or(|there| there.role == Role::Screen);
            if !is_screen && lease.operator().is_some_and(is_participant) {
                return Ok(());
            }
        }
        self.must_hold(viewer)
    }

    fn must_hold(&self, viewer: ViewerId) -> Result<(), String> {
        match self.control().lease.operator() {
            Some(operator) if operator == viewer => Ok(()),
            Some(operator) => Err(format!("{operator} is in control; help: request control first")),
            None => Err("there is no operator; help: take control first".to_owned()),
        }
    }

    pub fn end(&self) {
        self.ending.send_replace(true);
    }

    /// Returns a receiver that is true once the server is to end.
    pub fn ending(&self) -> watch::Receiver<bool> {
        self.ending.subscribe()
    }

    /// Notes a pass of the main loop.
    pub fn alive(&self, now: Time) {
        self.alive.store(now.ns(), Ordering::Relaxed);
    }

    /// Returns the time of the main loop's last pass.
    pub fn alive_at(&self) -> Time {
        Time(self.alive.load(Ordering::Relaxed))
    }

    fn show(&self, control: &Control) {
        let Control { viewers, lease } = control;
        let operator = lease.operator();
        let name = operator.and_then(|operator| viewers.get(operator)).map(|there| &there.name);
        let asked = lease.asked();
        let section = ControlSection {
            operator: operator.map(|operator| operator.to_string()),
            name,
            away: lease.is_away(),
            viewers: viewers.len(),
            asked_by: asked.map(|(by, _)| by.to_string()),
            asked_name: asked.and_then(|(by, _)| viewers.get(by)).map(|there| &there.name),
            expires_ms: asked.map(|(_, until)| ms(until)),
            participant: operator
                .and_then(|operator| viewers.get(operator))
                .is_some_and(|there| there.is_participant),
        };
        // Every section can be written.
        let text = serde_json::to_string(&section).unwrap_or_default();
        self.board.section("control", &text);
        self.metrics.viewers.set(viewers.len() as i64);
    }

    fn control(&self) -> MutexGuard<'_, Control> {
        // A lease is changed in one step, so that a panic leaves a consistent state.
        self.control.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
