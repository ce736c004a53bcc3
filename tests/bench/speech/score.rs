//! One clip's outcome: the intended meaning beside the understood one, and the latencies.

use super::corpus::{Clip, Sentence};
use super::listener::{Heard, THRESHOLDS};
use ::speech::Hypothesis;
use ::speech_engines::audio::seconds;
use ::speech_engines::language_model::words;
use language::Reader;
use scene::{Intent, Reading, Response, WordId};
use std::collections::BTreeSet;

/// Score of a clip.
#[derive(Clone, Debug, Default)]
pub(super) struct Score {
    pub(super) for_the_robot: bool,
    /// True if the meaning is right: of the best hypothesis, of the weightiest meaning of all, of
    /// any of them; each with the gate open.
    pub(super) best: bool,
    pub(super) weighed: bool,
    pub(super) oracle: bool,
    /// What the robot does at each threshold of the gate.
    pub(super) gated: [Gated; THRESHOLDS.len()],
    /// Share of the weightiest meaning.
    pub(super) meaning_share: f32,
    /// Seconds from the voice's end to the hypotheses without the closing pause, and of processor
    /// to decode.
    pub(super) delay_s: f64,
    pub(super) cpu_s: f64,
    /// Seconds from the beginning of decoding to the hypotheses.
    pub(super) wall_s: f64,
    /// True if the second recogniser was asked, and if it had no opinion.
    pub(super) asked: bool,
    pub(super) without_opinion: bool,
    /// Seconds of sound.
    pub(super) sound_s: f64,
    /// Seconds by which the detector is late.
    pub(super) onset_s: f64,
    pub(super) release_s: f64,
    /// Of each word of the best hypothesis how sure it is, and whether it was said.
    pub(super) sure: Vec<(f32, bool)>,
}

/// What the robot does behind the gate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gated {
    /// True if the gate let it pass and the weightiest meaning is right.
    pub(super) passed: bool,
    /// True if the robot acts on a misrecognised utterance.
    pub(super) wrong_action: bool,
    pub(super) acted_on: bool,
}

impl Score {
    /// What the robot does at the threshold in use.
    pub(super) fn gated(&self) -> Gated {
        self.gated[0]
    }

    pub(super) fn of(
        reader: &Reader,
        sentence: &Sentence,
        clip: &Clip,
        heard: &[Heard],
        pause_s: f64,
    ) -> Self {
        let truth = meaning(reader, sentence, &sentence.text);
        let all = together(heard.iter());
        let gated = std::array::from_fn(|n| {
            let passed = together(heard.iter().filter(|heard| heard.accepted[n]));
            let (acted, _) = weightiest(reader, sentence, &passed);
            let acted_on = acted != Meaning::default();
            Gated {
                passed: !passed.is_empty() && acted == truth,
                wrong_action: acted_on && acted != truth,
                acted_on,
            }
        });
        let right = |text: &str| meaning(reader, sentence, text) == truth;
        let best = all.first().map_or("", |h| h.text.as_str());
        let (weighed, meaning_share) = weightiest(reader, sentence, &all);
        let timing = Timing::of(clip, heard, pause_s);
        Self {
            for_the_robot: sentence.for_the_robot,
            best: right(best),
            weighed: weighed == truth,
            oracle: right("") || all.iter().any(|h| right(&h.text)),
            gated,
            meaning_share: meaning_share as f32,
            delay_s: timing.delay_s,
            cpu_s: heard.iter().map(|heard| heard.took_s.1).sum(),
            wall_s: heard.iter().map(|heard| heard.took_s.0).sum(),
            asked: heard.iter().any(|heard| heard.asked),
            without_opinion: heard.iter().any(|heard| heard.late),
            sound_s: seconds(clip.samples.len()),
            onset_s: timing.onset_s,
            release_s: timing.release_s,
            sure: all.first().map(|best| sure(best, &sentence.text)).unwrap_or_default(),
        }
    }
}

fn sure(best: &Hypothesis, said: &str) -> Vec<(f32, bool)> {
    let heard: Vec<&str> = best.text.split_whitespace().collect();
    let said = words(said);
    let said: Vec<&str> = said.iter().map(String::as_str).collect();
    let right = said_too(&heard, &said);
    best.word_confidence.iter().copied().zip(right).collect()
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

/// The meaning of an utterance, as far as it affects the robot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Meaning {
    base: BTreeSet<WordId>,
    excluded: BTreeSet<BTreeSet<WordId>>,
    answer: Response,
    /// The robot's task; a statement is none.
    order: Intent,
}

fn meaning(reader: &Reader, sentence: &Sentence, text: &str) -> Meaning {
    let Reading { base, excluded, response, intent, .. } = reader.read(text, sentence.question);
    Meaning {
        base: base.into_iter().collect(),
        excluded: excluded.into_iter().map(BTreeSet::from_iter).collect(),
        answer: response,
        order: if intent == Intent::None { Intent::Inform } else { intent },
    }
}

/// Whether the robot reacts to a sentence that is heard as it was said.
pub(super) fn has_content(reader: &Reader, said: &Sentence) -> bool {
    meaning(reader, said, &said.text) != Meaning::default()
}

/// Whether the robot reacts to what it heard and accepted.
pub(super) fn is_acted_on(reader: &Reader, sentence: &Sentence, heard: &[Heard]) -> bool {
    let passed = together(heard.iter().filter(|heard| heard.accepted[0]));
    weightiest(reader, sentence, &passed).0 != Meaning::default()
}

/// The meaning with the largest sum of weights, and its share. The earlier hypothesis decides a tie.
fn weightiest(reader: &Reader, sentence: &Sentence, heard: &[Hypothesis]) -> (Meaning, f64) {
    let mut sums: Vec<(Meaning, f64)> = Vec::new();
    for hypothesis in heard {
        let meant = meaning(reader, sentence, &hypothesis.text);
        match sums.iter_mut().find(|(known, _)| *known == meant) {
            Some((_, sum)) => *sum += hypothesis.weight,
            None => sums.push((meant, hypothesis.weight)),
        }
    }
    let total: f64 = sums.iter().map(|(_, sum)| sum).sum();
    // The last of equals is the maximum.
    let best = sums.into_iter().rev().max_by(|(_, a), (_, b)| a.total_cmp(b));
    best.map(|(meant, sum)| (meant, sum / total)).unwrap_or_default()
}

/// Marks the words of `heard` that were said: those of the longest sequence of words that both texts
/// have in common.
fn said_too(heard: &[&str], said: &[&str]) -> Vec<bool> {
    let width = said.len() + 1;
    let mut common = vec![0_usize; (heard.len() + 1) * width];
    for (i, j) in (0..heard.len()).rev().flat_map(|i| (0..said.len()).rev().map(move |j| (i, j))) {
        common[i * width + j] = match heard[i] == said[j] {
            true => common[(i + 1) * width + j + 1] + 1,
            false => common[(i + 1) * width + j].max(common[i * width + j + 1]),
        };
    }
    let (mut i, mut j) = (0, 0);
    let mut right = vec![false; heard.len()];
    while i < heard.len() && j < said.len() {
        if heard[i] == said[j] {
            right[i] = true;
            (i, j) = (i + 1, j + 1);
        } else if common[(i + 1) * width + j] >= common[i * width + j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    right
}
