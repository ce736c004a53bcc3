//! Notifications to the supervisor: `sd_notify` datagrams, sent without blocking.
//!
//! A receiver that has stopped reading has a full queue. Its service keeps working: a beat
//! that finds no room is dropped, and the next one follows. What is said only once (that the
//! service is ready, or ending) is said again with the next datagram that finds room.

use sd_notify::NotifyState;
use std::fmt::Write;
use std::io;
use std::os::unix::net::UnixDatagram;
use std::path::PathBuf;

/// The sender.
#[derive(Debug)]
pub(crate) struct Notifier {
    to: Option<(UnixDatagram, PathBuf)>,
    /// States that are sent once and not delivered yet.
    owed: String,
}

impl Notifier {
    /// To `$NOTIFY_SOCKET`; disabled where that is not set.
    ///
    /// # Errors
    /// The operating system gives no socket.
    pub(crate) fn from_environment() -> io::Result<Self> {
        match std::env::var_os("NOTIFY_SOCKET") {
            Some(path) => Self::to(PathBuf::from(path)),
            None => Ok(Self { to: None, owed: String::new() }),
        }
    }

    fn to(path: PathBuf) -> io::Result<Self> {
        let socket = UnixDatagram::unbound()?;
        socket.set_nonblocking(true)?;
        Ok(Self { to: Some((socket, path)), owed: String::new() })
    }

    /// Sends states that are reported once; they are kept until delivered.
    pub(crate) fn say(&mut self, states: &[NotifyState<'_>]) {
        self.owed += &lines(states);
        self.send("");
    }

    /// Sends states that are repeated soon; they are dropped if the socket's buffer is full.
    pub(crate) fn beat(&mut self, states: &[NotifyState<'_>]) {
        self.send(&lines(states));
    }

    fn send(&mut self, more: &str) {
        let Some((socket, path)) = &self.to else { return self.owed.clear() };
        let text = format!("{}{more}", self.owed);
        match socket.send_to(text.as_bytes(), path) {
            Ok(_) => self.owed.clear(),
            Err(error) => tracing::debug!(%error, "notification not delivered"),
        }
    }
}

fn lines(states: &[NotifyState<'_>]) -> String {
    states.iter().fold(String::new(), |mut text, state| {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{state}");
        text
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::time::Duration;

    fn receive(socket: &UnixDatagram) -> Option<String> {
        let mut bytes = [0; 4096];
        let length = socket.recv(&mut bytes).ok()?;
        Some(String::from_utf8(bytes[..length].to_vec()).unwrap())
    }

    /// Datagrams beyond any queue's room.
    const MANY: usize = 5_000;

    #[test]
    fn full_notification_queue_does_not_block() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let receiver = UnixDatagram::bind(&path).unwrap();
        receiver.set_nonblocking(true).unwrap();
        let mut notifier = Notifier::to(path).unwrap();
        let (done, ended) = mpsc::channel();
        std::thread::spawn(move || {
            (0..MANY).for_each(|_| notifier.beat(&[NotifyState::Watchdog]));
            notifier.say(&[NotifyState::Ready]);
            (0..MANY).for_each(|_| notifier.beat(&[NotifyState::Watchdog]));
            done.send(notifier).unwrap();
        });
        let mut notifier = ended.recv_timeout(Duration::from_secs(60)).expect("it never waits");
        let heard: Vec<String> = std::iter::from_fn(|| receive(&receiver)).collect();
        assert!(!heard.is_empty() && heard.len() < MANY, "{} were let in", heard.len());
        assert!(heard.iter().all(|text| text == "WATCHDOG=1\n"), "{:?}", heard.last());
        notifier.beat(&[NotifyState::Watchdog]);
        assert_eq!(receive(&receiver).as_deref(), Some("READY=1\nWATCHDOG=1\n"));
        notifier.beat(&[NotifyState::Watchdog]);
        assert_eq!(receive(&receiver).as_deref(), Some("WATCHDOG=1\n"));
    }

    #[test]
    fn missing_notification_receiver_is_not_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let mut notifier = Notifier::to(path.clone()).unwrap();
        notifier.say(&[NotifyState::Ready]);
        let receiver = UnixDatagram::bind(&path).unwrap();
        notifier.say(&[NotifyState::Stopping]);
        assert_eq!(receive(&receiver).as_deref(), Some("READY=1\nSTOPPING=1\n"));
        drop(receiver);
        notifier.beat(&[NotifyState::Watchdog]);
    }
}
