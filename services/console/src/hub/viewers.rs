//! The pages that are open.

use std::collections::BTreeMap;

use tokio::sync::mpsc;

use super::ViewerId;

/// A frame for one viewer alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OutboundFrame {
    Text(String),
    /// The same page is open elsewhere; this one ends.
    Replaced,
}

/// Frames that wait for a viewer; one with more does not read and is disconnected.
const QUEUE_MAX: usize = 64;

/// The role that a page asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The operator, if there is none.
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
    pub(super) queue: mpsc::Sender<OutboundFrame>,
}

impl Viewers {
    pub(super) fn add(
        &mut self,
        name: String,
        session: String,
        role: Role,
    ) -> (ViewerId, mpsc::Receiver<OutboundFrame>) {
        self.replace(&session);
        self.last += 1;
        let (queue, frames) = mpsc::channel(QUEUE_MAX);
        self.open.insert(ViewerId(self.last), Viewer { name, session, role, queue });
        (ViewerId(self.last), frames)
    }

    /// Ends the connection that a session still has: a broken one that was not noticed, or that of a
    /// duplicated page.
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
