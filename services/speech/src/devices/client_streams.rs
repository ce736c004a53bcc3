//! Sound that clients stream, cut into utterances on a thread of its own.
//!
//! Invariant: as for the microphone, every [`Live::Began`] is followed by one [`Live::Ended`]; every
//! stream is followed by one [`Live::Over`], also that of a client that has died. The number of
//! streams and what waits are bounded; what is lost is counted and becomes silence.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use messages::{AudioChunk, RequestKey, Source};
use service::clock;
use service::{Span, Time};

use crate::devices::microphone::{MicrophoneEvent, Outgoing, Sink};
use crate::devices::stream::{Duplex, Listener, OwnVoice, StreamEvent, shifted};
use crate::devices::vad::SegmenterOptions;
use crate::live::{Began, Live, next_sound};

/// Streams at a time; more are over before they begin.
pub const STREAMS_MAX: usize = 8;
/// Chunks that may wait for the thread: more than three seconds of one stream.
const CHUNKS_MAX: usize = 64;
/// Longest loss that becomes silence in the middle of an utterance, samples: half a second.
const GAP_MAX: u64 = 8_000;
/// How often quiet streams are looked at.
const LOOK: Duration = Duration::from_millis(250);
/// A stream that says nothing for this long has paused: an utterance in it ends.
const PAUSE: Duration = Duration::from_secs(1);
/// A stream that says nothing for this long is over: its client has died.
const PATIENCE: Duration = Duration::from_secs(10);
/// Sound older than this cannot be meant: the client's clock is another one.
const OLDEST: Span = Span::from_ms(30_000);

/// The thread that listens to clients' streams. Dropping it ends the thread.
pub struct ClientStreams {
    chunks: Option<Sender<Box<AudioChunk>>>,
    thread: Option<JoinHandle<()>>,
}

impl ClientStreams {
    /// Starts the thread.
    pub fn start(segmenter: SegmenterOptions, own_voice: Arc<OwnVoice>, sink: Sink) -> Self {
        let (chunks, taken) = bounded(CHUNKS_MAX);
        let outgoing = Outgoing::new(sink);
        let streams = Streams { segmenter, own_voice, outgoing, open: Vec::new() };
        Self { chunks: Some(chunks), thread: Some(std::thread::spawn(move || streams.run(&taken))) }
    }

    /// Listens to a chunk. One for which there is no room is lost, as on its way.
    pub fn take(&self, chunk: &AudioChunk) {
        if let Some(chunks) = &self.chunks {
            // The gap is noticed and counted with the next chunk.
            let _ = chunks.try_send(Box::new(*chunk));
        }
    }
}

