//! What is told of an utterance while it is being spoken.

use crate::devices::stream::Cut;
use crate::listening::{Listened, Listening};
use crate::{Fx, Out};
use messages::{FixedText, Partial, RequestKey, Source};

/// Follows what is being spoken.
#[derive(Debug, Default)]
pub(super) struct Partials {
    number: u64,
}

impl Partials {
    /// The next samples of a sound.
    pub(super) fn overhear(
        &self,
        listening: &Listening,
        sound: u64,
        samples: Vec<i16>,
        fx: &mut Fx,
    ) {
        if listening.spoken(sound).is_some() {
            fx.publish(Out::Overhear(sound, samples));
        }
    }

    /// Perhaps all of a sound.
    pub(super) fn expect(&self, listening: &Listening, sound: u64, cut: Cut, fx: &mut Fx) {
        if listening.spoken(sound).is_some() {
            fx.publish(Out::Expect(sound, cut));
        }
    }

    /// The words of a sound so far; nobody is told of one that has ended meanwhile.
    pub(super) fn told(&mut self, listening: &Listening, sound: u64, text: &str, fx: &mut Fx) {
        if let Some(listened) = listening.spoken(sound) {
            self.publish(listened, text, false, fx);
        }
    }

    /// A sound has its result.
    pub(super) fn over(&mut self, listened: &Listened, fx: &mut Fx) {
        if listened.source == Source::Microphone {
            self.publish(listened, "", true, fx);
        }
    }

    fn publish(&mut self, listened: &Listened, text: &str, over: bool, fx: &mut Fx) {
        let RequestKey(stream) = listened.key;
        self.number += 1;
        fx.publish(Out::Partial(Box::new(Partial {
            stream,
            onset_ns: listened.onset.ns(),
            number: self.number,
            segment: listened.segment.map_or(0, |(segment, _)| segment),
            over: u8::from(over),
            text: FixedText::truncated(text),
            ..Partial::default()
        })));
    }
}
