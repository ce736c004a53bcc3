//! Structured logs on standard error, which the supervisor has pointed at the service's log file.
//!
//! Logging never ends or delays a process. A thread writes the lines: a write to a file waits while
//! others keep its disk busy, and the main loop of an arm that is to stop must not. A line that
//! finds no room in the thread's queue, or in a pipe that nobody reads, is dropped, and the next
//! one that can be written is preceded by the number of lost lines.

use crate::group::{ENV_LOG, ENV_LOG_FORMAT};
use crossbeam_channel::{Receiver, Sender, bounded};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FileType, Mode, OFlags, fstat, open};
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::os::fd::{AsFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;
use tracing::{Event, Subscriber};
use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::{DefaultFields, Format, Json, Writer};
use tracing_subscriber::fmt::{FmtContext, FormatEvent};
use tracing_subscriber::registry::LookupSpan;

/// Libraries that report every step of a connection, unless the filter says otherwise.
const QUIET: &str = "rustdds=error,ros2_client=error,zenoh=error";
/// Bytes that a descriptor takes without blocking once it polls as writable: a pipe's page.
const CHUNK_BYTES: usize = 4096;
/// Most lines that wait for the thread.
const QUEUE_LEN: usize = 1024;
/// Longest time for which the end of a program waits for its last lines.
const FLUSH_MAX: Duration = Duration::from_secs(1);

/// Whether lines are JSON objects: one log, one format.
static JSON: AtomicBool = AtomicBool::new(false);

/// Begins logging. `WHICHONE_LOG` holds the filter (`info`, `policy=debug`, …) and
/// `WHICHONE_LOG_FORMAT=json` requests one JSON object a line.
///
/// The program must keep the result to its end, so that its last lines are written.
pub fn init() -> LogFlush {
    let wanted = std::env::var(ENV_LOG).unwrap_or_else(|_| "info".to_owned());
    let filter = EnvFilter::try_new(format!("{QUIET},{wanted}"))
        .unwrap_or_else(|_| EnvFilter::new(format!("{QUIET},info")));
    let colour = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let json = std::env::var(ENV_LOG_FORMAT).is_ok_and(|format| format == "json");
    JSON.store(json, Ordering::Relaxed);
    let nowhere = LogFlush(None);
    let Ok(stderr) = standard_error() else { return nowhere };
    let Ok(queue) = Queue::start(LossyLog::new(stderr)) else { return nowhere };
    let flush = LogFlush(Some(queue.jobs.clone()));
    let builder = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(Arc::new(queue))
        // The report of a failed write would itself be written, and its failure is a panic.
        .log_internal_errors(false)
        .with_ansi(colour)
        .event_format(Lines::new());
    // A second call (tests in one process) leaves the first subscriber in place.
    let _ = builder.try_init();
    flush
}

/// Logs the name that the program was started under, and its build: the first line of a long-running process.
pub fn identify() {
    let program = std::env::args_os().next().map(PathBuf::from);
    let name = program.as_deref().and_then(Path::file_name).unwrap_or_default();
    tracing::info!("{} {}", name.to_string_lossy(), build_info::current());
}

/// Changes the format of later lines as configured: one JSON object a line, or text.
/// `WHICHONE_LOG_FORMAT`, if set, has precedence.
pub fn set_json(json: bool) {
    if std::env::var_os(ENV_LOG_FORMAT).is_none() {
        JSON.store(json, Ordering::Relaxed);
    }
}

/// Both formats of a line; [`JSON`] chooses one. Without spans, neither writes any.
struct Lines {
    text: Format,
    json: Format<Json>,
}

impl Lines {
    fn new() -> Self {
        let json = Format::default().json().with_current_span(false).with_span_list(false);
        Self { text: Format::default(), json }
    }
}

impl<S> FormatEvent<S, DefaultFields> for Lines
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, DefaultFields>,
        writer: Writer<'_>,
        event: &Event<'_>,
    ) -> std::fmt::Result {
        match JSON.load(Ordering::Relaxed) {
            true => self.json.format_event(context, writer, event),
            false => self.text.format_event(context, writer, event),
        }
    }
}

/// Waits when dropped, for a second at most, until the lines so far are written.
#[derive(Debug)]
#[must_use = "the last lines of a program are written when this is dropped"]
pub struct LogFlush(Option<Sender<Job>>);

impl Drop for LogFlush {
    fn drop(&mut self) {
        let Some(jobs) = &self.0 else { return };
        let (done, is_done) = bounded(1);
        if jobs.send_timeout(Job::Report(done), FLUSH_MAX).is_ok() {
            // Late or not: the program ends.
            let _ = is_done.recv_timeout(FLUSH_MAX);
        }
    }
}

/// Work for the thread.
#[derive(Debug)]
enum Job {
    Line(Box<[u8]>),
    /// Report that every line before is written.
    Report(Sender<()>),
}

/// The program's side: never waits.
struct Queue {
    jobs: Sender<Job>,
    /// Lines that found no room since the thread last looked.
    dropped: Arc<AtomicU64>,
}

impl Queue {
    /// Starts the thread, which writes to `log`.
    fn start(log: LossyLog) -> io::Result<Self> {
        let (jobs, waiting) = bounded(QUEUE_LEN);
        let dropped = Arc::new(AtomicU64::new(0));
        let lost = Arc::clone(&dropped);
        let work = move || write_all(log, &waiting, &lost);
        std::thread::Builder::new().name("log".into()).spawn(work)?;
        Ok(Self { jobs, dropped })
    }
}