impl Drop for ClientStreams {
    fn drop(&mut self) {
        self.chunks = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

/// The thread's side.
struct Streams {
    segmenter: SegmenterOptions,
    own_voice: Arc<OwnVoice>,
    outgoing: Outgoing,
    open: Vec<Open>,
}

/// A stream that is going on.
struct Open {
    key: RequestKey,
    listener: Listener,
    /// Number of the sample that comes next.
    next: u64,
    lost: u64,
    utterances: u32,
    /// The utterance that is going on.
    sound: Option<u64>,
    is_held: bool,
    heard_last: Instant,
}

impl Streams {
    fn run(mut self, chunks: &Receiver<Box<AudioChunk>>) {
        loop {
            match chunks.recv_timeout(LOOK) {
                Ok(chunk) => self.take(&chunk, clock::now()),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.look_after_the_quiet();
            self.outgoing.flush();
        }
    }

    fn take(&mut self, chunk: &AudioChunk, now: Time) {
        let key = chunk.request();
        let known = self.open.iter().position(|open| open.key == key);
        let ends = chunk.is(AudioChunk::END);
        let at = match known {
            Some(at) => at,
            None if ends => return self.over(key, 0, 0),
            None if self.open.len() >= STREAMS_MAX => {
                tracing::warn!("{STREAMS_MAX} clients stream already; another one is not heard");
                return self.over(key, 0, chunk.count.into());
            }
            None => {
                self.begin(key, chunk);
                self.open.len() - 1
            }
        };
        let open = &mut self.open[at];
        for live in open.take(chunk, now) {
            self.outgoing.send(MicrophoneEvent::Live(live));
        }
        if ends {
            self.end(at);
        }
    }

    /// A stream that is heard for the first time: perhaps its beginning was heard by the service
    /// before its restart.
    fn begin(&mut self, key: RequestKey, chunk: &AudioChunk) {
        self.open.push(Open {
            key,
            listener: Listener::new(self.segmenter.clone(), Arc::clone(&self.own_voice)),
            next: chunk.first_sample,
            lost: 0,
            utterances: 0,
            sound: None,
            is_held: false,
            heard_last: Instant::now(),
        });
    }

    fn end(&mut self, at: usize) {
        let mut open = self.open.swap_remove(at);
        for live in open.break_off() {
            self.outgoing.send(MicrophoneEvent::Live(live));
        }
        self.over(open.key, open.utterances, open.lost);
    }

    fn over(&mut self, stream: RequestKey, utterances: u32, lost: u64) {
        if lost > 0 {
            tracing::warn!(lost, "samples of a client's stream were lost on their way");
        }
        self.outgoing.send(MicrophoneEvent::Live(Live::Over { stream, utterances, lost }));
    }

    fn look_after_the_quiet(&mut self) {
        for at in (0..self.open.len()).rev() {
            let open = &mut self.open[at];
            let quiet = open.heard_last.elapsed();
            if quiet >= PATIENCE {
                self.end(at);
            } else if quiet >= PAUSE {
                for live in open.break_off() {
                    self.outgoing.send(MicrophoneEvent::Live(live));
                }
            }
        }
    }
}

impl Open {
    fn take(&mut self, chunk: &AudioChunk, now: Time) -> Vec<Live> {
        self.heard_last = Instant::now();
        let sound = chunk.sound();
        if chunk.first_sample < self.next {
            return Vec::new();
        }
        let mut told = Vec::new();
        let length = sound.len() as i64;
        let latest = shifted(now, -length);
        let taken = Time(chunk.taken_ns);
        let is_of_our_clock = taken <= latest && taken + OLDEST > now;
        let at = if is_of_our_clock { taken } else { latest };
        let held = chunk.is(AudioChunk::HELD);
        let released = std::mem::replace(&mut self.is_held, held) && !held;
        let gap = chunk.first_sample - self.next;
        self.lost = self.lost.saturating_add(gap);
        if gap > GAP_MAX || released {
            told.extend(self.break_off());
        }
        let duplex =
            if held || chunk.is(AudioChunk::ECHO_FREE) { Duplex::Full } else { Duplex::Half };
        if (1..=GAP_MAX).contains(&gap) && !released {
            let silence = vec![0; gap as usize];
            told.extend(self.hear(shifted(at, -(gap as i64)), &silence, self.next, duplex));
        }
        told.extend(self.hear(at, sound, chunk.first_sample, duplex));
        self.next = chunk.first_sample.saturating_add(sound.len() as u64);
        told
    }

    /// Listens to samples, the first of which is number `first` of the stream.
    fn hear(&mut self, at: Time, samples: &[i16], first: u64, duplex: Duplex) -> Vec<Live> {
        let events = self.listener.hear(at, samples, duplex);
        let told = events.into_iter().filter_map(|event| match event {
            StreamEvent::Began(onset) => {
                let before = (onset.since(Time(0)).s() - at.since(Time(0)).s()) * 10.0;
                let tenth = (first as f64 / 1_600.0 + before).max(0.0) as u32;
                Some(self.began(onset, tenth, duplex))
            }
            StreamEvent::SoFar(samples) => self.sound.map(|sound| Live::SoFar { sound, samples }),
            StreamEvent::Paused(cut) => self.sound.map(|sound| Live::Paused { sound, cut }),
            StreamEvent::Ended(cut) => self.sound.take().map(|sound| Live::Ended { sound, cut }),
        });
        told.collect()
    }

    fn began(&mut self, at: Time, tenth: u32, duplex: Duplex) -> Live {
        let sound = next_sound();
        self.sound = Some(sound);
        self.utterances += 1;
        Live::Began(Began {
            sound,
            at,
            stream: self.key,
            segment: Some(tenth),
            source: Source::Microphone,
            interrupts: duplex == Duplex::Full,
        })
    }

    fn break_off(&mut self) -> Vec<Live> {
        let ended = self.listener.finish().into_iter().filter_map(|event| match event {
            StreamEvent::Ended(cut) => self.sound.take().map(|sound| Live::Ended { sound, cut }),
            _ => None,
        });
        ended.collect()
    }
}

#[cfg(test)]
mod tests;
