//! Recording programs.

use std::io::{self, BufRead, BufReader, ErrorKind, Read as _};
use std::process::{ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use crate::child_process::{ChildProcess, sleep};

/// Lines of standard error that are logged; more only repeat themselves.
const LINES_MAX: usize = 20;
/// Longest logged line, bytes.
const LINE_BYTES: usize = 300;
/// Bytes per read: the capacity of a pipe.
const READ_BYTES: usize = 1 << 16;
/// Delay after a full read: the program is faster than any microphone.
const THROTTLE: Duration = Duration::from_millis(20);
/// Time limit for the exit of a program that has closed its output.
const EXIT_TIMEOUT: Duration = Duration::from_millis(200);

/// Returns the command lines that write one channel of signed 16-bit samples, little-endian, at 16
/// kHz to their standard output: of ALSA (package alsa-utils), PipeWire (pipewire-bin) and
/// PulseAudio (pulseaudio-utils).
pub(crate) fn default_programs() -> Vec<Vec<String>> {
    let command = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
    vec![
        command(&["arecord", "-q", "-t", "raw", "-f", "S16_LE", "-r", "16000", "-c", "1", "-"]),
        command(&["pw-record", "--raw", "--format=s16", "--rate=16000", "--channels=1", "-"]),
        command(&["parecord", "--raw", "--format=s16le", "--rate=16000", "--channels=1"]),
    ]
}

/// A running program. Dropping it kills and reaps it.
pub(super) struct Recorder {
    process: ChildProcess,
    stdout: ChildStdout,
    /// First byte of an incomplete sample.
    odd: Option<u8>,
    /// The first line on its standard error, once that is closed or has a line.
    complaint: Option<Receiver<String>>,
}

/// Result of a read.
pub(super) enum Read {
    /// Samples.
    Samples(Vec<i16>),
    /// Nothing before the timeout.
    Nothing,
    /// End of the program, with the reason.
    Ended(String),
}

impl Recorder {
    /// Starts a program.
    pub(super) fn start(words: &[String]) -> Result<Self, String> {
        let [name, arguments @ ..] = words else {
            return Err("no program is configured".to_owned());
        };
        let mut command = Command::new(name);
        command.args(arguments).stdout(Stdio::piped());
        let mut process = ChildProcess::start(command).map_err(|error| error.to_string())?;
        let complaint = process.child.stderr.take().map(|stderr| {
            let (said, complaint) = channel();
            let name = name.clone();
            thread::spawn(move || {
                log(&name, stderr, |line| {
                    // The program may be gone already.
                    let _ = said.send(line.to_owned());
                });
            });
            complaint
        });
        let stdout = process.child.stdout.take().ok_or_else(|| format!("{name} has no output"))?;
        Ok(Self { process, stdout, odd: None, complaint })
    }

    /// Returns the name of the program.
    pub(super) fn name(&self) -> &str {
        &self.process.program
    }

    /// Waits for samples until the timeout.
    pub(super) fn read(&mut self, timeout: Duration) -> Read {
        let mut polled = [PollFd::new(&self.stdout, PollFlags::IN)];
        let timeout = Timespec::try_from(timeout).unwrap_or_default();
        match poll(&mut polled, Some(&timeout)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => return Read::Nothing,
            Ok(_) => {}
            Err(error) => return Read::Ended(format!("{}: {error}", self.name())),
        }
        let mut bytes = vec![0; READ_BYTES];
        match self.stdout.read(&mut bytes) {
            Ok(0) => Read::Ended(self.end()),
            Ok(count) => {
                if count == READ_BYTES {
                    thread::sleep(THROTTLE);
                }
                Read::Samples(self.samples(&bytes[..count]))
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Read::Nothing,
            Err(error) => Read::Ended(format!("{}: {error}", self.name())),
        }
    }

    fn samples(&mut self, bytes: &[u8]) -> Vec<i16> {
        let mut bytes = self.odd.take().into_iter().chain(bytes.iter().copied());
        let mut samples = Vec::new();
        while let Some(low) = bytes.next() {
            match bytes.next() {
                Some(high) => samples.push(i16::from_le_bytes([low, high])),
                None => self.odd = Some(low),
            }
        }
        samples
    }

    /// Returns why the program has closed its output: its own message, if it gave one.
    fn end(&mut self) -> String {
        let ended = match self.process.wait(EXIT_TIMEOUT, sleep) {
            Ok(_) => format!("{} exited", self.name()),
            Err(error) => error.to_string(),
        };
        let said = self.complaint.take().and_then(|said| said.recv_timeout(EXIT_TIMEOUT).ok());
        said.map_or_else(|| ended.clone(), |said| format!("{ended}: {said}"))
    }
}

/// Logs a program's standard error, and passes each line on.
fn log(name: &str, stderr: impl io::Read, mut pass_on: impl FnMut(&str)) {
    let mut reader = BufReader::new(stderr);
    for _ in 0..LINES_MAX {
        let mut line = Vec::new();
        match (&mut reader).take(LINE_BYTES as u64).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let text = String::from_utf8_lossy(&line);
        if !text.trim().is_empty() {
            tracing::warn!(program = name, stderr = text.trim(), "recording program");
            pass_on(text.trim());
        }
    }
    // A full pipe would block the program.
    let _ = io::copy(&mut reader, &mut io::sink());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Recorder {
        let words = ["sh", "-c", script].map(str::to_owned);
        Recorder::start(&words).unwrap()
    }

    fn read_all(recording: &mut Recorder) -> (Vec<i16>, String) {
        let mut all = Vec::new();
        loop {
            match recording.read(Duration::from_secs(10)) {
                Read::Samples(samples) => all.extend(samples),
                Read::Nothing => panic!("no samples within ten seconds"),
                Read::Ended(why) => return (all, why),
            }
        }
    }

    #[test]
    fn recorder_reads_whole_samples_and_reports_the_end() {
        for (script, samples, reason) in [
            (
                "printf '\\001'; sleep 0.05; printf '\\002\\377\\377\\005'",
                &[0x0201, -1][..],
                "sh exited",
            ),
            ("exit 3", &[], "sh failed (exit status: 3)"),
        ] {
            assert_eq!(read_all(&mut shell(script)), (samples.to_vec(), reason.to_owned()));
        }
        let unknown = Recorder::start(&["no-such-recorder".to_owned()]).err();
        assert_eq!(unknown.as_deref(), Some("the program no-such-recorder is not installed"));
        let mut silent = shell("exec sleep 30");
        assert!(matches!(silent.read(Duration::from_millis(5)), Read::Nothing));
    }

    #[test]
    fn recorder_is_not_blocked_by_standard_error() {
        let lines = "i=0; while [ $i -lt 3000 ]; do echo message number $i, one more than before >&2; \
                     i=$((i+1)); done; printf '\\001\\000'";
        assert_eq!(read_all(&mut shell(lines)).0, [1]);
    }
}
