//! The microphone of the robot's computer: a recording program, on a thread of its own.
//!
//! Invariant: the thread never blocks on its receiver. Every `StreamEvent::Began` is followed by one
//! `StreamEvent::Ended`, even if the program dies in the middle of a word; every request to talk is
//! answered by that or by one `StreamEvent::Silent`. What the receiver does not take in time is
//! dropped and counted.

mod event_queue;
mod level;
mod recorder;
mod worker;

use std::sync::Arc;
use std::time::Duration;

use crate::devices::stream::{Closings, PlaybackMask};
use crate::devices::vad::SegmenterOptions;
use crate::devices::worker_thread::{QueueError, WorkerThread};
pub(crate) use event_queue::EventQueue;
pub(crate) use event_queue::Sink;
pub(crate) use messages::MicrophoneState;
pub(crate) use recorder::default_programs;

/// Settings of the microphone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MicrophoneOptions {
    /// Recording programs with their arguments, the preferred one first.
    pub programs: Vec<Vec<String>>,
    /// `true` if it is always open, `false` if only on request.
    pub hands_free: bool,
    /// `true` if it does not record the robot's own voice (headset, echo cancellation), so that
    /// users may interrupt.
    pub barge_in: bool,
    /// Segmentation of the audio.
    pub segmenter: SegmenterOptions,
    /// A source without samples for this long has paused: further samples start a new stream.
    pub pause: Duration,
    /// Shortest and longest delay before a program is restarted; doubled in between.
    pub retry: (Duration, Duration),
}

impl MicrophoneOptions {
    /// Returns the options of the configuration.
    pub(crate) fn of(speech: &config::Speech) -> Self {
        let microphone = &speech.microphone;
        let defaults = Self::hands_free();
        Self {
            programs: microphone.command.clone().map_or(defaults.programs, |own| vec![own]),
            hands_free: microphone.mode == config::MicrophoneMode::HandsFree,
            barge_in: microphone.barge_in,
            segmenter: SegmenterOptions::of(speech),
            ..defaults
        }
    }

    /// Returns options for a microphone that is always open, with the first program that works.
    pub(crate) fn hands_free() -> Self {
        Self {
            programs: default_programs(),
            hands_free: true,
            barge_in: false,
            segmenter: SegmenterOptions::default(),
            pause: Duration::from_secs(1),
            retry: (Duration::from_millis(250), Duration::from_secs(30)),
        }
    }
}

/// Status of the microphone, published on every change and five times a second while it listens.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MicrophoneStatus {
    /// Its state.
    pub state: MicrophoneState,
    /// Level over the last fifth of a second, decibels below full scale; -100 for digital silence and
    /// where it is unknown.
    pub level_db: f32,
    /// Restarts of recording programs.
    pub restarts: u32,
    /// Utterances dropped because the service was too busy.
    pub dropped: u32,
    /// The program, or the reason why it does not run.
    pub note: String,
}

impl MicrophoneStatus {
    /// Returns the status of a closed microphone.
    pub fn closed() -> Self {
        let (state, level_db) = (MicrophoneState::Closed, level::QUIETEST_DB);
        Self { state, level_db, restarts: 0, dropped: 0, note: String::new() }
    }
}

/// A request to record one utterance.
#[derive(Clone, Copy, Debug)]
struct Talk {
    sound: u64,
    longest: Duration,
}

/// The microphone's thread. Dropping it ends the thread and the recording program.
pub(crate) struct Microphone(WorkerThread<Talk>);

impl Microphone {
    /// Starts the thread.
    pub(crate) fn start(
        options: MicrophoneOptions,
        mask: Arc<PlaybackMask>,
        closings: Arc<Closings>,
        sink: Sink,
    ) -> Self {
        let run = move |requests: &_| {
            worker::Worker::new(options, mask, closings, sink).run(requests);
        };
        Self(WorkerThread::start(1, run))
    }

    /// Records one utterance with the number `sound`, from now on for `longest` at most. The robot's own
    /// voice is not masked: the request interrupts it.
    pub(crate) fn talk(&self, sound: u64, longest: Duration) -> Result<(), QueueError> {
        self.0.offer(Talk { sound, longest })
    }
}

#[cfg(test)]
mod tests;
