//! Notifications of a service to its supervisor, and of the supervisor to an init system:
//! `sd_notify` datagrams, sent without blocking.
//!
//! A receiver that has stopped reading has a full queue. Its service keeps working: a beat that
//! finds no room is dropped, and the next one follows. Single messages (that the service is ready,
//! or ending) are repeated with the next datagram that finds room.

use std::ffi::OsStr;
use std::io;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::net::{SocketAddr, UnixDatagram};

use rustix::io::Errno;

/// Longest state that is sent once, characters; the rest is cut off. The supervisor keeps less.
const STATE_CHARS_MAX: usize = 512;

/// The sender.
#[derive(Debug, Default)]
pub struct Notifier {
    to: Option<(UnixDatagram, SocketAddr)>,
    /// States that are sent once and not delivered yet.
    owed: String,
}

impl Notifier {
    /// Connects to `$NOTIFY_SOCKET`, a path or an abstract name after `@`; disabled without it.
    ///
    /// # Errors
    /// The operating system gives no socket, or the name cannot be one's.
    pub fn from_environment() -> io::Result<Self> {
        let name = std::env::var_os("NOTIFY_SOCKET").filter(|name| !name.is_empty());
        name.map_or_else(|| Ok(Self::default()), |name| Self::to(&name))
    }

    fn to(name: &OsStr) -> io::Result<Self> {
        let address = match name.as_bytes() {
            [b'@', name @ ..] => SocketAddr::from_abstract_name(name)?,
            _ => SocketAddr::from_pathname(name)?,
        };
        let socket = UnixDatagram::unbound()?;
        socket.set_nonblocking(true)?;
        Ok(Self { to: Some((socket, address)), owed: String::new() })
    }

    /// Sends a state that is reported once, e.g. `READY=1`; it is kept until delivered.
    pub fn say(&mut self, state: &str) {
        self.owed.extend(state.chars().take(STATE_CHARS_MAX));
        self.owed.push('\n');
        self.send("");
    }

    /// Sends a state that is repeated soon; it is dropped if the socket's buffer is full.
    pub fn beat(&mut self, state: &str) {
        self.send(state);
    }

    fn send(&mut self, more: &str) {
        let Some((socket, address)) = &self.to else { return self.owed.clear() };
        let text = format!("{}{more}", self.owed);
        match socket.send_to_addr(text.trim_end().as_bytes(), address) {
            Ok(_) => self.owed.clear(),
            // It would never fit, nor would any with it.
            Err(error) if Errno::from_io_error(&error) == Some(Errno::MSGSIZE) => self.owed.clear(),
            Err(error) => tracing::debug!(%error, "notification not delivered"),
        }
    }
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
        let mut notifier = Notifier::to(path.as_os_str()).unwrap();
        let (done, ended) = mpsc::channel();
        std::thread::spawn(move || {
            (0..MANY).for_each(|_| notifier.beat("WATCHDOG=1"));
            notifier.say("READY=1");
            (0..MANY).for_each(|_| notifier.beat("WATCHDOG=1"));
            done.send(notifier).unwrap();
        });
        let mut notifier = ended.recv_timeout(Duration::from_secs(60)).expect("it never waits");
        let heard: Vec<String> = std::iter::from_fn(|| receive(&receiver)).collect();
        assert!(!heard.is_empty() && heard.len() < MANY, "{} were let in", heard.len());
        assert!(heard.iter().all(|text| text == "WATCHDOG=1"), "{:?}", heard.last());
        notifier.beat("WATCHDOG=1");
        assert_eq!(receive(&receiver).as_deref(), Some("READY=1\nWATCHDOG=1"));
        notifier.beat("WATCHDOG=1");
        assert_eq!(receive(&receiver).as_deref(), Some("WATCHDOG=1"));
        // A status of a mebibyte is cut, and what no datagram holds is dropped.
        notifier.say(&format!("STATUS={}", "ü".repeat(1 << 19)));
        assert_eq!(receive(&receiver).unwrap().chars().count(), STATE_CHARS_MAX);
        notifier.owed = "x".repeat(1 << 23);
        (0..2).for_each(|_| notifier.beat("WATCHDOG=1"));
        assert_eq!(receive(&receiver).as_deref(), Some("WATCHDOG=1"));
    }

    #[test]
    fn missing_notification_receiver_is_not_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let mut notifier = Notifier::to(path.as_os_str()).unwrap();
        notifier.say("READY=1");
        let receiver = UnixDatagram::bind(&path).unwrap();
        notifier.say("STOPPING=1");
        assert_eq!(receive(&receiver).as_deref(), Some("READY=1\nSTOPPING=1"));
        drop(receiver);
        notifier.beat("WATCHDOG=1");
    }
}
