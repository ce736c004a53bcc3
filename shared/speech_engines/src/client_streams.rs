//! Clients' audio streams, segmented into utterances on a thread of its own.
//!
//! Invariant: every [`StreamEvent::Began`] is followed by one [`StreamEvent::Ended`]; every stream
//! is followed by one [`StreamEvent::Closed`], even if its client dies. The number of streams and
//! the queue are bounded; losses are counted and replaced by silence.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError};
use messages::{AudioChunk, RequestKey, Source};
use runtime::clock;
use vocabulary::time::{Span, Time};

use crate::live_events::{EventQueue, LiveEvent, Sink};
use crate::stream::{
    Began, Closings, Duplex, MaskedStream, PlaybackMask, StreamEvent, next_sound, shifted,
};
use crate::vad::SegmenterOptions;
use crate::worker_thread::WorkerThread;

/// Simultaneous streams; further ones are closed before they begin.
pub const STREAMS_MAX: usize = 8;
/// Chunks that may wait for the thread: more than three seconds of one stream.
const CHUNKS_MAX: usize = 160;
/// Longest gap that is filled with silence within an utterance, samples: half a second.
const GAP_MAX: u64 = 8_000;
/// Polling interval for paused streams, and for events that wait.
const POLL_EVERY: Duration = Duration::from_millis(250);
/// A stream without chunks for this long has paused: its utterance ends.
const PAUSE: Duration = Duration::from_secs(1);
/// A stream without chunks for this long is closed: its client has died.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Oldest plausible recording time; an older one is due to another clock.
const OLDEST: Span = Span::from_ms(30_000);

/// The thread that segments clients' streams. Dropping it ends the thread.
pub struct ClientStreams(WorkerThread<Box<AudioChunk>>);

impl ClientStreams {
    /// Starts the thread.
    pub fn start(
        segmenter: SegmenterOptions,
        mask: Arc<PlaybackMask>,
        closings: Arc<Closings>,
        sink: Sink,
    ) -> Self {
        let streams =
            Streams { segmenter, mask, closings, queue: EventQueue::new(sink), open: Vec::new() };
        Self(WorkerThread::start(CHUNKS_MAX, move |chunks| streams.run(chunks)))
    }

    /// Queues a chunk. Without room it is lost, as in transit.
    pub fn take(&self, chunk: &AudioChunk) {
        // The next chunk reveals the gap.
        let _ = self.0.offer(Box::new(*chunk));
    }
}

/// The thread's side.
struct Streams {
    segmenter: SegmenterOptions,
    mask: Arc<PlaybackMask>,
    closings: Arc<Closings>,
    queue: EventQueue,
    open: Vec<OpenStream>,
}

/// A stream in progress.
struct OpenStream {
    key: RequestKey,
    stream: MaskedStream,
    /// Number of the next sample.
    next: u64,
    lost: u64,
    utterances: u32,
    is_held: bool,
    /// Whether the utterance in progress was begun with the button held, which is released.
    is_released: bool,
    last_chunk: Instant,
}

