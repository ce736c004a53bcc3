//! Clients' audio streams, segmented into utterances on a thread of its own.
//!
//! Invariant: every [`StreamEvent::Began`] is followed by one [`StreamEvent::Ended`]; every stream is
//! followed by one [`StreamEvent::Closed`], even if its client dies. The number of streams and the
//! queue are bounded; losses are counted and replaced by silence.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use messages::{AudioChunk, RequestKey, Source};
use service::clock;
use service::{Span, Time};

use crate::devices::microphone::{EventQueue, MicrophoneEvent, Sink};
use crate::devices::stream::{Duplex, MaskedStream, PlaybackMask, SegmentEvent, shifted};
use crate::devices::vad::SegmenterOptions;
use crate::stream_events::{Began, StreamEvent, next_sound};

/// Simultaneous streams; further ones are closed before they begin.
pub const STREAMS_MAX: usize = 8;
/// Chunks that may wait for the thread: more than three seconds of one stream.
const CHUNKS_MAX: usize = 64;
/// Longest gap that is filled with silence within an utterance, samples: half a second.
const GAP_MAX: u64 = 8_000;
/// Polling interval for paused streams.
const POLL_EVERY: Duration = Duration::from_millis(250);
/// A stream without chunks for this long has paused: its utterance ends.
const PAUSE: Duration = Duration::from_secs(1);
/// A stream without chunks for this long is closed: its client has died.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Oldest plausible recording time; an older one is due to another clock.
const OLDEST: Span = Span::from_ms(30_000);

/// The thread that segments clients' streams. Dropping it ends the thread.
pub struct ClientStreams {
    chunks: Option<Sender<Box<AudioChunk>>>,
    thread: Option<JoinHandle<()>>,
}

impl ClientStreams {
    /// Starts the thread.
    pub fn start(segmenter: SegmenterOptions, mask: Arc<PlaybackMask>, sink: Sink) -> Self {
        let (chunks, received) = bounded(CHUNKS_MAX);
        let streams = Streams { segmenter, mask, queue: EventQueue::new(sink), open: Vec::new() };
        let thread = std::thread::spawn(move || streams.run(&received));
        Self { chunks: Some(chunks), thread: Some(thread) }
    }

    /// Queues a chunk. Without room it is lost, as in transit.
    pub fn take(&self, chunk: &AudioChunk) {
        if let Some(chunks) = &self.chunks {
            // The next chunk reveals the gap.
            let _ = chunks.try_send(Box::new(*chunk));
        }
    }
}

impl Drop for ClientStreams {
    fn drop(&mut self) {
        self.chunks = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has been logged.
            let _ = thread.join();
        }
    }
}

/// The thread's side.
struct Streams {
    segmenter: SegmenterOptions,
    mask: Arc<PlaybackMask>,
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
    /// The utterance in progress.
    sound: Option<u64>,
    is_held: bool,
    last_chunk: Instant,
}

impl Streams {
    fn run(mut self, chunks: &Receiver<Box<AudioChunk>>) {
        loop {
            match chunks.recv_timeout(POLL_EVERY) {
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
            stream: MaskedStream::new(self.segmenter.clone(), Arc::clone(&self.mask)),
            next: chunk.first_sample,
            lost: 0,
            utterances: 0,
            sound: None,
            is_held: false,
            last_chunk: Instant::now(),
        }
    }

    fn end(&mut self, at: usize) {
        let mut open = self.open.swap_remove(at);
        let events = open.end_utterance();
        self.send(events);
        self.close(open.key, open.utterances, open.lost);
    }

    fn close(&mut self, stream: RequestKey, utterances: u32, lost: u64) {
        if lost > 0 {
            tracing::warn!(lost, "samples of a client's stream were lost in transit");
        }
        self.send(vec![StreamEvent::Closed { stream, utterances, lost }]);
    }

    fn send(&mut self, events: Vec<StreamEvent>) {
        events.into_iter().for_each(|event| self.queue.send(MicrophoneEvent::Stream(event)));
    }

    fn check_timeouts(&mut self) {
        for at in (0..self.open.len()).rev() {
            let quiet = self.open[at].last_chunk.elapsed();
            if quiet >= TIMEOUT {
                self.end(at);
            } else if quiet >= PAUSE {
                let events = self.open[at].end_utterance();
                self.send(events);
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
        if gap > GAP_MAX || released {
            events.extend(self.end_utterance());
        }
        let duplex =
            if held || chunk.is(AudioChunk::ECHO_FREE) { Duplex::Full } else { Duplex::Half };
        if (1..=GAP_MAX).contains(&gap) && !released {
            let silence = vec![0; gap as usize];
            events.extend(self.push(shifted(at, -(gap as i64)), &silence, self.next, duplex));
        }
        events.extend(self.push(at, samples, chunk.first_sample, duplex));
        self.next = chunk.first_sample.saturating_add(samples.len() as u64);
        events
    }

    /// Processes samples, the first of which is number `first` of the stream.
    fn push(&mut self, at: Time, samples: &[i16], first: u64, duplex: Duplex) -> Vec<StreamEvent> {
        let events = self.stream.push(at, samples, duplex);
        self.numbered(events, |onset| {
            let before = (onset.since(Time(0)).s() - at.since(Time(0)).s()) * 10.0;
            ((first as f64 / 1_600.0 + before).max(0.0) as u32, duplex)
        })
    }

    fn end_utterance(&mut self) -> Vec<StreamEvent> {
        let events = self.stream.finish();
        self.numbered(events, |_| (0, Duplex::Half))
    }

    /// Numbers the events; `segment` returns number and duplex mode of an utterance by its onset.
    fn numbered(
        &mut self,
        events: Vec<SegmentEvent>,
        segment: impl Fn(Time) -> (u32, Duplex),
    ) -> Vec<StreamEvent> {
        let (stream, utterances) = (self.key, &mut self.utterances);
        let mut began = |at| {
            *utterances += 1;
            let (segment, duplex) = segment(at);
            Began {
                sound: next_sound(),
                at,
                stream,
                segment: Some(segment),
                source: Source::Microphone,
                interrupts: duplex == Duplex::Full,
            }
        };
        let sound = &mut self.sound;
        let numbered = events.into_iter();
        numbered.filter_map(|event| StreamEvent::number(event, sound, &mut began)).collect()
    }
}

#[cfg(test)]
mod tests;
