//! Durations of speech: the robot's, the user's, and recognition.

use vocabulary::Rng;
use vocabulary::reaction::SPOKEN;

/// The robot's voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voice {
    /// Speed of the voice, as its program takes it.
    pub words_per_minute: f64,
}

/// Seconds of a sentence at [`REFERENCE_WPM`], whatever its length: onset and final fall.
const SENTENCE_S: f64 = 0.55;
/// Seconds per letter at [`REFERENCE_WPM`]. Letters predict the length of an English sentence
/// better than words.
const LETTER_S: f64 = 0.055;
/// The speed at which the two were measured.
const REFERENCE_WPM: f64 = 165.0;

impl Default for Voice {
    /// The speed of the configuration that comes with the program.
    fn default() -> Self {
        Self { words_per_minute: REFERENCE_WPM }
    }
}

impl Voice {
    /// Returns the seconds that the voice takes for `text`: a fit to espeak-ng's voice `en-us` on
    /// the questions of the bowls, with an error of at most a fifth.
    pub fn seconds(&self, text: &str) -> f64 {
        let letters = text.chars().filter(|c| c.is_alphanumeric()).count();
        if letters == 0 {
            return 0.0;
        }
        (SENTENCE_S + LETTER_S * letters as f64) * REFERENCE_WPM / self.words_per_minute
    }
}

/// Timing of users and of the recogniser.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Time from the end of a question to the answer's first sound: median, seconds, and standard
    /// deviation of the logarithm.
    pub reaction_s: (f64, f64),
    /// An answer of one word: median, seconds, and standard deviation of the logarithm.
    pub word_s: (f64, f64),
    /// Each further word, seconds.
    pub further_word_s: f64,
    /// Time from the last sound to the recognised words, seconds: least and most.
    pub recogniser_s: (f64, f64),
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            reaction_s: SPOKEN,
            word_s: (0.55, 0.35),
            further_word_s: 0.3,
            recogniser_s: (0.5, 1.5),
        }
    }
}

impl Pace {
    /// Draws how long it takes to react, seconds.
    pub fn reaction_s(&self, rng: &mut Rng) -> f64 {
        rng.log_normal(self.reaction_s.0, self.reaction_s.1)
    }

    /// Draws the time in which a person says a number of words, seconds.
    pub fn speech_s(&self, rng: &mut Rng, words: usize) -> f64 {
        let factor = rng.log_normal(1.0, self.word_s.1);
        factor * (self.word_s.0 + self.further_word_s * words.saturating_sub(1) as f64)
    }

    /// Draws how long the recogniser takes after the last sound, seconds.
    pub fn recogniser_s(&self, rng: &mut Rng) -> f64 {
        rng.between(self.recogniser_s)
    }

    /// Returns the expected time from a question's end to a recognised answer of one word, seconds.
    pub fn mean_answer_s(&self) -> f64 {
        let mean = |median: f64, log_sd: f64| median * (0.5 * log_sd * log_sd).exp();
        let (least, most) = self.recogniser_s;
        mean(self.reaction_s.0, self.reaction_s.1)
            + mean(self.word_s.0, self.word_s.1)
            + 0.5 * (least + most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seconds that espeak-ng 1.51 took at 165 words a minute.
    const MEASURED: [(&str, f64); 8] = [
        ("Is it white?", 1.01),
        ("Is it made of plastic?", 1.55),
        ("Is it in the dishwasher?", 1.42),
        ("Is it on the counter?", 1.31),
        ("What colour is it?", 1.22),
        ("This one?", 0.90),
        ("I will get the small bowl on the counter.", 2.37),
        ("I will get the small white bowl in the dishwasher.", 2.80),
    ];

    #[test]
    fn speech_duration_is_near_the_measured_one() {
        let voice = Voice::default();
        for (text, seconds) in MEASURED {
            let found = voice.seconds(text);
            assert!((found / seconds - 1.0).abs() < 0.15, "{text}: {found} not {seconds}");
        }
        let fast = Voice { words_per_minute: 330.0 };
        assert_eq!(fast.seconds("Is it white?"), 0.5 * voice.seconds("Is it white?"));
        assert_eq!(voice.seconds("…!"), 0.0);
    }

    #[test]
    fn drawn_durations_average_to_the_expectation() {
        let seed = 5;
        let (pace, mut rng) = (Pace::default(), Rng::new(seed));
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|_| {
                pace.reaction_s(&mut rng) + pace.speech_s(&mut rng, 1) + pace.recogniser_s(&mut rng)
            })
            .sum();
        let mean = sum / f64::from(n);
        assert!((mean - pace.mean_answer_s()).abs() < 0.03, "seed {seed}: {mean}");
    }
}
