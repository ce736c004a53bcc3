//! A recogniser that drops words and takes some for others.

use dialogue::Rng;
use scene::Scene;

use super::Said;
use crate::simulation::draw::{chance, one_of};

/// Words that are heard where others were said, besides the scene's own.
const FILLERS: [&str; 8] = ["the", "a", "uh", "it", "one", "and", "to", "ball"];
/// Probability that it gives to the words that it prefers, where it wavers between them and those
/// that were said.
const PREFERRED: f64 = 0.65;

/// A channel from words to words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recogniser<'a> {
    scene: &'a Scene,
    /// Probability that a word is dropped.
    drop: f64,
    /// Probability that a word is taken for another.
    confuse: f64,
}

impl<'a> Recogniser<'a> {
    /// One word in ten is lost or wrong: a far microphone.
    pub(super) fn bad(scene: &'a Scene) -> Self {
        Self { scene, drop: 0.05, confuse: 0.05 }
    }

    /// One word in thirty is lost or wrong: a near microphone.
    pub(super) fn good(scene: &'a Scene) -> Self {
        Self { scene, drop: 0.015, confuse: 0.015 }
    }

    /// What is recognised. Where words were confused, what was said is the second hypothesis.
    pub(super) fn hear(&self, text: &str, rng: &mut Rng) -> Said {
        let mut heard: Vec<&str> = Vec::new();
        let mut confused = false;
        for word in text.split_whitespace() {
            if chance(rng, self.drop) {
                continue;
            }
            if chance(rng, self.confuse) {
                heard.extend(self.other(rng));
                confused = true;
            } else {
                heard.push(word);
            }
        }
        if heard.is_empty() {
            return Said::Nothing;
        }
        let heard = heard.join(" ");
        if confused && heard != text {
            return Said::Words(vec![(heard, PREFERRED), (text.to_owned(), 1.0 - PREFERRED)]);
        }
        Said::Words(vec![(heard, 1.0)])
    }

    /// A word that somebody else might have said.
    fn other(&self, rng: &mut Rng) -> Option<&'a str> {
        if chance(rng, 0.5) {
            one_of(rng, &FILLERS).copied()
        } else {
            one_of(rng, self.scene.words()).map(String::as_str)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::testing::bowls;

    #[test]
    fn words_are_dropped_and_confused_as_often_as_said() {
        let scene = bowls();
        let (seed, n) = (23, 20_000);
        let mut rng = Rng::new(seed);
        let recogniser = Recogniser::bad(&scene);
        let (mut silent, mut wavering) = (0, 0);
        for _ in 0..n {
            match recogniser.hear("zebra", &mut rng) {
                Said::Words(hypotheses) => {
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
        assert_eq!(recogniser.hear("", &mut rng), Said::Nothing);
    }
}
