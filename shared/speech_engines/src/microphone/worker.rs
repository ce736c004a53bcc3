//! The microphone's thread: runs the recording program, restarts it, and segments its audio.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, TryRecvError};
use messages::{MicrophoneState, Source};
use runtime::client::random_key;
use runtime::clock;

use super::level::Level;
use super::recorder::{Read, Recorder};
use super::{MicrophoneOptions, Talk};
use crate::live_events::{EventQueue, LiveEvent, MicrophoneStatus, QUIETEST_DB, Sink};
use crate::stream::{
    Began, Closings, Duplex, MaskedStream, PlaybackMask, SampleClock, StreamEvent, next_sound,
};

/// Timeout of one read.
const READ_TIMEOUT: Duration = Duration::from_millis(50);
/// Interval at which a closed microphone offers events that wait for room.
const RETRY_EVERY: Duration = Duration::from_secs(1);
const HELP: &str = "help: run `whichone doctor`; set the program in speech.toml, table [microphone], \
    key command; or install alsa-utils";
/// A program that has delivered samples for this long works: its end does not count as a failure.
const WORKING: Duration = Duration::from_secs(1);

pub(super) struct Worker {
    options: MicrophoneOptions,
    queue: EventQueue,
    stream: MaskedStream,
    clock: SampleClock,
    recorder: Option<Recorder>,
    /// Since when samples arrive without a pause.
    running_since: Option<Instant>,
    last_read: Instant,
    /// Index of the current program, and consecutive failures.
    program: usize,
    failures: u32,
    retry_at: Instant,
    level: Level,
    status: MicrophoneStatus,
    /// Why the latest program failed that is installed.
    cause: Option<String>,
    request: Option<Request>,
}

/// A request in progress.
struct Request {
    sound: u64,
    until: Instant,
    /// `true` if any samples arrived for it.
    has_samples: bool,
}

impl Worker {
    pub(super) fn new(
        options: MicrophoneOptions,
        mask: Arc<PlaybackMask>,
        closings: Arc<Closings>,
        sink: Sink,
    ) -> Self {
        let now = Instant::now();
        Self {
            stream: MaskedStream::new(options.segmenter.clone(), mask, closings),
            queue: EventQueue::new(sink),
            clock: SampleClock::default(),
            recorder: None,
            running_since: None,
            last_read: now,
            program: 0,
            failures: 0,
            retry_at: now,
            level: Level::default(),
            status: MicrophoneStatus::closed(),
            cause: None,
            request: None,
            options,
        }
    }

