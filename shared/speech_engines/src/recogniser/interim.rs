//! Interim results of utterances in progress, on a thread of its own.
//!
//! Invariant: it delays nothing. It has a decoder of its own, runs at low priority, and omits sound
//! that it cannot decode in time.

use crossbeam_channel::Receiver;

use super::{InterimDecoder, InterimDecoderOpener};
use crate::worker_thread::lower_priority;

/// Blocks of samples that may wait: more than a second.
pub const BLOCKS_MAX: usize = 4;
/// Scheduling priority relative to the threads that return results (nice).
const NICENESS: i32 = 10;

/// Decodes blocks, each with the number of its sound, until there are no more or `publish`, which
/// gets the words so far whenever they change, returns `false`.
pub fn run(
    open: InterimDecoderOpener,
    blocks: &Receiver<(u64, Vec<i16>)>,
    mut publish: impl FnMut(u64, String) -> bool,
) {
    lower_priority(NICENESS);
    let Some(decoder) = open() else { return };
    let mut utterance = OngoingUtterance { decoder, sound: 0, text: String::new() };
    for (sound, samples) in blocks {
        if let Some(text) = utterance.decode(sound, &samples)
            && !publish(sound, text)
        {
            return;
        }
    }
}

/// The utterance in progress.
struct OngoingUtterance {
    decoder: Box<dyn InterimDecoder>,
    sound: u64,
    text: String,
}

impl OngoingUtterance {
    /// Returns the words so far if they have changed.
    fn decode(&mut self, sound: u64, samples: &[i16]) -> Option<String> {
        // Of simultaneous speakers the last to begin is followed: numbers rise.
        if sound < self.sound {
            return None;
        }
        if sound > self.sound {
            (self.sound, self.text) = (sound, String::new());
            self.decoder.begin().ok()?;
        }
        let text = self.decoder.decode(samples).ok()?;
        if text == self.text {
            return None;
        }
        self.text.clone_from(&text);
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recogniser::RecogniseError;
    use crossbeam_channel::unbounded;

    /// Returns other words for each block, the same ones twice.
    struct Stub(usize);

    impl InterimDecoder for Stub {
        fn begin(&mut self) -> Result<(), RecogniseError> {
            self.0 = 0;
            Ok(())
        }

        fn decode(&mut self, _: &[i16]) -> Result<String, RecogniseError> {
            self.0 += 1;
            Ok(["", "the", "the", "the white"][self.0 - 1].to_owned())
        }
    }

    #[test]
    fn interim_results_are_published_on_change_for_the_latest_speaker() {
        let ((give, blocks), mut published) = (unbounded(), Vec::new());
        for sound in [5, 5, 5, 5, 7, 7, 5, 5] {
            give.send((sound, vec![0; 10])).unwrap();
        }
        drop(give);
        run(Box::new(|| Some(Box::new(Stub(0)))), &blocks, |sound, text| {
            published.push((sound, text));
            true
        });
        let expected = [(5, "the"), (5, "the white"), (7, "the")];
        assert_eq!(published, expected.map(|(sound, text)| (sound, text.to_owned())));
    }
}
