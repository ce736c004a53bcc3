//! Sounds in progress or awaiting recognition, and the ended streams that wait for them.

use std::collections::BTreeMap;

use messages::{FixedText, Partial, RequestKey, Source};
use service::Time;
use speech_engines::stream::Began;

/// A sound that may become an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PendingSound {
    /// The request or stream that it belongs to.
    pub(crate) key: RequestKey,
    /// Number and total of its segment; `None` for a recording, which may contain several. The
    /// total of a stream is unknown: 0.
    pub(crate) segment: Option<(u32, u32)>,
    /// Source of the sound.
    pub(crate) source: Source,
    /// Start of the sound.
    pub(crate) onset: Time,
    /// End of a live sound; `None` while it lasts.
    pub(crate) end: Option<Time>,
    /// `true` if its speaker can interrupt the robot.
    pub(crate) interrupts: bool,
    /// `true` if the robot's own voice covers a part of it.
    pub(crate) is_cut: bool,
}

impl PendingSound {
    /// Returns interim result `number`: the words so far; `over`: the sound has its result.
    pub(crate) fn partial(&self, number: u64, text: &str, over: bool) -> Partial {
        Partial {
            stream: self.key.0,
            onset_ns: self.onset.ns(),
            number,
            segment: self.segment.map_or(0, |(segment, _)| segment),
            over: u8::from(over),
            text: FixedText::truncated(text),
            ..Partial::default()
        }
    }
}

/// A client's stream that has ended.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct ClosedStream {
    pub(crate) key: RequestKey,
    /// Number of utterances.
    pub(crate) utterances: u32,
    /// Samples lost in transit.
    pub(crate) lost: u64,
}

/// Streams that may wait for the results of their utterances.
const STREAMS_MAX: usize = 64;

/// Every sound that has begun and has no result yet.
#[derive(Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct PendingSounds {
    sounds: BTreeMap<u64, PendingSound>,
    last: u64,
    /// Ended streams that have not been reported.
    closed: Vec<ClosedStream>,
}

impl PendingSounds {
    /// Returns whether a sound of this request is pending.
    pub(crate) fn contains(&self, key: RequestKey) -> bool {
        self.sounds.values().any(|sound| sound.key == key)
    }

    /// Adds a sound requested by a client. Returns its number.
    pub(crate) fn add(&mut self, key: RequestKey, source: Source, onset: Time) -> u64 {
        self.last += 1;
        let segment = (source == Source::Microphone).then_some((0, 1));
        let (end, interrupts, is_cut) = (None, false, false);
        let sound = PendingSound { key, segment, source, onset, end, interrupts, is_cut };
        self.sounds.insert(self.last, sound);
        self.last
    }

    /// Adds a live sound, which may belong to a client's request.
    pub(crate) fn began(&mut self, began: &Began, now: Time) {
        let requested = self.sounds.get(&began.sound).map(|sound| sound.key);
        let sound = PendingSound {
            key: requested.unwrap_or(began.stream),
            segment: Some(began.segment.map_or((0, 1), |segment| (segment, 0))),
            source: began.source,
            onset: began.at.min(now),
            end: None,
            interrupts: began.interrupts,
            is_cut: false,
        };
        self.sounds.insert(began.sound, sound);
    }

    /// Records that the robot's own voice covers a part of a live sound.
    pub(crate) fn cut(&mut self, sound: u64) {
        if let Some(sound) = self.sounds.get_mut(&sound) {
            sound.is_cut = true;
        }
    }

    /// Records the end of a live sound. Returns whether the sound is known.
    pub(crate) fn ended(&mut self, sound: u64, (onset, end): (Time, Time)) -> bool {
        let found = self.sounds.get_mut(&sound);
        found.map(|sound| (sound.onset, sound.end) = (onset, Some(end))).is_some()
    }

    /// Returns a sound that is in progress.
    pub(crate) fn in_progress(&self, sound: u64) -> Option<&PendingSound> {
        self.sounds.get(&sound).filter(|sound| sound.end.is_none())
    }

    /// Removes a sound that has its result.
    pub(crate) fn remove(&mut self, sound: u64) -> Option<PendingSound> {
        self.sounds.remove(&sound)
    }

    /// Adds an ended stream. Clients repeat the end until confirmed; only the first end counts.
    pub(crate) fn close(&mut self, stream: ClosedStream) {
        if self.closed.iter().any(|closed| closed.key == stream.key) {
            return;
        }
        if self.closed.len() >= STREAMS_MAX {
            self.closed.remove(0);
        }
        self.closed.push(stream);
    }

    /// Removes the ended streams whose utterances all have their results.
    pub(crate) fn take_closed(&mut self) -> Vec<ClosedStream> {
        let sounds = &self.sounds;
        let is_done = |stream: &mut ClosedStream| sounds.values().all(|s| s.key != stream.key);
        self.closed.extract_if(.., is_done).collect()
    }

    /// Returns when the first of them began.
    pub(crate) fn since(&self) -> Option<Time> {
        self.sounds.values().map(|sound| sound.onset).min()
    }

    /// Returns their number.
    pub(crate) fn len(&self) -> usize {
        self.sounds.len()
    }
}
