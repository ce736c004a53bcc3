//! Random draws, and how the randomness of a study is divided.

use vocabulary::Rng;

/// Purpose of a stream of random numbers. Each has its own, so that one more utterance of a user
/// does not change any duration.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stream {
    /// The user's goal, traits and utterances.
    Person = 1,
    /// Durations.
    Clock = 2,
    /// Dialogues in real time.
    Turns = 3,
    /// Wishes of a person, from one dialogue to the next.
    Wishes = 4,
}

/// The random numbers of interaction `number`, the same for every policy.
pub(crate) fn stream(seed: u64, stream: Stream, number: u64) -> Rng {
    // Three steps of the generator's own mixing: neighbouring numbers give unrelated streams.
    let a = Rng::new(seed).next_u64();
    let b = Rng::new(a ^ stream as u64).next_u64();
    Rng::new(Rng::new(b ^ number).next_u64())
}

/// Returns true with the given probability.
pub(crate) fn chance(rng: &mut Rng, probability: f64) -> bool {
    rng.uniform() < probability
}

/// One of several, each as likely; `None` of nothing.
pub(crate) fn one_of<'a, T>(rng: &mut Rng, list: &'a [T]) -> Option<&'a T> {
    if list.is_empty() { None } else { list.get(rng.below(list.len())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_and_repeat() {
        let first = |seed, kind, number| stream(seed, kind, number).next_u64();
        let mut all = std::collections::HashSet::new();
        for number in 0..100 {
            for kind in [Stream::Person, Stream::Clock, Stream::Turns, Stream::Wishes] {
                assert!(all.insert(first(1, kind, number)));
                assert_eq!(first(1, kind, number), first(1, kind, number));
            }
        }
        assert_ne!(first(1, Stream::Person, 0), first(2, Stream::Person, 0));
    }

    #[test]
    fn draw_from_an_empty_slice_is_none() {
        let mut rng = Rng::new(3);
        assert_eq!(one_of::<u8>(&mut rng, &[]), None);
        assert_eq!(one_of(&mut rng, &[5]), Some(&5));
        assert!(!chance(&mut rng, 0.0) && chance(&mut rng, 1.0));
    }
}
