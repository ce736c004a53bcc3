//! Notifications of services: datagrams of the `sd_notify` protocol with lines `KEY=VALUE`.
//!
//! Every incarnation has a socket of its own, so the sender is always known.

use std::fs;
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::time::Duration;

use service::printable::one_line;

/// Maximum size of a datagram, bytes; systemd's own limit is of the same size.
const DATAGRAM_BYTES_MAX: usize = 4096;

/// Maximum datagrams per pass, so that a service that floods its socket cannot keep the supervisor
/// from the others.
const DATAGRAMS_MAX: usize = 64;

/// Longest text that is kept, characters.
const TEXT_CHARS_MAX: usize = 160;

/// One notification of a service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Notification {
    /// `READY=1`
    Ready,
    /// `WATCHDOG=1`: heartbeat of its main loop.
    Beat,
    /// `EXTEND_TIMEOUT_USEC=n`: it needs this much more time.
    Extend(Duration),
    /// `STATUS=text`: its activity.
    Status(String),
    /// `X_VERSION=text`
    Version(String),
    /// `X_INPUT_AGE_MS=n`: age of its oldest input that it has not dealt with.
    InputAge(Duration),
    /// `X_SHORTAGE=text`: the resource that it is short of; empty: none any more.
    Shortage(Option<String>),
    /// `X_REJECTED=n`: messages of others that it has rejected so far.
    Rejected(u64),
    /// `X_LOST=n`: messages that it has lost so far because it did not read them in time.
    Lost(u64),
    /// `X_SYNCS=n`: syncs of its journal so far.
    Syncs(u64),
    /// `X_SYNC_US=n`: time that these syncs took.
    SyncTime(Duration),
}

/// The socket of one incarnation; its file goes with it.
#[derive(Debug)]
pub(crate) struct NotifySocket {
    socket: UnixDatagram,
    path: PathBuf,
}

impl NotifySocket {
    /// Creates a socket at `path`; a stale file there is removed.
    pub(crate) fn bind(path: &Path) -> io::Result<Self> {
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let socket = UnixDatagram::bind(path)?;
        socket.set_nonblocking(true)?;
        Ok(Self { socket, path: path.to_owned() })
    }

    /// Returns the notifications since the last call, up to a bound.
    pub(crate) fn drain(&self) -> Vec<Notification> {
        let mut buffer = [0; DATAGRAM_BYTES_MAX];
        let mut said = Vec::new();
        for _ in 0..DATAGRAMS_MAX {
            match self.socket.recv(&mut buffer) {
                Ok(bytes) => said.extend(parse(&buffer[..bytes])),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        said
    }
}

impl AsFd for NotifySocket {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }
}

impl Drop for NotifySocket {
    fn drop(&mut self) {
        // Gone already where the run folder has been removed.
        let _ = fs::remove_file(&self.path);
    }
}

/// Parses the known lines of a datagram; all others are extensions of other programs.
fn parse(datagram: &[u8]) -> Vec<Notification> {
    String::from_utf8_lossy(datagram).lines().filter_map(line).collect()
}

fn line(line: &str) -> Option<Notification> {
    let (key, value) = line.split_once('=')?;
    let number = || value.trim().parse::<u64>().ok();
    Some(match key {
        "READY" if value == "1" => Notification::Ready,
        "WATCHDOG" if value == "1" => Notification::Beat,
        "EXTEND_TIMEOUT_USEC" => Notification::Extend(Duration::from_micros(number()?)),
        "X_INPUT_AGE_MS" => Notification::InputAge(Duration::from_millis(number()?)),
        "STATUS" => Notification::Status(text(value)),
        "X_VERSION" => Notification::Version(text(value)),
        "X_SHORTAGE" => Notification::Shortage(Some(text(value)).filter(|text| !text.is_empty())),
        "X_REJECTED" => Notification::Rejected(number()?),
        "X_LOST" => Notification::Lost(number()?),
        "X_SYNCS" => Notification::Syncs(number()?),
        "X_SYNC_US" => Notification::SyncTime(Duration::from_micros(number()?)),
        _ => return None,
    })
}

/// Text that is safe to print on an operator's terminal.
fn text(value: &str) -> String {
    one_line(value).chars().take(TEXT_CHARS_MAX).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notification_lines_are_parsed_separately() {
        let said =
            parse(b"READY=1\nSTATUS=all \x1b[31mwell\nX_VERSION=0.1.0\nMAINPID=7\nWATCHDOG=1");
        assert_eq!(
            said,
            [
                Notification::Ready,
                Notification::Status("all \\u{1b}[31mwell".into()),
                Notification::Version("0.1.0".into()),
                Notification::Beat,
            ]
        );
        assert_eq!(
            parse(b"X_SHORTAGE=disk\nX_REJECTED=3\nX_LOST=4\nX_SYNCS=5\nX_SYNC_US=6\nX_SHORTAGE="),
            [
                Notification::Shortage(Some("disk".into())),
                Notification::Rejected(3),
                Notification::Lost(4),
                Notification::Syncs(5),
                Notification::SyncTime(Duration::from_micros(6)),
                Notification::Shortage(None),
            ]
        );
        assert_eq!(
            parse(b"X_INPUT_AGE_MS=12\nEXTEND_TIMEOUT_USEC=2500000"),
            [
                Notification::InputAge(Duration::from_millis(12)),
                Notification::Extend(Duration::from_millis(2500)),
            ]
        );
    }

    #[test]
    fn nonsense_is_passed_over() {
        let nonsense: [&[u8]; 6] =
            [b"", b"READY", b"READY=2", b"X_INPUT_AGE_MS=-1", b"\xff\xfe=1", b"="];
        for datagram in nonsense {
            assert_eq!(parse(datagram), [], "{datagram:?}");
        }
        let long = format!("STATUS={}", "x".repeat(4000));
        assert_eq!(parse(long.as_bytes()), [Notification::Status("x".repeat(TEXT_CHARS_MAX))]);
    }

    #[test]
    fn notification_flood_is_read_in_bounded_batches_and_socket_file_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("n");
        let socket = NotifySocket::bind(&path).unwrap();
        let speaker = UnixDatagram::unbound().unwrap();
        speaker.set_nonblocking(true).unwrap();
        speaker.connect(&path).unwrap();
        let sent = (0..200).take_while(|_| speaker.send(b"WATCHDOG=1").is_ok()).count();
        assert_eq!(socket.drain().len(), sent.min(DATAGRAMS_MAX));
        drop(socket);
        assert!(!path.exists());
    }
}
