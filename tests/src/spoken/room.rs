//! A microphone in a room: a pipe that the robot's recording program reads, into which noise and
//! speech are written in real time.

use std::collections::VecDeque;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::fs::{CWD, FileType, Mode, OFlags, mknodat};
use service::clock;
use service::{Span, Time};

/// Samples a second.
const RATE_HZ: f64 = 16_000.0;
/// Samples that are written at a time: 20 ms.
const FRAME: usize = 320;

/// Speech still to be heard: its first sample's number, and the samples.
type Speech = VecDeque<(u64, Vec<i16>)>;

/// What sounds in a room.
#[derive(Debug, Default)]
struct Sounds {
    /// The user, whose sentences follow each other.
    said: Speech,
    /// A loudspeaker, over the user.
    played: Speech,
}

/// The room. Dropping it ends its sound.
#[derive(Debug)]
pub struct Room {
    sounds: Arc<Mutex<Sounds>>,
    silent: Arc<AtomicBool>,
    began: Time,
    thread: Option<JoinHandle<()>>,
}

impl Room {
    /// A room with this noise, in samples without end, whose sound comes out of the named pipe `path`,
    /// which is made.
    ///
    /// # Panics
    /// If the pipe cannot be made.
    pub fn open(path: &Path, noise: impl Iterator<Item = f64> + Send + 'static) -> Self {
        let mode = Mode::RUSR | Mode::WUSR;
        mknodat(CWD, path, FileType::Fifo, mode, 0).expect("a named pipe");
        let (sounds, silent) = (Arc::default(), Arc::new(AtomicBool::new(false)));
        let began = clock::now();
        let air = Air {
            path: path.to_owned(),
            noise,
            sounds: Arc::clone(&sounds),
            silent: Arc::clone(&silent),
        };
        let thread = std::thread::spawn(move || air.sound());
        Self { sounds, silent, began, thread: Some(thread) }
    }

    /// Has speech begin at `at`, or when what was said before has ended. Returns when it begins and
    /// ends.
    ///
    /// # Panics
    /// If the thread that makes the sound has panicked.
    pub fn say(&self, at: Time, samples: Vec<i16>) -> (Time, Time) {
        let said = &mut self.sounds.lock().unwrap_or_else(PoisonError::into_inner).said;
        let earliest = at.max(clock::now()).since(self.began).s() * RATE_HZ;
        let free = said.back().map_or(0, |(start, samples)| start + samples.len() as u64);
        let start = (earliest as u64).max(free);
        let end = start + samples.len() as u64;
        said.push_back((start, samples));
        let time = |sample: u64| self.began + Span::from_s(sample as f64 / RATE_HZ);
        (time(start), time(end))
    }

    /// Has a loudspeaker play from `at` on; what is late of it is not heard.
    ///
    /// # Panics
    /// If the thread that makes the sound has panicked.
    pub fn play(&self, at: Time, samples: Vec<i16>) {
        let start = (at.since(self.began).s() * RATE_HZ) as u64;
        let played = &mut self.sounds.lock().unwrap_or_else(PoisonError::into_inner).played;
        played.push_back((start, samples));
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        self.silent.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let ended = thread.join();
            debug_assert!(ended.is_ok(), "the room's sound thread panicked");
        }
    }
}

struct Air<N> {
    path: PathBuf,
    noise: N,
    sounds: Arc<Mutex<Sounds>>,
    silent: Arc<AtomicBool>,
}

impl<N: Iterator<Item = f64>> Air<N> {
    /// Writes each frame when its last sample has sounded. Without a reader, or with a slow one, it
    /// is lost as it would be from a real microphone.
    fn sound(mut self) {
        let began = Instant::now();
        let mut pipe: Option<File> = None;
        for frame in 0_u64.. {
            if self.silent.load(Ordering::SeqCst) {
                return;
            }
            let bytes = self.frame(frame * FRAME as u64);
            let due = began + Duration::from_secs_f64((frame + 1) as f64 * FRAME as f64 / RATE_HZ);
            std::thread::sleep(due.saturating_duration_since(Instant::now()));
            if pipe.is_none() {
                let flags = OFlags::NONBLOCK.bits() as i32;
                pipe = OpenOptions::new().write(true).custom_flags(flags).open(&self.path).ok();
            }
            let written = pipe.as_mut().map(|pipe| pipe.write(&bytes));
            if let Some(Err(error)) = written
                && error.kind() == std::io::ErrorKind::BrokenPipe
            {
                pipe = None;
            }
        }
    }

    fn frame(&mut self, first: u64) -> Vec<u8> {
        let mut samples: Vec<f64> = self.noise.by_ref().take(FRAME).collect();
        let mut sounds = self.sounds.lock().unwrap_or_else(PoisonError::into_inner);
        let Sounds { said, played } = &mut *sounds;
        for (start, said) in said.iter().chain(&*played) {
            for (n, sample) in samples.iter_mut().enumerate() {
                let at = (first + n as u64).checked_sub(*start);
                let spoken = at.and_then(|at| said.get(at as usize));
                *sample += spoken.map_or(0.0, |s| f64::from(*s));
            }
        }
        for speech in [said, played] {
            speech.retain(|(start, said)| start + said.len() as u64 > first + FRAME as u64);
        }
        let limit = f64::from(i16::MAX);
        let bytes = samples.iter().map(|s| s.clamp(-limit, limit) as i16);
        bytes.flat_map(i16::to_le_bytes).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sound::Pink;
    use super::*;
    use std::io::Read;

    #[test]
    fn room_plays_speech_on_time_and_in_sequence() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("microphone");
        let room = Room::open(&path, Pink::new(1.0, 1));
        let mut pipe = File::open(&path).unwrap();
        let soon = clock::now() + Span::from_ms(100);
        let first = room.say(soon, vec![9_000; 1_600]);
        let second = room.say(soon, vec![-9_000; 1_600]);
        assert!(first.0.ns().abs_diff(soon.ns()) < 1_000_000, "{first:?}, {soon:?}");
        assert_eq!(second.0, first.1);
        let mut bytes = vec![0; 32_000];
        pipe.read_exact(&mut bytes).unwrap();
        let samples: Vec<i16> =
            bytes.chunks(2).map(|pair| i16::from_le_bytes([pair[0], pair[1]])).collect();

        let positive = samples.iter().filter(|s| **s > 8_000).count();
        let negative = samples.iter().filter(|s| **s < -8_000).count();
        assert_eq!((positive, negative), (1_600, 1_600));
    }
}
