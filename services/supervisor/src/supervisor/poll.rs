//! Waiting for events.

use std::os::fd::{AsFd, BorrowedFd};

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::Supervisor;
use crate::Time;
use crate::server::Client;

/// Result of one poll.
#[derive(Debug, Default)]
pub(super) struct Ready {
    /// True if there may be a signal.
    pub(super) signal: bool,
    /// Services that have sent notifications.
    pub(super) voices: Vec<usize>,
    /// Services whose process has ended.
    pub(super) ended: Vec<usize>,
    /// True if a client connects.
    pub(super) listener: bool,
    /// Connections with new data.
    pub(super) clients: Vec<(Client, PollFlags)>,
}

#[derive(Clone, Copy)]
enum Source {
    Signal,
    Voice(usize),
    Process(usize),
    Listener,
    Client(Client),
}

impl Supervisor {
    /// Sleeps until an event arrives or the next deadline is due.
    pub(super) fn wait(&self) -> Ready {
        let mut sources = Vec::new();
        let mut fds: Vec<PollFd<'_>> = Vec::new();
        for (source, fd, flags) in self.sources() {
            sources.push(source);
            fds.push(PollFd::from_borrowed_fd(fd, flags));
        }
        let timeout = self.until_next_deadline();
        let timeout = Timespec::try_from(timeout).expect("a second at most");
        if poll(&mut fds, Some(&timeout)).is_err() {
            // Interrupted by a signal.
            return Ready { signal: true, ..Ready::default() };
        }
        let mut ready = Ready::default();
        for (source, fd) in sources.into_iter().zip(&fds) {
            let flags = fd.revents();
            match source {
                _ if flags.is_empty() => {}
                Source::Signal => ready.signal = true,
                Source::Voice(service) => ready.voices.push(service),
                Source::Process(service) => ready.ended.push(service),
                Source::Listener => ready.listener = true,
                Source::Client(client) => ready.clients.push((client, flags)),
            }
        }
        ready
    }

    fn sources(&self) -> impl Iterator<Item = (Source, BorrowedFd<'_>, PollFlags)> {
        let signals = self.signals.fds().map(|fd| (Source::Signal, fd, PollFlags::IN));
        let running = self.services.iter().enumerate().filter_map(|(service, entry)| {
            let running = entry.running.as_ref()?;
            Some([
                (Source::Voice(service), running.notify.as_fd(), PollFlags::IN),
                (Source::Process(service), running.child.as_fd(), PollFlags::IN),
            ])
        });
        let listener = (Source::Listener, self.server.listener(), PollFlags::IN);
        let clients = self.server.awaited();
        let clients = clients.map(|(client, fd, flags)| (Source::Client(client), fd, flags));
        signals.into_iter().chain(running.flatten()).chain([listener]).chain(clients)
    }

    /// At most a tick.
    fn until_next_deadline(&self) -> Time {
        let waits = self.waits.iter().filter_map(|wait| wait.until);
        let deadlines = self.group.deadline().into_iter().chain(waits);
        let next = deadlines.fold(self.next_tick, Time::min);
        next.saturating_sub(self.now())
    }
}
