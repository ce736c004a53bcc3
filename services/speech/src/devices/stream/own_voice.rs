//! When the robot's own voice sounds.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use service::{Span, Time};

/// Sentences that are remembered: sound arrives some tenths of a second after it was made.
const SENTENCES_MAX: usize = 8;

/// The robot's own voice, which a microphone in the room hears as well. Shared between what speaks
/// and what listens.
#[derive(Debug)]
pub struct OwnVoice {
    /// How long a sentence goes on sounding in the room.
    echo: Span,
    /// When the latest sentences began and ended.
    sentences: Mutex<VecDeque<(Time, Option<Time>)>>,
}

impl OwnVoice {
    /// A robot that is silent; `echo` is how long the room and the sound card's buffers go on
    /// sounding after a sentence.
    pub fn new(echo: Span) -> Self {
        Self { echo, sentences: Mutex::default() }
    }

    /// A sentence begins to sound.
    pub fn begins(&self, at: Time) {
        let mut sentences = self.sentences();
        if sentences.len() >= SENTENCES_MAX {
            sentences.pop_front();
        }
        sentences.push_back((at, None));
    }

    /// The sentence is over, or was broken off.
    pub fn ends(&self, at: Time) {
        if let Some((_, end @ None)) = self.sentences().back_mut() {
            *end = Some(at);
        }
    }

    /// Whether what a microphone hears at `at` may be the robot itself.
    pub fn sounds_at(&self, at: Time) -> bool {
        let covers = |(began, ended): &(Time, Option<Time>)| {
            *began <= at && ended.is_none_or(|ended| at < ended + self.echo)
        };
        self.sentences().iter().any(covers)
    }

    fn sentences(&self) -> MutexGuard<'_, VecDeque<(Time, Option<Time>)>> {
        // The list is whole after every statement that changes it.
        self.sentences.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_sounds_from_the_beginning_to_the_echos_end() {
        let voice = OwnVoice::new(Span::from_ms(300));
        let ms = |ms: u64| Time(ms * 1_000_000);
        assert!(!voice.sounds_at(ms(0)));
        voice.begins(ms(1_000));
        assert!(
            !voice.sounds_at(ms(999)) && voice.sounds_at(ms(1_000)) && voice.sounds_at(ms(9_000))
        );
        voice.ends(ms(2_000));
        voice.ends(ms(5_000));
        assert!(voice.sounds_at(ms(2_299)) && !voice.sounds_at(ms(2_300)));
        voice.begins(ms(3_000));
        assert!(voice.sounds_at(ms(1_500)), "sound that arrives late is judged by its own time");
        (0..100).for_each(|n| voice.begins(ms(10_000 + n)));
        assert!(voice.sentences().len() <= SENTENCES_MAX);
    }
}
