//! Who looks on.

use std::collections::BTreeMap;

use tokio::sync::mpsc;

use super::ViewerId;

/// Answers that wait for a viewer to read them. One that has more does not read.
const MAILBOX: usize = 64;

/// What a page wishes to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// In control, if nobody is.
    Operator,
    /// Looks on, and may ask for control.
    Viewer,
    /// A display that nobody acts from.
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
    pub(super) mailbox: mpsc::Sender<String>,
}

impl Viewers {
    pub(super) fn add(
        &mut self,
        name: String,
        session: String,
        role: Role,
    ) -> (ViewerId, mpsc::Receiver<String>) {
        self.last += 1;
        let (mailbox, letters) = mpsc::channel(MAILBOX);
        self.open.insert(ViewerId(self.last), Viewer { name, session, role, mailbox });
        (ViewerId(self.last), letters)
    }

    /// Forgets a viewer; its socket ends once it has no mailbox.
    pub(super) fn remove(&mut self, viewer: ViewerId) -> bool {
        self.open.remove(&viewer).is_some()
    }

    pub(super) fn get(&self, viewer: ViewerId) -> Option<&Viewer> {
        self.open.get(&viewer)
    }

    pub(super) fn session(&self, viewer: ViewerId) -> Option<String> {
        self.get(viewer).map(|viewer| viewer.session.clone())
    }

    pub(super) fn len(&self) -> usize {
        self.open.len()
    }
}