    /// Runs until the [`Microphone`](super::Microphone) is dropped.
    pub(super) fn run(mut self, requests: &Receiver<Talk>) {
        self.publish_status();
        loop {
            if self.options.hands_free || self.request.is_some() {
                match requests.try_recv() {
                    Ok(talk) => self.begin(talk),
                    Err(TryRecvError::Empty) => {}
                    Err(TryRecvError::Disconnected) => return,
                }
                self.record(requests);
                self.check_timeout();
            } else {
                self.close();
                let pause = if self.queue.is_empty() { Duration::MAX } else { RETRY_EVERY };
                match requests.recv_timeout(pause) {
                    Ok(talk) => self.begin(talk),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            self.queue.flush();
        }
    }

    fn begin(&mut self, talk: Talk) {
        if self.request.is_some() {
            let reason = "the microphone is busy already".to_owned();
            return self.send(StreamEvent::Silent { sound: talk.sound, reason });
        }
        // Speech in progress does not belong to the request.
        self.end_stream();
        let until = Instant::now() + talk.longest;
        self.request = Some(Request { sound: talk.sound, until, has_samples: false });
        (self.failures, self.retry_at) = (0, Instant::now());
    }

    /// Reads once from the program, which is started if necessary.
    fn record(&mut self, requests: &Receiver<Talk>) {
        if self.recorder.is_none() {
            if Instant::now() < self.retry_at {
                // A request ends the wait.
                let wait = (self.retry_at - Instant::now()).min(READ_TIMEOUT);
                if let Ok(talk) = requests.recv_timeout(wait) {
                    self.begin(talk);
                }
                return;
            }
            self.open();
        }
        let Some(recorder) = &mut self.recorder else { return };
        match recorder.read(READ_TIMEOUT) {
            Read::Samples(samples) => self.process(&samples),
            Read::Nothing if self.last_read.elapsed() >= self.options.pause => self.end_stream(),
            Read::Nothing => {}
            Read::Ended(reason) => self.failed(reason),
        }
    }

    fn open(&mut self) {
        let words = self.options.programs.get(self.program).map_or(&[][..], Vec::as_slice);
        match Recorder::start(words) {
            Ok(recorder) => {
                self.status.note = recorder.name().to_owned();
                self.status.state = MicrophoneState::Opening;
                self.recorder = Some(recorder);
                self.last_read = Instant::now();
            }
            Err(reason) => self.failed(reason),
        }
    }

    fn process(&mut self, samples: &[i16]) {
        let now = Instant::now();
        self.last_read = now;
        if self.running_since.is_none() {
            self.running_since = Some(now);
            self.cause = None;
            tracing::info!(program = self.status.note, "microphone listening");
        }
        let at = self.clock.read(samples.len(), clock::now());
        if let Some(request) = &mut self.request {
            request.has_samples = true;
        }
        let barge_in = self.options.barge_in;
        let is_full = self.request.is_some() || barge_in;
        let duplex = if is_full { Duplex::Full } else { Duplex::Half };
        // The next utterance is the requested one, unless that is in progress already.
        let mut requested = self.request.as_ref().map(|request| request.sound);
        requested = requested.filter(|sound| self.stream.sound_in_progress() != Some(*sound));
        let mut began = |at| {
            let requested = requested.take();
            Began {
                sound: requested.unwrap_or_else(next_sound),
                at,
                stream: random_key(),
                segment: None,
                source: Source::Microphone,
                interrupts: barge_in || requested.is_some(),
            }
        };
        for event in self.stream.push(at, samples, duplex, &mut began) {
            self.forward(event);
        }
        let muted = self.stream.is_muted();
        let state = if muted { MicrophoneState::Muted } else { MicrophoneState::Listening };
        let changed = std::mem::replace(&mut self.status.state, state) != state;
        let measured = self.level.push(samples);
        self.status.level_db = self.level.db();
        if changed || measured {
            self.publish_status();
        }
    }

    /// Sends an event of the stream. The end of the requested utterance ends the request.
    fn forward(&mut self, event: StreamEvent) {
        if let StreamEvent::Ended { sound, .. } = &event {
            self.request.take_if(|request| request.sound == *sound);
        }
        self.send(event);
    }

    /// Ends a request whose time is up.
    fn check_timeout(&mut self) {
        let now = Instant::now();
        let Some(request) = self.request.take_if(|request| now >= request.until) else { return };
        if self.stream.sound_in_progress() == Some(request.sound) {
            return self.end_stream();
        }
        let note = &self.status.note;
        let reason = match request.has_samples {
            true => format!("no speech heard (microphone: {note})"),
            false => format!("no audio from the microphone ({note}); {HELP}"),
        };
        self.send(StreamEvent::Silent { sound: request.sound, reason });
    }

    /// Handles the end of the program, or a failed start.
    fn failed(&mut self, reason: String) {
        // That another program is not installed does not explain why this one failed.
        let reason = match self.recorder {
            Some(_) => self.cause.insert(reason).clone(),
            None => self.cause.clone().unwrap_or(reason),
        };
        let worked = self.running_since.is_some_and(|since| since.elapsed() >= WORKING);
        self.close();
        self.status.restarts += 1;
        if worked {
            self.failures = 0;
        } else {
            self.program = (self.program + 1) % self.options.programs.len().max(1);
            self.failures += 1;
        }
        let delay = self.retry_delay();
        tracing::warn!(reason, retry_in = ?delay, "microphone failed");
        self.status.state = MicrophoneState::Broken;
        self.status.note = reason;
        self.retry_at = Instant::now() + delay;
        self.publish_status();
        if self.failures as usize >= self.options.programs.len()
            && let Some(request) = self.request.take()
        {
            let reason = format!("the microphone does not work ({}); {HELP}", self.status.note);
            self.send(StreamEvent::Silent { sound: request.sound, reason });
        }
    }

    /// Returns the delay before the next attempt. Each program is tried once before any delay.
    fn retry_delay(&self) -> Duration {
        let programs = self.options.programs.len().max(1) as u32;
        if (1..programs).contains(&self.failures) {
            return Duration::ZERO;
        }
        let rounds = self.failures.saturating_sub(programs) / programs;
        let (shortest, longest) = self.options.retry;
        shortest.saturating_mul(1 << rounds.min(16)).min(longest)
    }

    /// Ends the stream and an utterance in progress; further samples start a new stream.
    fn end_stream(&mut self) {
        if let Some(event) = self.stream.finish() {
            self.forward(event);
        }
        self.clock = SampleClock::default();
        self.running_since = None;
    }

    /// Ends the program.
    fn close(&mut self) {
        self.end_stream();
        self.level = Level::default();
        self.status.level_db = QUIETEST_DB;
        if self.recorder.take().is_some() {
            self.status.state = MicrophoneState::Closed;
            self.publish_status();
        }
    }

    fn publish_status(&mut self) {
        self.status.dropped = self.queue.dropped();
        self.queue.send(LiveEvent::Microphone(self.status.clone()));
    }

    fn send(&mut self, event: StreamEvent) {
        self.queue.send(LiveEvent::Stream(event));
    }
}
