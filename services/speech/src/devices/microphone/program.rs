//! Programs that record from the sound card.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

/// Lines that a program may complain of in the log; more only repeat themselves.
const COMPLAINTS_MAX: usize = 20;
/// Longest complaint, bytes.
const COMPLAINT_BYTES: usize = 300;
/// Bytes read at a time: what a pipe holds.
const READ_BYTES: usize = 1 << 16;
/// A program that hands over this much at once is faster than any microphone and is held back.
const HOLD_BACK: Duration = Duration::from_millis(20);
/// How long, and how often, a program's end is waited for once it has closed its output.
const LAST_LOOK: Duration = Duration::from_millis(5);
const LAST_LOOKS: usize = 40;

/// The command lines that give one channel of signed 16-bit samples, low byte first, at 16 kHz, on
/// their standard output: ALSA's (package alsa-utils), PipeWire's (pipewire-bin) and PulseAudio's
/// (pulseaudio-utils).
pub fn usual() -> Vec<Vec<String>> {
    let command = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
    vec![
        command(&["arecord", "-q", "-t", "raw", "-f", "S16_LE", "-r", "16000", "-c", "1", "-"]),
        command(&["pw-record", "--raw", "--format=s16", "--rate=16000", "--channels=1", "-"]),
        command(&["parecord", "--raw", "--format=s16le", "--rate=16000", "--channels=1"]),
    ]
}

/// A program that is recording; dropping it ends and reaps it.
pub(super) struct Recording {
    name: String,
    child: Child,
    sound: ChildStdout,
    /// The first byte of a sample whose second has not come yet.
    odd: Option<u8>,
}

/// What came from a program.
pub(super) enum Read16 {
    /// These samples.
    Samples(Vec<i16>),
    /// Nothing in the time given.
    Nothing,
    /// Its end, and why.
    Over(String),
}

impl Recording {
    /// Starts a program.
    pub(super) fn start(words: &[String]) -> Result<Self, String> {
        let [name, arguments @ ..] = words else { return Err("no program is named".to_owned()) };
        let mut command = Command::new(name);
        command.args(arguments);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => format!("the program {name} is not installed"),
            _ => format!("{name} could not be started: {error}"),
        })?;
        let (sound, complaints) = (child.stdout.take(), child.stderr.take());
        if let Some(complaints) = complaints {
            let name = name.clone();
            thread::spawn(move || tell(&name, complaints));
        }
        let Some(sound) = sound else { return Err(format!("{name} has no output")) };
        Ok(Self { name: name.clone(), child, sound, odd: None })
    }

    /// The program's name.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Waits for sound, but not longer than `patience`.
    pub(super) fn read(&mut self, patience: Duration) -> Read16 {
        let mut polled = [PollFd::new(&self.sound, PollFlags::IN)];
        let timeout = Timespec::try_from(patience).unwrap_or_default();
        match poll(&mut polled, Some(&timeout)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => return Read16::Nothing,
            Ok(_) => {}
            Err(error) => return Read16::Over(format!("{}: {error}", self.name)),
        }
        let mut bytes = vec![0; READ_BYTES];
        match self.sound.read(&mut bytes) {
            Ok(0) => Read16::Over(self.end()),
            Ok(count) => {
                if count == READ_BYTES {
                    thread::sleep(HOLD_BACK);
                }
                Read16::Samples(self.samples(&bytes[..count]))
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => Read16::Nothing,
            Err(error) => Read16::Over(format!("{}: {error}", self.name)),
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

    fn end(&mut self) -> String {
        // It has closed its output and ends by itself, or what it still does is of no use.
        for _ in 0..LAST_LOOKS {
            match self.child.try_wait() {
                Ok(None) => thread::sleep(LAST_LOOK),
                Ok(Some(_)) | Err(_) => break,
            }
        }
        let _ = self.child.kill();
        match self.child.wait() {
            Ok(status) if status.success() => format!("{} has ended", self.name),
            Ok(status) => format!("{} failed ({status})", self.name),
            Err(error) => format!("{}: {error}", self.name),
        }
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        // Both fail only if it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Hands a program's complaints to the log.
fn tell(name: &str, complaints: impl Read) {
    let mut reader = BufReader::new(complaints);
    for _ in 0..COMPLAINTS_MAX {
        let mut line = Vec::new();
        match (&mut reader).take(COMPLAINT_BYTES as u64).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let text = String::from_utf8_lossy(&line);
        if !text.trim().is_empty() {
            tracing::warn!(program = name, says = text.trim(), "microphone");
        }
    }
    // It must not be held up by a pipe that nobody empties.
    let _ = std::io::copy(&mut reader, &mut std::io::sink());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Recording {
        let words = ["sh", "-c", script].map(str::to_owned);
        Recording::start(&words).unwrap()
    }

    fn read_all(recording: &mut Recording) -> (Vec<i16>, String) {
        let mut all = Vec::new();
        loop {
            match recording.read(Duration::from_secs(10)) {
                Read16::Samples(samples) => all.extend(samples),
                Read16::Nothing => panic!("nothing in ten seconds"),
                Read16::Over(why) => return (all, why),
            }
        }
    }

    #[test]
    fn samples_arrive_whole_however_they_are_written() {
        let mut recording = shell("printf '\\001'; sleep 0.05; printf '\\002\\377\\377\\005'");
        let (samples, why) = read_all(&mut recording);
        assert_eq!(samples, [0x0201, -1]);
        assert_eq!(why, "sh has ended");
    }

    #[test]
    fn a_programs_end_is_told() {
        let (samples, why) = read_all(&mut shell("exit 3"));
        assert_eq!((samples.len(), why.as_str()), (0, "sh failed (exit status: 3)"));
        let unknown = Recording::start(&["no-such-recorder".to_owned()]).err();
        assert_eq!(unknown.as_deref(), Some("the program no-such-recorder is not installed"));
    }

    #[test]
    fn waiting_for_sound_has_an_end() {
        let mut recording = shell("exec sleep 30");
        assert!(matches!(recording.read(Duration::from_millis(5)), Read16::Nothing));
    }

    #[test]
    fn complaints_do_not_hold_a_program_up() {
        let mut recording = shell(
            "i=0; while [ $i -lt 3000 ]; do echo complaint number $i, which is one more than before >&2; i=$((i+1)); done; printf '\\001\\000'",
        );
        assert_eq!(read_all(&mut recording).0, [1]);
    }
}