impl Streams {
    fn run(mut self, chunks: &Receiver<Box<AudioChunk>>) {
        loop {
            let is_idle = self.open.is_empty() && self.queue.is_empty();
            let pause = if is_idle { Duration::MAX } else { POLL_EVERY };
            match chunks.recv_timeout(pause) {
                Ok(chunk) => self.take(&chunk, clock::now()),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.check_timeouts();
            self.queue.flush();
        }
    }

    fn take(&mut self, chunk: &AudioChunk, now: Time) {
        let key = chunk.request();
        let known = self.open.iter().position(|open| open.key == key);
        let ends = chunk.is(AudioChunk::END);
        let at = match known {
            Some(at) => at,
            None if ends => return self.close(key, 0, 0),
            None if self.open.len() >= STREAMS_MAX => {
                tracing::warn!("stream rejected: {STREAMS_MAX} clients are streaming already");
                return self.close(key, 0, chunk.count.into());
            }
            None => {
                self.open.push(self.begin(key, chunk));
                self.open.len() - 1
            }
        };
        let events = self.open[at].take(chunk, now);
        self.send(events);
        if ends {
            self.end(at);
        }
    }

    /// Returns a new stream, whose beginning the service may have processed before a restart.
    fn begin(&self, key: RequestKey, chunk: &AudioChunk) -> OpenStream {
        OpenStream {
            key,
            stream: MaskedStream::new(
                self.segmenter.clone(),
                Arc::clone(&self.mask),
                Arc::clone(&self.closings),
            ),
            next: chunk.first_sample,
            lost: 0,
            utterances: 0,
            is_held: false,
            is_released: false,
            last_chunk: Instant::now(),
        }
    }

    fn end(&mut self, at: usize) {
        let mut open = self.open.swap_remove(at);
        self.send(open.stream.finish());
        self.close(open.key, open.utterances, open.lost);
    }

    fn close(&mut self, stream: RequestKey, utterances: u32, lost: u64) {
        if lost > 0 {
            tracing::warn!(lost, "samples of a client's stream were lost in transit");
        }
        self.send([StreamEvent::Closed { stream, utterances, lost }]);
    }

    fn send(&mut self, events: impl IntoIterator<Item = StreamEvent>) {
        events.into_iter().for_each(|event| self.queue.send(LiveEvent::Stream(event)));
    }

    fn check_timeouts(&mut self) {
        for at in (0..self.open.len()).rev() {
            let quiet = self.open[at].last_chunk.elapsed();
            if quiet >= TIMEOUT {
                self.end(at);
            } else if quiet >= PAUSE {
                let event = self.open[at].stream.finish();
                self.send(event);
            }
        }
    }
}

impl OpenStream {
    fn take(&mut self, chunk: &AudioChunk, now: Time) -> Vec<StreamEvent> {
        self.last_chunk = Instant::now();
        if chunk.first_sample < self.next {
            return Vec::new();
        }
        let samples = chunk.sound();
        let mut events = Vec::new();
        let latest = shifted(now, -(samples.len() as i64));
        let recorded = Time(chunk.taken_ns);
        let is_plausible = recorded <= latest && recorded + OLDEST > now;
        let at = if is_plausible { recorded } else { latest };
        let held = chunk.is(AudioChunk::HELD);
        let released = std::mem::replace(&mut self.is_held, held) && !held;
        let gap = chunk.first_sample - self.next;
        self.lost = self.lost.saturating_add(gap);
        if gap > GAP_MAX {
            events.extend(self.stream.finish());
        }
        if released {
            self.stream.release();
        }
        self.is_released = (released || self.is_released) && self.is_speaking();
        let is_full = held || self.is_released || chunk.is(AudioChunk::ECHO_FREE);
        let duplex = if is_full { Duplex::Full } else { Duplex::Half };
        if (1..=GAP_MAX).contains(&gap) {
            let silence = vec![0; gap as usize];
            events.extend(self.push(shifted(at, -(gap as i64)), &silence, self.next, duplex));
        }
        events.extend(self.push(at, samples, chunk.first_sample, duplex));
        self.next = chunk.first_sample.saturating_add(samples.len() as u64);
        events
    }

    fn is_speaking(&self) -> bool {
        self.stream.sound_in_progress().is_some()
    }

    /// Processes samples, the first of which is number `first` of the stream.
    fn push(&mut self, at: Time, samples: &[i16], first: u64, duplex: Duplex) -> Vec<StreamEvent> {
        let (stream, utterances) = (self.key, &mut self.utterances);
        let mut began = |onset: Time| {
            *utterances += 1;
            let before = (onset.since(Time(0)).s() - at.since(Time(0)).s()) * 10.0;
            let tenths = (first as f64 / 1_600.0 + before).max(0.0) as u32;
            Began {
                sound: next_sound(),
                at: onset,
                stream,
                segment: Some(tenths),
                source: Source::Microphone,
                interrupts: duplex == Duplex::Full,
            }
        };
        self.stream.push(at, samples, duplex, &mut began)
    }
}

#[cfg(test)]
mod tests;
