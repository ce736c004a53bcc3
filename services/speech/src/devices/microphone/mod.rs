//! The microphone of the robot's computer: a program that records, on a thread of its own.
//!
//! Invariant: the thread never waits for anybody. Every [`Live::Began`] is followed by one
//! [`Live::Ended`], also where the program dies in the middle of a word; every request to talk is
//! answered by that or by one [`Live::Silent`]. What nobody takes in time is dropped and counted.

mod level;
mod outgoing;
mod program;
mod thread;

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use crossbeam_channel::{Sender, TrySendError, bounded};

use crate::devices::stream::OwnVoice;
use crate::devices::vad::SegmenterOptions;
use crate::live::Live;
pub use messages::MicrophoneState;
pub(crate) use outgoing::Outgoing;
pub use outgoing::Sink;
pub use program::usual;

/// What the microphone is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct MicrophoneOptions {
    /// Programs to record with, the preferred one first; each with its arguments.
    pub programs: Vec<Vec<String>>,
    /// Whether it listens all the time; else only while it is asked to.
    pub hands_free: bool,
    /// Whether it does not hear the robot's own voice (a headset, cancelled echo), so that people
    /// may interrupt.
    pub barge_in: bool,
    /// How speech is cut out of the sound.
    pub segmenter: SegmenterOptions,
    /// A source without sound for this long is taken to have paused: what comes next is new.
    pub pause: Duration,
    /// How long to wait after a program has died before another is tried: the shortest and the
    /// longest, doubled in between.
    pub retry: (Duration, Duration),
}

impl MicrophoneOptions {
    /// What the settings ask for.
    pub fn of(speech: &config::Speech) -> Self {
        let microphone = &speech.microphone;
        let defaults = Self::hands_free();
        Self {
            programs: microphone.command.clone().map_or(defaults.programs, |own| vec![own]),
            hands_free: microphone.mode == config::MicrophoneMode::HandsFree,
            barge_in: microphone.barge_in,
            segmenter: SegmenterOptions {
                closing_pause_s: speech.closing_pause.as_secs_f64(),
                longest_s: speech.spoken_max.as_secs_f64(),
                ..SegmenterOptions::default()
            },
            ..defaults
        }
    }

    /// A microphone that listens all the time through the first program that works.
    pub fn hands_free() -> Self {
        Self {
            programs: usual(),
            hands_free: true,
            barge_in: false,
            segmenter: SegmenterOptions::default(),
            pause: Duration::from_secs(1),
            retry: (Duration::from_millis(250), Duration::from_secs(30)),
        }
    }
}

/// What the microphone did.
#[derive(Clone, Debug, PartialEq)]
pub enum MicrophoneEvent {
    /// Somebody was heard.
    Live(Live),
    /// How it is, whenever that changes and five times a second while it listens.
    Status(MicrophoneStatus),
}

/// How the microphone is.
#[derive(Clone, Debug, PartialEq)]
pub struct MicrophoneStatus {
    /// What it does.
    pub state: MicrophoneState,
    /// How loud it is, decibels below full scale (0 is the loudest there is), over the last fifth
    /// of a second; -100 for digital silence and where nothing is known.
    pub level_db: f32,
    /// Programs that died and were started anew.
    pub restarts: u32,
    /// Utterances that were lost because nobody took them in time.
    pub dropped: u32,
    /// The program, or why there is none.
    pub note: String,
}

impl MicrophoneStatus {
    /// A microphone that is not open.
    pub fn closed() -> Self {
        let (state, level_db) = (MicrophoneState::Closed, level::QUIETEST_DB);
        Self { state, level_db, restarts: 0, dropped: 0, note: String::new() }
    }
}

/// Why a microphone is not opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TalkError {
    /// Somebody talks already.
    #[error("somebody is talking through this microphone already")]
    Busy,
    /// The thread has broken down.
    #[error("the microphone has broken down")]
    Gone,
}

/// A request to listen for one utterance.
#[derive(Clone, Copy, Debug)]
struct Talk {
    sound: u64,
    longest: Duration,
}

/// The microphone's thread. Dropping it ends the thread and the program that records.
pub struct Microphone {
    requests: Option<Sender<Talk>>,
    thread: Option<JoinHandle<()>>,
}

impl Microphone {
    /// Starts the thread.
    pub fn start(options: MicrophoneOptions, own_voice: Arc<OwnVoice>, sink: Sink) -> Self {
        let (requests, asked) = bounded(1);
        let work = move || thread::Worker::new(options, own_voice, sink).run(&asked);
        Self { requests: Some(requests), thread: Some(std::thread::spawn(work)) }
    }

    /// Listens for one utterance, which becomes `sound`, from now on for `longest` at most. The
    /// robot's own voice is no hindrance: whoever asks to talk makes it fall silent.
    ///
    /// # Errors
    /// If another request is being served, or the thread is gone.
    pub fn talk(&self, sound: u64, longest: Duration) -> Result<(), TalkError> {
        let requests = self.requests.as_ref().ok_or(TalkError::Gone)?;
        requests.try_send(Talk { sound, longest }).map_err(|error| match error {
            TrySendError::Full(_) => TalkError::Busy,
            TrySendError::Disconnected(_) => TalkError::Gone,
        })
    }
}

impl Drop for Microphone {
    fn drop(&mut self) {
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests;
