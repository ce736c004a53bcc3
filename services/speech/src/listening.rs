//! Sounds that are being spoken or recognised.

use std::collections::BTreeMap;

use crate::live::Began;
use messages::{RequestKey, Source};
use service::Time;

/// A sound on its way to becoming an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Listened {
    /// The request, or the stream, that it belongs to.
    pub(crate) key: RequestKey,
    /// Which piece of how many it is; none for a recording, which turns out to be any number. Of a
    /// stream nobody knows how many: 0.
    pub(crate) segment: Option<(u32, u32)>,
    /// Where it comes from.
    pub(crate) source: Source,
    /// When it began.
    pub(crate) onset: Time,
    /// When a live one ended; none while it lasts.
    pub(crate) end: Option<Time>,
}

/// Every sound that has begun and has no result yet.
#[derive(Debug, Default)]
pub(crate) struct Listening {
    sounds: BTreeMap<u64, Listened>,
    last: u64,
}

impl Listening {
    /// Whether a sound of this request is among them.
    pub(crate) fn has(&self, key: RequestKey) -> bool {
        self.sounds.values().any(|sound| sound.key == key)
    }

    /// A sound that a client gave. Returns its number.
    pub(crate) fn take(&mut self, key: RequestKey, source: Source, onset: Time) -> u64 {
        self.last += 1;
        let segment = (source == Source::Microphone).then_some((0, 1));
        self.sounds.insert(self.last, Listened { key, segment, source, onset, end: None });
        self.last
    }

    /// Somebody began to speak, perhaps into the microphone that a client had opened.
    pub(crate) fn began(&mut self, began: &Began, now: Time) {
        let onset = began.at.min(now);
        let asked = self.sounds.get(&began.sound).map(|sound| sound.key);
        let listened = Listened {
            key: asked.unwrap_or(began.stream),
            segment: Some(began.segment.map_or((0, 1), |segment| (segment, 0))),
            source: began.source,
            onset,
            end: None,
        };
        self.sounds.insert(began.sound, listened);
    }

    /// Whoever spoke has ended. Returns whether anything is known of the sound.
    pub(crate) fn ended(&mut self, sound: u64, (onset, end): (Time, Time)) -> bool {
        let found = self.sounds.get_mut(&sound);
        found.map(|sound| (sound.onset, sound.end) = (onset, Some(end))).is_some()
    }

    /// A sound that is being spoken.
    pub(crate) fn spoken(&self, sound: u64) -> Option<&Listened> {
        self.sounds.get(&sound).filter(|sound| sound.end.is_none())
    }

    /// There is a result.
    pub(crate) fn remove(&mut self, sound: u64) -> Option<Listened> {
        self.sounds.remove(&sound)
    }

    /// When the first of them began.
    pub(crate) fn since(&self) -> Option<Time> {
        self.sounds.values().map(|sound| sound.onset).min()
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.sounds.len()
    }
}