impl Write for &Queue {
    /// Takes one line, written later or not.
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        if self.jobs.try_send(Job::Line(line.into())).is_err() {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn write_all(mut log: LossyLog, jobs: &Receiver<Job>, dropped: &AtomicU64) {
    for job in jobs {
        match job {
            Job::Line(line) => {
                log.lose(dropped.swap(0, Ordering::Relaxed));
                log.write(&line);
            }
            // Who asked may have given up.
            Job::Report(done) => drop(done.try_send(())),
        }
    }
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

/// A log that drops lines that cannot be written, and counts them.
struct LossyLog {
    file: File,
    lost: Option<Lost>,
}

/// Lines since the last one that was written whole.
struct Lost {
    lines: u64,
    error: io::Error,
    /// Whether a partial line is at the log's end.
    torn: bool,
}

impl LossyLog {
    fn new(file: File) -> Self {
        Self { file, lost: None }
    }

    /// Counts lines that were lost before they came here.
    fn lose(&mut self, lines: u64) {
        if lines == 0 {
            return;
        }
        let full = || Lost { lines: 0, error: ErrorKind::WouldBlock.into(), torn: false };
        let lost = self.lost.get_or_insert_with(full);
        lost.lines = lost.lines.saturating_add(lines);
    }

    /// Takes one line, written or not.
    fn write(&mut self, line: &[u8]) {
        let lost = self.lost.as_ref();
        let notice = lost.map(|lost| notice(lost, JSON.load(Ordering::Relaxed)));
        let notice = notice.unwrap_or_default();
        let bytes = [notice.as_bytes(), line].concat();
        let (written, error) = write_now(&mut self.file, &bytes);
        let Some(error) = error else {
            self.lost = None;
            return;
        };
        // A notice that was written whole is not repeated.
        let before = self.lost.take().filter(|_| notice.is_empty() || written < notice.len());
        self.lost = Some(Lost {
            lines: before.as_ref().map_or(0, |lost| lost.lines).saturating_add(1),
            error,
            torn: written > 0 || before.is_some_and(|lost| lost.torn),
        });
    }
}

/// The line that reports losses.
fn notice(Lost { lines, error, torn }: &Lost, json: bool) -> String {
    let text = format!("{lines} log lines were lost: {error}");
    let start = if *torn { "\n" } else { "" };
    if json {
        let line = serde_json::json!({ "level": "WARN", "fields": { "message": text } });
        format!("{start}{line}\n")
    } else {
        format!("{start} WARN {text}\n")
    }
}

/// Writes as much as possible without waiting. Returns the length, and the error that ended it.
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

    #[test]
    fn lines_that_find_no_room_are_dropped_counted_and_reported() {
        let (reader, writer) = pipe().unwrap();
        let mut lossy = LossyLog::new(writer.into());
        let line = format!("{}\n", "x".repeat(999));
        // Far more than a pipe holds: each call returns although there is no reader.
        (0..1_000).for_each(|_| lossy.write(line.as_bytes()));
        let mut reader = File::from(reader);
        let mut full = vec![0; 1 << 20];
        let held = reader.read(&mut full).unwrap();
        assert!(full[..held].starts_with(line.as_bytes()));
        lossy.write(b"again\n");
        lossy.write(b"and again\n");
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
        let mut lossy = LossyLog::new(full);
        (0..3).for_each(|_| lossy.write(b"{}\n"));
        let notice = notice(lossy.lost.as_ref().unwrap(), true);
        assert!(notice.contains("\"3 log lines were lost: No space left"), "{notice}");
        let (reader, writer) = pipe().unwrap();
        drop(reader);
        let mut lossy = LossyLog::new(writer.into());
        lossy.write(b"nobody reads\n");
        assert_eq!(lossy.lost.as_ref().unwrap().lines, 1);
    }

    #[test]
    fn a_log_that_takes_nothing_delays_nobody_and_its_losses_are_reported() {
        let (reader, writer) = pipe().unwrap();
        let (jobs, waiting) = bounded(2);
        let queue = Queue { jobs, dropped: Arc::new(AtomicU64::new(0)) };
        let line = |text: &str| assert_eq!((&queue).write(text.as_bytes()).unwrap(), text.len());
        // The thread, as on a disk that is busy, does not come to them.
        ["1\n", "2\n", "3\n", "4\n"].into_iter().for_each(line);
        let dropped = Arc::clone(&queue.dropped);
        drop(queue);
        write_all(LossyLog::new(writer.into()), &waiting, &dropped);
        let mut text = String::new();
        File::from(reader).read_to_string(&mut text).unwrap();
        assert_eq!(text, " WARN 2 log lines were lost: operation would block\n1\n2\n");
    }

    #[test]
    fn end_of_a_program_waits_for_its_last_lines() {
        let (reader, writer) = pipe().unwrap();
        let queue = Queue::start(LossyLog::new(writer.into())).unwrap();
        let flush = LogFlush(Some(queue.jobs.clone()));
        (&queue).write_all(b"the last line\n").unwrap();
        drop(flush);
        let mut text = [0; 64];
        let len = rustix::io::read(&reader, &mut text).unwrap();
        assert_eq!(&text[..len], b"the last line\n");
    }
}
