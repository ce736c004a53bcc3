//! Server of the control socket: connections never block the supervisor.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::time::Duration;

use rustix::event::PollFlags;

use crate::Time;
use service::control::{REQUEST_BYTES_MAX, Refusal, RefusalKind, Reply, Request};

#[cfg(test)]
mod tests;

/// Maximum number of connections; further ones are rejected.
const CONNECTIONS_MAX: usize = 64;

/// Timeout of a client for sending its request and for receiving the reply.
const CLIENT_PATIENCE: Duration = Duration::from_secs(5);

/// Timeout for the last replies when the supervisor shuts down.
const FAREWELL: Duration = Duration::from_millis(500);

/// Identifies a connection for as long as the supervisor runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Client(u64);

/// The listening socket and its connections.
#[derive(Debug)]
pub(crate) struct Server {
    listener: UnixListener,
    connections: BTreeMap<Client, Connection>,
    next: u64,
}

#[derive(Debug)]
struct Connection {
    stream: UnixStream,
    stage: Stage,
    /// When the current stage began.
    since: Time,
}

#[derive(Debug)]
enum Stage {
    /// The request is being read.
    Asking(Vec<u8>),
    /// The reply is pending.
    Waiting,
    /// The reply is being written from this byte on.
    Answering(Vec<u8>, usize),
}

impl Server {
    /// Listens at `path`, in place of a supervisor that was killed, if any.
    pub(crate) fn bind(path: &Path) -> io::Result<Self> {
        Ok(Self { listener: listen(path)?, connections: BTreeMap::new(), next: 0 })
    }

    /// Listens at `path` again; connections stay open.
    pub(crate) fn rebind(&mut self, path: &Path) -> io::Result<()> {
        self.listener = listen(path)?;
        Ok(())
    }

    /// The listening socket.
    pub(crate) fn listener(&self) -> BorrowedFd<'_> {
        self.listener.as_fd()
    }

    /// Connections with the events to poll for; a hang-up is always reported.
    pub(crate) fn awaited(&self) -> impl Iterator<Item = (Client, BorrowedFd<'_>, PollFlags)> {
        self.connections.iter().map(|(&client, connection)| {
            let flags = match connection.stage {
                Stage::Asking(_) => PollFlags::IN,
                Stage::Waiting => PollFlags::empty(),
                Stage::Answering(..) => PollFlags::OUT,
            };
            (client, connection.stream.as_fd(), flags)
        })
    }

    /// Accepts new connections.
    pub(crate) fn accept(&mut self, now: Time) {
        while let Ok((stream, _)) = self.listener.accept() {
            if stream.set_nonblocking(true).is_err() {
                continue;
            }
            let client = Client(self.next);
            self.next += 1;
            let connection = Connection { stream, stage: Stage::Asking(Vec::new()), since: now };
            self.connections.insert(client, connection);
            if self.connections.len() > CONNECTIONS_MAX {
                self.refuse(client, "too many requests at a time; ask again", now);
            }
        }
    }

    /// Continues with a connection that is ready. Returns its request once it is complete.
    pub(crate) fn advance(
        &mut self,
        client: Client,
        ready: PollFlags,
        now: Time,
    ) -> Option<Request> {
        let connection = self.connections.get_mut(&client)?;
        match &mut connection.stage {
            Stage::Asking(line) => match read_line(&mut connection.stream, line) {
                Ok(true) => return self.take_request(client, now),
                Ok(false) => {}
                Err(_) => self.drop_client(client),
            },
            Stage::Waiting => {
                // A client that only closed its sending side still wants its reply.
                if ready.intersects(PollFlags::HUP | PollFlags::ERR) {
                    self.drop_client(client);
                }
            }
            Stage::Answering(..) => self.write(client),
        }
        None
    }

    /// Returns true if the client still waits for its reply.
    pub(crate) fn is_waiting(&self, client: Client) -> bool {
        self.connections.get(&client).is_some_and(|c| matches!(c.stage, Stage::Waiting))
    }

    /// Sends the reply, or as much of it as can be sent now.
    pub(crate) fn reply(&mut self, client: Client, reply: &Reply, now: Time) {
        let Some(connection) = self.connections.get_mut(&client) else { return };
        let mut line =
            serde_json::to_vec(reply).expect("replies hold nothing but text and numbers");
        line.push(b'\n');
        connection.stage = Stage::Answering(line, 0);
        connection.since = now;
        self.write(client);
    }

    /// Drops clients that are too slow.
    pub(crate) fn drop_slow(&mut self, now: Time) {
        self.connections.retain(|_, connection| {
            matches!(connection.stage, Stage::Waiting)
                || now.saturating_sub(connection.since) < CLIENT_PATIENCE
        });
    }

    /// Waits briefly for clients to receive their replies.
    pub(crate) fn finish(mut self) {
        let answering = |c: &Connection| matches!(c.stage, Stage::Answering(..));
        let left: Vec<Client> =
            self.connections.iter().filter(|(_, c)| answering(c)).map(|(&id, _)| id).collect();
        for client in left {
            let Some(connection) = self.connections.get(&client) else { continue };
            let blocking = connection.stream.set_nonblocking(false).is_ok()
                && connection.stream.set_write_timeout(Some(FAREWELL)).is_ok();
            if blocking {
                self.write(client);
            }
        }
    }

    fn take_request(&mut self, client: Client, now: Time) -> Option<Request> {
        let connection = self.connections.get_mut(&client)?;
        let Stage::Asking(line) = std::mem::replace(&mut connection.stage, Stage::Waiting) else {
            return None;
        };
        match serde_json::from_slice(&line) {
            Ok(request) => Some(request),
            Err(error) => {
                self.refuse(client, &format!("not a request: {error}"), now);
                None
            }
        }
    }

    fn refuse(&mut self, client: Client, why: &str, now: Time) {
        self.reply(client, &Reply::Refused(Refusal::new(RefusalKind::Usage, why)), now);
    }

    fn write(&mut self, client: Client) {
        let Some(connection) = self.connections.get_mut(&client) else { return };
        let Stage::Answering(line, sent) = &mut connection.stage else { return };
        while *sent < line.len() {
            match connection.stream.write(&line[*sent..]) {
                Ok(count) => *sent += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(_) => break,
            }
        }
        self.drop_client(client);
    }

    fn drop_client(&mut self, client: Client) {
        self.connections.remove(&client);
    }
}

fn listen(path: &Path) -> io::Result<UnixListener> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let listener = UnixListener::bind(path)?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// Reads what has arrived; `true` once the line is complete (a closed sending side completes it,
/// too).
fn read_line(stream: &mut UnixStream, line: &mut Vec<u8>) -> io::Result<bool> {
    let mut bytes = [0; 4096];
    loop {
        match stream.read(&mut bytes) {
            Ok(0) if line.is_empty() => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(0) => return Ok(true),
            Ok(count) => line.extend_from_slice(&bytes[..count]),
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(false),
            Err(error) => return Err(error),
        }
        if let Some(end) = line.iter().position(|&byte| byte == b'\n') {
            line.truncate(end);
            return Ok(true);
        }
        if line.len() > REQUEST_BYTES_MAX {
            return Err(ErrorKind::FileTooLarge.into());
        }
    }
}
