//! One clip's outcome, and shares over many.

use super::corpus::{Clip, Sentence};
use super::listener::Heard;
use super::meaning::{Meaning, edits, likeliest, meaning, said_too, weightiest};
use ::speech::Hypothesis;
use ::speech::devices::audio::seconds;
use ::speech::devices::language_model::words;
use dialogue::{Model, Params};
use language::{Language, Reader};
use scene::{Scene, WordId};

/// Readers and models of a scene.
pub(super) struct Judge {
    reader: Reader,
    spotter: Reader,
    model: Model,
}

/// Score of a clip.
#[derive(Clone, Debug, Default)]
pub(super) struct Score {
    pub(super) for_the_robot: bool,
    /// Scene words that were said, and the edits from them to those of the best hypothesis.
    pub(super) words: usize,
    pub(super) word_errors: usize,
    /// True if the meaning is right: of the best hypothesis, of the weightiest meaning of all, of
    /// any of them; each with the gate open.
    pub(super) best: bool,
    pub(super) weighed: bool,
    pub(super) oracle: bool,
    /// True if values and answer of the weightiest meaning are right by word spotting.
    pub(super) spotted: bool,
    /// True if the gate let all of it pass and the weightiest meaning is right.
    pub(super) passed: bool,
    /// True if the robot acts on a misrecognised utterance.
    pub(super) wrong_action: bool,
    pub(super) acted_on: bool,
    /// True if the likeliest objects are those after the true text.
    pub(super) objects: bool,
    /// Seconds from the voice's end to the hypotheses without the closing pause, and of processor
    /// to decode.
    pub(super) delay_s: f64,
    pub(super) cpu_s: f64,
    /// Seconds of sound.
    pub(super) sound_s: f64,
    /// Seconds by which the detector is late.
    pub(super) onset_s: f64,
    pub(super) release_s: f64,
    /// Stretches taken for speech.
    pub(super) stretches: usize,
    /// Of each word of the best hypothesis how sure it is, and whether it was said.
    pub(super) sure: Vec<(f32, bool)>,
}

impl Judge {
    pub(super) fn new(scene: &Scene) -> Self {
        Self {
            reader: Reader::new(scene, Language::Careful),
            spotter: Reader::new(scene, Language::Paper),
            model: Model::new(scene, Params::default()),
        }
    }

    pub(super) fn score(
        &self,
        sentence: &Sentence,
        clip: &Clip,
        heard: &[Heard],
        pause_s: f64,
    ) -> Score {
        let reader = &self.reader;
        let truth = meaning(reader, sentence, &sentence.text);
        let all = together(heard.iter());
        let passed = together(heard.iter().filter(|heard| heard.accepted));
        let accepted = heard.iter().any(|heard| heard.accepted);
        let right = |text: &str| meaning(reader, sentence, text) == truth;
        let best = all.first().map_or("", |h| h.text.as_str());
        let (weighed, _) = weightiest(reader, sentence, &all);
        let (acted, _) = weightiest(reader, sentence, &passed);
        let values = |text: &str| spotted(&self.spotter, sentence, text);
        let said = self.scene_words(sentence, &sentence.text);
        let objects = |heard: &[(f64, &str)]| likeliest(&self.model, reader, sentence, heard);
        let evidence: Vec<(f64, &str)> =
            passed.iter().map(|h| (h.weight, h.text.as_str())).collect();
        let timing = Timing::of(clip, heard, pause_s);
        Score {
            for_the_robot: sentence.for_the_robot,
            words: said.len(),
            word_errors: edits(&said, &self.scene_words(sentence, best)),
            best: right(best),
            weighed: weighed == truth,
            oracle: right("") || all.iter().any(|h| right(&h.text)),
            spotted: values(best) == values(&sentence.text),
            passed: accepted && acted == truth,
            wrong_action: acted.is_acted_on() && acted != truth,
            acted_on: acted.is_acted_on(),
            objects: objects(&evidence) == objects(&[(1.0, &sentence.text)]),
            delay_s: timing.delay_s,
            cpu_s: heard.iter().map(|heard| heard.took_s.1).sum(),
            sound_s: seconds(clip.samples.len()),
            onset_s: timing.onset_s,
            release_s: timing.release_s,
            stretches: heard.len(),
            sure: all.first().map(|best| sure(best, &sentence.text)).unwrap_or_default(),
        }
    }

    /// The scene's words in the order of the text, a synonym as its value.
    fn scene_words(&self, sentence: &Sentence, text: &str) -> Vec<WordId> {
        self.spotter.read(text, sentence.question).base
    }
}

fn sure(best: &Hypothesis, said: &str) -> Vec<(f32, bool)> {
    let heard: Vec<&str> = best.text.split_whitespace().collect();
    let said = words(said);
    let said: Vec<&str> = said.iter().map(String::as_str).collect();
    let right = said_too(&heard, &said);
    best.word_confidence.iter().copied().zip(right).collect()
}

fn spotted(
    spotter: &Reader,
    sentence: &Sentence,
    text: &str,
) -> (std::collections::BTreeSet<WordId>, u8) {
    Meaning::of(&spotter.read(text, sentence.question)).values()
}

/// The hypotheses of stretches that follow each other, as those of one utterance.
fn together<'h>(heard: impl Iterator<Item = &'h Heard>) -> Vec<Hypothesis> {
    let mut all: Vec<Hypothesis> = Vec::new();
    for heard in heard {
        let before = std::mem::take(&mut all);
        if before.is_empty() {
            all = heard.hypotheses.clone();
            continue;
        }
        for (first, second) in
            before.iter().flat_map(|a| heard.hypotheses.iter().map(move |b| (a, b)))
        {
            all.push(Hypothesis {
                text: format!("{} {}", first.text, second.text),
                weight: first.weight * second.weight,
                word_confidence: [&first.word_confidence[..], &second.word_confidence].concat(),
            });
        }
    }
    all.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    all
}

/// Latencies of the detector and the hypotheses, seconds; NaN if nothing was recognised.
struct Timing {
    onset_s: f64,
    release_s: f64,
    delay_s: f64,
}

impl Timing {
    fn of(clip: &Clip, heard: &[Heard], pause_s: f64) -> Self {
        let late = |found: usize, edge: usize| seconds(found) - seconds(edge);
        let (Some(first), Some(last)) = (heard.first(), heard.last()) else {
            return Self { onset_s: f64::NAN, release_s: f64::NAN, delay_s: f64::NAN };
        };
        // Decoding continues during the pause; the result arrives at the pause's end at the earliest.
        let release_s = late(last.speech.end, clip.speech.end);
        let decoded_s = late(last.decoded_at, clip.speech.end) + last.took_s.0;
        Self {
            onset_s: late(first.speech.start, clip.speech.start),
            release_s,
            delay_s: release_s.max(decoded_s - pause_s),
        }
    }
}
