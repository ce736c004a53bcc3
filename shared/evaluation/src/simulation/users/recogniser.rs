//! A recogniser that drops and confuses words.

use scene::Scene;
use vocabulary::Rng;

use super::Reply;
use crate::simulation::draw::{chance, one_of};

/// Words that replace others, besides the scene's own.
const FILLERS: [&str; 8] = ["the", "a", "uh", "it", "one", "and", "to", "ball"];
/// Weight of the first hypothesis, if the recogniser wavers between it and the words said.
const PREFERRED: f64 = 0.65;

/// A channel from words to words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Recogniser {
    /// Probability that a word is dropped.
    drop: f64,
    /// Probability that a word is replaced by another.
    confuse: f64,
}

impl Recogniser {
    /// Every word arrives.
    pub(super) const PERFECT: Self = Self { drop: 0.0, confuse: 0.0 };
    /// One word in thirty is lost or wrong: a near microphone.
    pub(super) const GOOD: Self = Self { drop: 0.015, confuse: 0.015 };
    /// One word in ten is lost or wrong: a far microphone.
    pub(super) const BAD: Self = Self { drop: 0.05, confuse: 0.05 };

    /// Returns the hypotheses for `text`. If words were confused, the second one is right.
    pub(super) fn hear(&self, text: &str, scene: &Scene, rng: &mut Rng) -> Reply {
        let mut heard: Vec<&str> = Vec::new();
        let mut confused = false;
        for word in text.split_whitespace() {
            if chance(rng, self.drop) {
                continue;
            }
            if chance(rng, self.confuse) {
                heard.extend(other(scene, rng));
                confused = true;
            } else {
                heard.push(word);
            }
        }
        if heard.is_empty() {
            return Reply::Silence;
        }
        let heard = heard.join(" ");
        if confused && heard != text {
            return Reply::Words(vec![(heard, PREFERRED), (text.to_owned(), 1.0 - PREFERRED)]);
        }
        Reply::Words(vec![(heard, 1.0)])
    }
}

/// A word of the scene or a filler.
fn other<'a>(scene: &'a Scene, rng: &mut Rng) -> Option<&'a str> {
    if chance(rng, 0.5) {
        one_of(rng, &FILLERS).copied()
    } else {
        one_of(rng, scene.words()).map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::testing::bowls;

    #[test]
    fn recogniser_drops_and_confuses_words_at_its_rates() {
        let scene = bowls();
        let (seed, n) = (23, 20_000);
        let mut rng = Rng::new(seed);
        let (mut silent, mut wavering) = (0, 0);
        for _ in 0..n {
            match Recogniser::BAD.hear("zebra", &scene, &mut rng) {
                Reply::Words(hypotheses) => {
                    let sum: f64 = hypotheses.iter().map(|(_, weight)| weight).sum();
                    assert!((sum - 1.0).abs() < 1e-12);
                    wavering += u32::from(hypotheses.len() > 1);
                }
                _ => silent += 1,
            }
        }
        let share = |count: u32| f64::from(count) / f64::from(n);
        assert!((share(silent) - 0.05).abs() < 0.008, "seed {seed}: {silent}");
        assert!((share(wavering) - 0.95 * 0.05).abs() < 0.008, "seed {seed}: {wavering}");
        assert_eq!(Recogniser::BAD.hear("", &scene, &mut rng), Reply::Silence);
    }
}
