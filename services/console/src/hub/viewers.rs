//! Who looks on.

use std::collections::BTreeMap;

use tokio::sync::mpsc;

use super::ViewerId;

/// What is put into a viewer's mailbox.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Letter {
    /// A frame for its page.
    Frame(String),
    /// The same page is open anew somewhere else; this one ends.
    Replaced,
}

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
    pub(super) mailbox: mpsc::Sender<Letter>,
}

impl Viewers {
    pub(super) fn add(
        &mut self,
        name: String,
        session: String,
        role: Role,
    ) -> (ViewerId, mpsc::Receiver<Letter>) {
        self.replace(&session);
        self.last += 1;
        let (mailbox, letters) = mpsc::channel(MAILBOX);
        self.open.insert(ViewerId(self.last), Viewer { name, session, role, mailbox });
        (ViewerId(self.last), letters)
    }

    /// Ends what is still open of a session that comes anew: an old connection that nobody has seen
    /// break, or a page that was doubled.
    fn replace(&mut self, session: &str) {
        self.open.retain(|_, open| {
            let replaced = open.session == session;
            if replaced {
                // A full mailbox is closed with its owner all the same.
                let _ = open.mailbox.try_send(Letter::Replaced);
            }
            !replaced
        });
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

    pub(super) fn has_session(&self, session: &str) -> bool {
        self.open.values().any(|viewer| viewer.session == session)
    }

    pub(super) fn len(&self) -> usize {
        self.open.len()
    }
}
