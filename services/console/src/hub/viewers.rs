//! The pages that are open.

use std::collections::BTreeMap;

use service::Time;
use tokio::sync::mpsc;

use super::ViewerId;
use super::outbound::Answer;

/// A frame for one viewer alone.
#[derive(Clone, Debug, PartialEq)]
pub enum OutboundFrame {
    Text(String),
    /// The outcome of the command of this number.
    Answer(u64, Result<Option<Answer>, String>),
    /// The same page is open elsewhere; this one ends.
    Replaced,
    /// Too many pages are open, and an operator comes; this one ends.
    GaveWay,
}

/// Frames that wait for a viewer; one with more does not read and is disconnected.
const QUEUE_MAX: usize = 64;

/// The role that a page requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Operator, if no other page is.
    Operator,
    /// A viewer, who may ask for control.
    Viewer,
    /// A display without controls.
    Screen,
}

/// The pages that are open.
#[derive(Debug, Default)]
pub(super) struct Viewers {
    last: u64,
    open: BTreeMap<ViewerId, Viewer>,
}

#[derive(Debug)]
pub(super) struct Viewer {
    pub(super) name: String,
    pub(super) session: String,
    pub(super) role: Role,
    /// Whether it is the page of a study's participant.
    pub(super) is_participant: bool,
    pub(super) queue: mpsc::Sender<OutboundFrame>,
    /// When its user did something last, or when it was opened.
    pub(super) active: Time,
}

impl Viewers {
    pub(super) fn add(
        &mut self,
        name: String,
        session: String,
        role: Role,
        now: Time,
    ) -> (ViewerId, mpsc::Receiver<OutboundFrame>) {
        self.replace(&session);
        self.last += 1;
        let (queue, frames) = mpsc::channel(QUEUE_MAX);
        let is_participant = false;
        let viewer = Viewer { name, session, role, is_participant, queue, active: now };
        self.open.insert(ViewerId(self.last), viewer);
        (ViewerId(self.last), frames)
    }

    /// Ends the connection that a session still has: a broken one that was not noticed, or that of
    /// a duplicated page.
    fn replace(&mut self, session: &str) {
        self.open.retain(|_, open| {
            let replaced = open.session == session;
            if replaced {
                // A full queue is closed with its owner all the same.
                let _ = open.queue.try_send(OutboundFrame::Replaced);
            }
            !replaced
        });
    }

    /// Ends the page that was idle for the longest time, except `operator`'s.
    pub(super) fn give_way(&mut self, operator: Option<ViewerId>) {
        let others = self.open.iter().filter(|(viewer, _)| Some(**viewer) != operator);
        let idle = others.min_by_key(|(_, open)| open.active).map(|(viewer, _)| *viewer);
        if let Some(idle) = idle.and_then(|idle| self.open.remove(&idle)) {
            // A full queue is closed with its owner all the same.
            let _ = idle.queue.try_send(OutboundFrame::GaveWay);
        }
    }

    /// Notes that a viewer's user does something.
    pub(super) fn note(&mut self, viewer: ViewerId, now: Time) {
        if let Some(open) = self.open.get_mut(&viewer) {
            open.active = now;
        }
    }

    /// Notes that a viewer's page is that of a study's participant; returns whether that is news.
    pub(super) fn mark_participant(&mut self, viewer: ViewerId) -> bool {
        let open = self.open.get_mut(&viewer);
        open.is_some_and(|open| !std::mem::replace(&mut open.is_participant, true))
    }

    /// Forgets a viewer; its socket ends once its queue is dropped.
    pub(super) fn remove(&mut self, viewer: ViewerId) -> bool {
        self.open.remove(&viewer).is_some()
    }

    pub(super) fn get(&self, viewer: ViewerId) -> Option<&Viewer> {
        self.open.get(&viewer)
    }

    pub(super) fn session(&self, viewer: ViewerId) -> Option<String> {
        self.get(viewer).map(|viewer| viewer.session.clone())
    }

    pub(super) fn has_session(&self, session: &str) -> bool {
        self.open.values().any(|viewer| viewer.session == session)
    }

    pub(super) fn len(&self) -> usize {
        self.open.len()
    }
}
