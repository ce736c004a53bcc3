//! The bus behind a pseudo-terminal.

use std::io;
use std::os::fd::OwnedFd;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use crate::Bus;

/// A pseudo-terminal whose other end a program opens as a serial port.
#[derive(Debug)]
pub struct Terminal {
    /// Outlives the programs that use the port, and keeps its settings.
    end: OwnedFd,
    path: String,
    start: Instant,
}

impl Terminal {
    /// Opens one.
    ///
    /// # Errors
    /// The system has none left.
    pub fn open() -> io::Result<Self> {
        let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&end)?;
        unlockpt(&end)?;
        let path = ptsname(&end, Vec::new())?.into_string().map_err(io::Error::other)?;
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        let port = rustix::fs::open(&path, flags, Mode::empty())?;
        let mut attributes = tcgetattr(&port)?;
        attributes.make_raw();
        tcsetattr(&port, OptionalActions::Now, &attributes)?;
        Ok(Self { end, path, start: Instant::now() })
    }

    /// The path of the port.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Serves the bus for a moment: until something has come, or for about a millisecond.
    ///
    /// # Errors
    /// The pseudo-terminal is gone.
    pub fn serve(&self, bus: &mut Bus) -> io::Result<()> {
        let mut fds = [PollFd::new(&self.end, PollFlags::IN)];
        let wait = Timespec { tv_sec: 0, tv_nsec: 1_000_000 };
        match poll(&mut fds, Some(&wait)) {
            Err(rustix::io::Errno::INTR) => return Ok(()),
            polled => polled?,
        };
        let came = fds[0].revents();
        if came.contains(PollFlags::HUP) && !came.contains(PollFlags::IN) {
            // No program has opened the port: this says so at once, and again and again.
            std::thread::sleep(Duration::from_millis(1));
            bus.advance_to(self.start.elapsed().as_secs_f64());
            drop(bus.give());
            return Ok(());
        }
        // Of the port: this end has no settings of its own.
        bus.baud = tcgetattr(&self.end)?.output_speed();
        bus.advance_to(self.start.elapsed().as_secs_f64());
        if came.contains(PollFlags::IN) {
            let mut bytes = [0; 1024];
            match rustix::io::read(&self.end, &mut bytes) {
                // The program has ended meanwhile.
                Err(Errno::IO) => {}
                count => bus.take(&bytes[..count?]),
            }
        }
        let bytes = bus.give();
        if !bytes.is_empty() {
            rustix::io::write(&self.end, &bytes)?;
        }
        Ok(())
    }
}
