//! A process of one service: signals, kill and reaping.
//!
//! Signals go through a descriptor of the process (pidfd) that is opened before it can have been
//! reaped, so they never reach another process that was given the same number later.

use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};

use rustix::io::Errno;
use rustix::process::{
    Pid, PidfdFlags, Signal, WaitId, WaitIdOptions, kill_process_group, pidfd_open,
    pidfd_send_signal, waitid,
};

use crate::machine::Effect;
use service::exit::ProcessExit;

/// A child that leads its own process group and has not been reaped.
#[derive(Debug)]
pub(crate) struct Child {
    pid: Pid,
    pidfd: OwnedFd,
}

impl Child {
    /// The child with number `pid`, just started by this process.
    pub(crate) fn new(pid: Pid) -> io::Result<Self> {
        Ok(Self { pid, pidfd: pidfd_open(pid, PidfdFlags::empty())? })
    }

    pub(crate) fn pid(&self) -> Pid {
        self.pid
    }

    /// Applies an effect of the machine. A process that has already ended is not an error.
    pub(crate) fn signal(&self, effect: Effect) {
        let sent = match effect {
            Effect::Terminate => self.send(Signal::TERM).and_then(|()| self.wake()),
            Effect::Abort => self.send(Signal::ABORT).and_then(|()| self.wake()),
            Effect::Kill => self.kill_group(),
            Effect::Spawn => Ok(()),
        };
        if let Err(error) = sent
            && error != Errno::SRCH
        {
            tracing::error!(pid = %self.pid, ?effect, %error, "signal not delivered");
        }
    }

    /// Returns true if it has ended and can be reaped.
    pub(crate) fn has_ended(&self) -> bool {
        let look = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        matches!(waitid(WaitId::PidFd(self.pidfd.as_fd()), look), Ok(Some(_)))
    }

    /// Reaps the ended child, after killing what is left of its process group.
    ///
    /// In this order: until it is reaped, its pid and its group's are not reused.
    pub(crate) fn reap(self) -> ProcessExit {
        if let Err(error) = self.kill_group()
            && error != Errno::SRCH
        {
            tracing::error!(pid = %self.pid, %error, "process group not killed");
        }
        match waitid(WaitId::PidFd(self.pidfd.as_fd()), WaitIdOptions::EXITED) {
            Ok(Some(status)) => match (status.exit_status(), status.terminating_signal()) {
                (Some(code), _) => ProcessExit::Code(code),
                (None, Some(signal)) => ProcessExit::Signal(signal),
                (None, None) => unreachable!("only ended children were asked for"),
            },
            Ok(None) => unreachable!("the wait was a blocking one"),
            // Reaped elsewhere: a defect, but the process has ended all the same.
            Err(error) => {
                tracing::error!(pid = %self.pid, %error, "exit status lost");
                ProcessExit::Signal(Signal::KILL.as_raw())
            }
        }
    }

    fn send(&self, signal: Signal) -> Result<(), Errno> {
        pidfd_send_signal(&self.pidfd, signal)
    }

    /// A stopped process keeps every signal but KILL pending until it is continued.
    fn wake(&self) -> Result<(), Errno> {
        kill_process_group(self.pid, Signal::CONT)
    }

    fn kill_group(&self) -> Result<(), Errno> {
        kill_process_group(self.pid, Signal::KILL)
    }
}

impl AsFd for Child {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.pidfd.as_fd()
    }
}
