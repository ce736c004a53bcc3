//! The serial line.

use std::fs;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::fs::FileTypeExt;
use std::path::Path;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FlockOperation, Mode, OFlags, flock};
use rustix::io::Errno;
use rustix::termios::{
    ControlModes, OptionalActions, QueueSelector, ioctl_tiocexcl, ioctl_tiocnxcl, tcflush,
    tcgetattr, tcsetattr,
};
use service::{Span, Time, clock};

use crate::holder::{Holder, holder_of};

/// Longest time for which a write may wait for the device.
const SEND_MAX: Span = Span::from_ms(50);
/// Delay after which an FTDI adapter passes on received bytes, milliseconds.
const LATENCY_MS: &str = "1";

/// A half-duplex line with a clock.
pub(crate) trait Line {
    /// The time.
    fn now(&self) -> Time;
    /// Waits until a time.
    fn wait_until(&mut self, time: Time);
    /// Drops what has arrived.
    fn discard(&mut self) -> io::Result<()>;
    /// Sends a packet.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// Appends what arrives to `into`, as soon as something does, until a time. Returns whether something did.
    fn receive(&mut self, into: &mut Vec<u8>, until: Time) -> io::Result<bool>;
}

/// A serial port that this process alone uses.
#[derive(Debug)]
pub(crate) struct SerialLine(OwnedFd);

/// A port that cannot be used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PortProblem {
    #[error("no such device; help: plug the arm's adapter in and look into /dev/serial/by-id")]
    Absent,
    #[error("no permission; help: `sudo usermod -aG dialout $USER`, then log in again")]
    Forbidden,
    #[error(
        "another program uses it; help: end that program: a lerobot script, a terminal, or another group"
    )]
    Busy,
    #[error("another program uses it: {0}; help: end that program")]
    Held(Holder),
    #[error("not a serial port; help: look into /dev/serial/by-id")]
    NoTerminal,
    #[error("{0}")]
    Other(#[from] io::Error),
}

impl From<Errno> for PortProblem {
    fn from(error: Errno) -> Self {
        match error {
            Errno::NOENT | Errno::NXIO | Errno::NODEV => Self::Absent,
            Errno::ACCESS | Errno::PERM => Self::Forbidden,
            Errno::BUSY | Errno::WOULDBLOCK => Self::Busy,
            Errno::NOTTY => Self::NoTerminal,
            other => Self::Other(other.into()),
        }
    }
}

/// Returns why the port cannot be opened; `None` if it can. It is not touched.
pub(crate) fn problem_of(port: &Path) -> Option<PortProblem> {
    use rustix::fs::{Access, access};
    if let Err(error) = access(port, Access::READ_OK | Access::WRITE_OK) {
        return Some(error.into());
    }
    let is_device = fs::metadata(port).is_ok_and(|it| it.file_type().is_char_device());
    (!is_device).then_some(PortProblem::NoTerminal)
}

impl SerialLine {
    /// Opens the port for this process alone: no other can open it (`TIOCEXCL`), unless it has root's rights, and
    /// none that locks it as this one does (`flock`). Those that have opened it before are looked for ([`holder_of`]).
    pub(crate) fn open(port: &Path, baud: u32) -> Result<Self, PortProblem> {
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let fd = rustix::fs::open(port, flags, Mode::empty())?;
        flock(&fd, FlockOperation::NonBlockingLockExclusive)?;
        ioctl_tiocexcl(&fd)?;
        // After it, so that no other opens the port between the look and the lock.
        if let Some(holder) = holder_of(&fd)? {
            ioctl_tiocnxcl(&fd)?;
            return Err(PortProblem::Held(holder));
        }
        let mut attributes = tcgetattr(&fd)?;
        attributes.make_raw();
        attributes.control_modes |= ControlModes::CREAD | ControlModes::CLOCAL;
        attributes.control_modes -=
            ControlModes::CRTSCTS | ControlModes::CSTOPB | ControlModes::PARENB;
        attributes.set_speed(baud)?;
        tcsetattr(&fd, OptionalActions::Flush, &attributes)?;
        shorten_latency(port);
        Ok(Self(fd))
    }

    /// Waits until the port is ready; false if the time is over.
    fn ready(&self, flags: PollFlags, until: Time) -> io::Result<bool> {
        loop {
            let left = until.since(clock::now());
            let timeout =
                Timespec { tv_sec: 0, tv_nsec: (left.s() * 1e9).clamp(0.0, 999_999_999.0) as i64 };
            let mut fds = [PollFd::new(&self.0, flags)];
            match poll(&mut fds, Some(&timeout)) {
                Ok(0) | Err(Errno::INTR) if clock::now() < until => {}
                Ok(0) | Err(Errno::INTR) => return Ok(false),
                Ok(_) if fds[0].revents().intersects(flags) => return Ok(true),
                Ok(_) => {
                    return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the device is gone"));
                }
                Err(error) => return Err(error.into()),
            }
        }
    }
}

impl Line for SerialLine {
    fn now(&self) -> Time {
        clock::now()
    }

    fn wait_until(&mut self, time: Time) {
        let left = time.since(clock::now());
        std::thread::sleep(std::time::Duration::from_nanos((left.s() * 1e9) as u64));
    }

    fn discard(&mut self) -> io::Result<()> {
        Ok(tcflush(&self.0, QueueSelector::IFlush)?)
    }

    fn send(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        let until = clock::now() + SEND_MAX;
        while !bytes.is_empty() {
            match rustix::io::write(&self.0, bytes) {
                Ok(count) => bytes = &bytes[count..],
                Err(Errno::AGAIN | Errno::INTR) if self.ready(PollFlags::OUT, until)? => {}
                Err(Errno::AGAIN | Errno::INTR) => return Err(io::ErrorKind::TimedOut.into()),
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    fn receive(&mut self, into: &mut Vec<u8>, until: Time) -> io::Result<bool> {
        if !self.ready(PollFlags::IN, until)? {
            return Ok(false);
        }
        let mut bytes = [0; 1024];
        match rustix::io::read(&self.0, &mut bytes) {
            Ok(0) => Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the device is gone")),
            Ok(count) => {
                into.extend_from_slice(&bytes[..count]);
                Ok(true)
            }
            Err(Errno::AGAIN | Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }
}

/// FTDI adapters pass on received bytes after 16 ms by default: too late for 100 readings a second.
fn shorten_latency(port: &Path) {
    let device = fs::canonicalize(port).unwrap_or_default();
    let Some(name) = device.file_name() else { return };
    let timer = Path::new("/sys/bus/usb-serial/devices").join(name).join("latency_timer");
    let Ok(now) = fs::read_to_string(&timer) else { return };
    if now.trim() == LATENCY_MS {
        return;
    }
    let set = fs::OpenOptions::new()
        .write(true)
        .open(&timer)
        .and_then(|mut file| io::Write::write_all(&mut file, LATENCY_MS.as_bytes()));
    if set.is_err() {
        tracing::warn!(
            "the adapter waits {} ms before it hands over answers; help: `echo 1 | sudo tee {}`",
            now.trim(),
            timer.display()
        );
    }
}
