//! Signals to the supervisor, as descriptors to poll.

use std::io::{self, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;

use signal_hook::consts::{SIGCHLD, SIGHUP, SIGINT, SIGTERM};
use signal_hook::low_level::pipe;

use crate::procfs;

/// One pipe for shutdown requests, one for exits of children.
#[derive(Debug)]
pub(crate) struct Signals {
    end: UnixStream,
    child: UnixStream,
}

impl Signals {
    /// Takes over TERM, INT, CHLD, and HUP, which a closed terminal sends, unless it was ignored: `nohup` asks for that.
    pub(crate) fn new() -> io::Result<Self> {
        let (end, end_writer) = UnixStream::pair()?;
        let (child, child_writer) = UnixStream::pair()?;
        let ignored = procfs::ignored_signals();
        let hang_up = (!ignored.contains(&SIGHUP)).then_some(SIGHUP);
        for signal in [SIGTERM, SIGINT].into_iter().chain(hang_up) {
            pipe::register(signal, end_writer.try_clone()?)?;
        }
        pipe::register(SIGCHLD, child_writer)?;
        for stream in [&end, &child] {
            stream.set_nonblocking(true)?;
        }
        Ok(Self { end, child })
    }

    /// Descriptors to be polled.
    pub(crate) fn fds(&self) -> [BorrowedFd<'_>; 2] {
        [self.end.as_fd(), self.child.as_fd()]
    }

    /// Returns true if this process has been asked to end since the last call.
    pub(crate) fn asked_to_end(&mut self) -> bool {
        take(&mut self.end)
    }

    /// Returns true if some child has ended since the last call.
    pub(crate) fn child_ended(&mut self) -> bool {
        take(&mut self.child)
    }
}

fn take(stream: &mut UnixStream) -> bool {
    let mut bytes = [0; 64];
    let mut any = false;
    while stream.read(&mut bytes).is_ok_and(|count| count > 0) {
        any = true;
    }
    any
}
