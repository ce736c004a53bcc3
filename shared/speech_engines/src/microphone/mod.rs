//! The microphone of the robot's computer: a recording program, on a thread of its own.
//!
//! Invariant: the thread never blocks on its receiver. Every `StreamEvent::Began` is followed by
//! one `StreamEvent::Ended`, even if the program dies in the middle of a word; every request to
//! talk is answered by that or by one `StreamEvent::Silent`. Events that the receiver does not take
//! in time are dropped and counted.

mod level;
mod recorder;
mod worker;

use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use vocabulary::time::Span;

use crate::live_events::{LiveEvent, Sink};
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

/// Time limit for the first samples of a program that is tried out.
const TRY_OUT: Duration = Duration::from_secs(3);

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

    /// Records for a moment, whatever the mode. Returns the program that records.
    ///
    /// # Errors
    /// Why none does.
    pub fn try_out(options: MicrophoneOptions) -> Result<String, String> {
        let options = MicrophoneOptions { hands_free: true, ..options };
        let programs = options.programs.len();
        let (send, events) = mpsc::channel();
        let sink = move |event| {
            // Without a receiver the result is known already.
            let _ = send.send(event);
            Ok(())
        };
        let mask = Arc::new(PlaybackMask::new(Span::from_ms(0)));
        let _microphone = Self::start(options, mask, Arc::default(), Box::new(sink));
        let (until, mut failed) = (Instant::now() + TRY_OUT, Vec::new());
        while failed.len() < programs {
            match events.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(LiveEvent::Microphone(status)) => match status.state {
                    MicrophoneState::Listening => return Ok(status.note),
                    MicrophoneState::Broken => failed.push(status.note),
                    _ => {}
                },
                Ok(_) => {}
                Err(_) => {
                    failed.push("the program delivers no audio".to_owned());
                    break;
                }
            }
        }
        Err(failed.join("; "))
    }

    /// Records one utterance with the number `sound`, from now on for `longest` at most. The
    /// robot's own voice is not masked: the request interrupts it.
    pub fn talk(&self, sound: u64, longest: Duration) -> Result<(), QueueError> {
        self.0.offer(Talk { sound, longest })
    }
}

#[cfg(test)]
mod tests;
