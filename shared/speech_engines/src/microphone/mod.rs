//! The microphone of the robot's computer: a recording program, on a thread of its own.
//!
//! Invariant: the thread never blocks on its receiver. Every `StreamEvent::Began` is followed by
//! one `StreamEvent::Ended`, even if the program dies in the middle of a word; every request to
//! talk is answered by that or by one `StreamEvent::Silent`. Events that the receiver does not take
//! in time are dropped and counted.

mod level;
mod recorder;
mod worker;

use std::sync::Arc;
use std::time::Duration;

use crate::live_events::Sink;
use crate::stream::{Closings, PlaybackMask};
use crate::vad::SegmenterOptions;
use crate::worker_thread::{QueueError, WorkerThread};
pub use messages::MicrophoneState;
use recorder::default_programs;

/// Settings of the microphone.
#[derive(Clone, Debug, PartialEq)]
pub struct MicrophoneOptions {
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
    /// Returns options for a microphone that is always open, with the first program that works.
    pub fn hands_free() -> Self {
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

/// A request to record one utterance.
#[derive(Clone, Copy, Debug)]
struct Talk {
    sound: u64,
    longest: Duration,
}

/// The microphone's thread. Dropping it ends the thread and the recording program.
pub struct Microphone(WorkerThread<Talk>);

impl Microphone {
    /// Starts the thread.
    pub fn start(
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

    /// Records one utterance with the number `sound`, from now on for `longest` at most. The
    /// robot's own voice is not masked: the request interrupts it.
    pub fn talk(&self, sound: u64, longest: Duration) -> Result<(), QueueError> {
        self.0.offer(Talk { sound, longest })
    }
}

#[cfg(test)]
mod tests;
