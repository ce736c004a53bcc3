//! Interim results of utterances in progress.

use crate::pending_sounds::PendingSound;
use crate::{Fx, Out};
use messages::{FixedText, Partial, RequestKey, Source};

/// Numbers and publishes interim results.
#[derive(Debug, Default)]
pub(super) struct InterimResults {
    number: u64,
}

impl InterimResults {
    /// Publishes the words of a sound so far.
    pub(super) fn publish(&mut self, sound: &PendingSound, text: &str, fx: &mut Fx) {
        self.send(sound, text, false, fx);
    }

    /// Publishes that a sound has its result.
    pub(super) fn finish(&mut self, sound: &PendingSound, fx: &mut Fx) {
        if sound.source == Source::Microphone {
            self.send(sound, "", true, fx);
        }
    }

    fn send(&mut self, sound: &PendingSound, text: &str, over: bool, fx: &mut Fx) {
        let RequestKey(stream) = sound.key;
        self.number += 1;
        fx.publish(Out::Partial(Box::new(Partial {
            stream,
            onset_ns: sound.onset.ns(),
            number: self.number,
            segment: sound.segment.map_or(0, |(segment, _)| segment),
            over: u8::from(over),
            text: FixedText::truncated(text),
            ..Partial::default()
        })));
    }
}
