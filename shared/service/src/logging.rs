//! Structured logs on standard error, which the supervisor has pointed at the service's log file.
//!
//! Logging never ends or delays a process: a line that cannot be written at once is dropped, and
//! the first one that can be written again is preceded by the number of lost lines.

use crate::group::ENV_LOG;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FileType, Mode, OFlags, fstat, open};
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::os::fd::{AsFd, OwnedFd};
use std::sync::{Arc, Mutex, PoisonError};
use tracing_subscriber::EnvFilter;

/// Bytes that a descriptor takes without blocking once it polls as writable: a pipe's page.
const CHUNK_BYTES: usize = 4096;

/// Begins logging. `WHICHONE_LOG` holds the filter (`info`, `policy=debug`, …) and
/// `WHICHONE_LOG_FORMAT=json` asks for one JSON object a line.
pub fn init() {
    let filter = EnvFilter::try_from_env(ENV_LOG).unwrap_or_else(|_| EnvFilter::new("info"));
    let colour = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let json = std::env::var("WHICHONE_LOG_FORMAT").is_ok_and(|format| format == "json");
    let Ok(stderr) = standard_error() else { return };
    let builder = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(Arc::new(LossyLog::new(stderr, json)))
        // The report of a failed write would itself be written, and its failure is a panic.
        .log_internal_errors(false)
        .with_ansi(colour)
        .with_target(true);
    // A second call (tests in one process) leaves the first subscriber in place.
    let _ = if json { builder.json().try_init() } else { builder.try_init() };
}

/// Standard error. A pipe and a terminal are opened again, so that writes to them do not block and
/// the others that share them are not affected; a file keeps the position that it shares.
fn standard_error() -> io::Result<File> {
    let shared = io::stderr().as_fd().try_clone_to_owned()?;
    let may_block = fstat(&shared).is_ok_and(|stat| {
        let kind = FileType::from_raw_mode(stat.st_mode);
        matches!(kind, FileType::Fifo | FileType::CharacterDevice)
    });
    if !may_block {
        return Ok(shared.into());
    }
    let flags = OFlags::WRONLY | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    let own: Result<OwnedFd, _> = open("/proc/self/fd/2", flags, Mode::empty());
    Ok(own.unwrap_or(shared).into())
}

/// A log that drops what cannot be written, and counts it.
struct LossyLog {
    json: bool,
    state: Mutex<State>,
}

struct State {
    file: File,
    lost: Option<Lost>,
}

/// Lines since the last one that was written whole.
struct Lost {
    lines: u64,
    error: io::Error,
    /// True if a part of a line stands at the log's end.
    torn: bool,
}

impl LossyLog {
    fn new(file: File, json: bool) -> Self {
        Self { json, state: Mutex::new(State { file, lost: None }) }
    }

    fn notice(&self, Lost { lines, error, torn }: &Lost) -> String {
        let text = format!("{lines} log lines were lost: {error}");
        let start = if *torn { "\n" } else { "" };
        if self.json {
            let line = serde_json::json!({ "level": "WARN", "fields": { "message": text } });
            format!("{start}{line}\n")
        } else {
            format!("{start} WARN {text}\n")
        }
    }
}

impl Write for &LossyLog {
    /// Takes one line, written or not.
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let notice = state.lost.as_ref().map(|lost| self.notice(lost)).unwrap_or_default();
        let bytes = [notice.as_bytes(), line].concat();
        let (written, error) = write_now(&mut state.file, &bytes);
        let Some(error) = error else {
            state.lost = None;
            return Ok(line.len());
        };
        // A notice that was written whole is not repeated.
        let before = state.lost.take().filter(|_| notice.is_empty() || written < notice.len());
        state.lost = Some(Lost {
            lines: before.as_ref().map_or(0, |lost| lost.lines).saturating_add(1),
            error,
            torn: written > 0 || before.is_some_and(|lost| lost.torn),
        });
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes what can be written without waiting. Returns its length, and the error that ended it.
fn write_now(file: &mut File, bytes: &[u8]) -> (usize, Option<io::Error>) {
    let mut written = 0;
    while written < bytes.len() {
        let end = bytes.len().min(written + CHUNK_BYTES);
        match when_writable(file).and_then(|()| file.write(&bytes[written..end])) {
            Ok(0) => return (written, Some(ErrorKind::WriteZero.into())),
            Ok(count) => written += count,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return (written, Some(error)),
        }
    }
    (written, None)
}

fn when_writable(file: &File) -> io::Result<()> {
    let mut polled = [PollFd::new(file, PollFlags::OUT)];
    poll(&mut polled, Some(&Timespec::default()))?;
    // Errors and hang-ups are reported by the write itself.
    if polled[0].revents().is_empty() { Err(ErrorKind::WouldBlock.into()) } else { Ok(()) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use rustix::pipe::pipe;
    use std::io::Read;

    fn log(log: &LossyLog, line: &str) {
        (&mut &*log).write_all(line.as_bytes()).unwrap();
    }

    #[test]
    fn lines_that_find_no_room_are_dropped_counted_and_reported() {
        let (reader, writer) = pipe().unwrap();
        let lossy = LossyLog::new(writer.into(), false);
        let line = format!("{}\n", "x".repeat(999));
        // Far more than a pipe holds: each call returns although nobody reads.
        (0..1_000).for_each(|_| log(&lossy, &line));
        let mut reader = File::from(reader);
        let mut full = vec![0; 1 << 20];
        let held = reader.read(&mut full).unwrap();
        assert!(full[..held].starts_with(line.as_bytes()));
        log(&lossy, "again\n");
        log(&lossy, "and again\n");
        drop(lossy);
        let mut rest = String::new();
        reader.read_to_string(&mut rest).unwrap();
        let kept = held / line.len();
        let notice = format!(
            "WARN {} log lines were lost: operation would block\nagain\nand again\n",
            1_000 - kept
        );
        assert!(rest.trim_start().ends_with(&notice), "{held}: {rest}");
    }

    #[test]
    fn full_device_and_closed_pipe_are_survived() {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let lossy = LossyLog::new(full, true);
        (0..3).for_each(|_| log(&lossy, "{}\n"));
        let state = lossy.state.lock().unwrap();
        let notice = lossy.notice(state.lost.as_ref().unwrap());
        assert!(notice.contains("\"3 log lines were lost: No space left"), "{notice}");
        let (reader, writer) = pipe().unwrap();
        drop(reader);
        let lossy = LossyLog::new(writer.into(), false);
        log(&lossy, "nobody reads\n");
        assert_eq!(lossy.state.lock().unwrap().lost.as_ref().unwrap().lines, 1);
    }
}
