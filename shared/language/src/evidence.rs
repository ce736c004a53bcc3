//! From what the rules propose and the judge states to weighted readings.
//!
//! The values of one noun phrase share their fate: asserted, denied as a group, or left out. Each reading is one such
//! choice for every phrase, weighed by the judge's probabilities.

use scene::{Intent, Reading, Reference, Response, WordId};

use crate::features::{Example, MENTIONS_MAX, examples};
use crate::judge::judge;
use crate::mentions::Polarity;
use crate::parsed::{ParsedUtterance, READINGS_MAX};
use crate::tagger::Tag;
use crate::token_class::classes;

/// All that can be said of a phrase.
const POLARITIES: [Polarity; 3] = [Polarity::Wanted, Polarity::Denied, Polarity::Neither];
/// Probability from which on what the rules propose stands as they read it, judged: a lower one costs wrong fetches, a
/// higher one questions that ordinary requests do not need (`tests/talk`).
const SURE: f64 = 0.9;
/// Most phrases whose fate is open; that of the others, the surest, is their most probable one.
const OPEN_MAX: usize = 3;

/// A noun phrase with values.
struct Phrase {
    examples: Vec<Example>,
    stated: [f64; 3],
}

impl Phrase {
    fn best(&self) -> usize {
        (0..3).max_by(|a, b| self.stated[*a].total_cmp(&self.stated[*b])).unwrap_or(0)
    }
}

/// Returns the readings of an utterance whose values the rules read as `best`, each with its weight, best first.
pub(crate) fn weighed(parsed: &ParsedUtterance<'_>, best: Reading) -> Vec<(f64, Reading)> {
    let is_description = matches!(best.intent, Intent::Inform | Intent::None);
    // Orders to a machine and foreign words are nobody's wishes, whatever stands beside them.
    let is_foreign = |tag: &Tag<'_>| tag.is_any(classes![Injection OtherLanguage]);
    let is_elsewhere = parsed.code || parsed.tags.iter().any(is_foreign);
    // "the other one" says more than the words beside it.
    let is_open = is_description && best.refers == Reference::None && !parsed.content.alternatives;
    if !is_open || is_elsewhere {
        return vec![(1.0, best)];
    }
    let examples = examples(parsed, &best);
    if examples.is_empty() || examples.len() >= MENTIONS_MAX {
        return vec![(1.0, best)];
    }
    let phrases = phrases(examples);
    let mut readings: Vec<(f64, Reading)> = Vec::new();
    for (weight, fate) in fates(&phrases).into_iter().filter(|(weight, _)| *weight > 0.0) {
        let reading = reading(parsed, &best, &phrases, &fate);
        // Doubts say how well words were heard: they tell no readings apart.
        match readings.iter_mut().find(|(_, known)| known.says_the_same(&reading)) {
            Some((known, _)) => *known += weight,
            None => readings.push((weight, reading)),
        }
    }
    readings.sort_by(|a, b| b.0.total_cmp(&a.0));
    readings.truncate(READINGS_MAX);
    let all: f64 = readings.iter().map(|(weight, _)| weight).sum();
    readings.iter_mut().for_each(|(weight, _)| *weight /= all);
    readings
}

/// The phrases, each with what the judge states of its values together. A phrase of which the rules take a part back
/// ("the red wrench, I mean the black one") is two.
fn phrases(examples: Vec<Example>) -> Vec<Phrase> {
    let mut phrases: Vec<Phrase> = Vec::new();
    for example in examples {
        let is_its = |it: &&mut Phrase| {
            let first = &it.examples[0];
            (first.phrase, first.proposal) == (example.phrase, example.proposal)
        };
        match phrases.iter_mut().find(is_its) {
            Some(phrase) => phrase.examples.push(example),
            None => phrases.push(Phrase { examples: vec![example], stated: [0.0; 3] }),
        }
    }
    for phrase in &mut phrases {
        let mut logs = [0.0; 3];
        for example in &phrase.examples {
            let stated = judge(&example.rows);
            logs.iter_mut().zip(stated).for_each(|(log, stated)| *log += stated.max(1e-6).ln());
        }
        let means = logs.map(|log| (log / phrase.examples.len() as f64).exp());
        let all: f64 = means.iter().sum();
        phrase.stated = means.map(|mean| mean / all);
        let proposed = phrase.examples[0].proposal as usize;
        if phrase.stated[proposed] >= SURE {
            phrase.stated = [0.0; 3];
            phrase.stated[proposed] = 1.0;
        }
    }
    phrases
}

/// Every choice of a polarity for each phrase, with its probability.
fn fates(phrases: &[Phrase]) -> Vec<(f64, Vec<usize>)> {
    let mut unsure: Vec<usize> = (0..phrases.len()).collect();
    let sure = |n: &usize| phrases[*n].stated[phrases[*n].best()];
    unsure.sort_by(|a, b| sure(a).total_cmp(&sure(b)));
    unsure.truncate(OPEN_MAX);
    let mut fates = vec![(1.0, Vec::new())];
    for (n, phrase) in phrases.iter().enumerate() {
        let open: Vec<usize> = match unsure.contains(&n) {
            true => vec![0, 1, 2],
            false => vec![phrase.best()],
        };
        let extended = |(weight, fate): &(f64, Vec<usize>)| {
            let extend = |polarity: &usize| {
                let fate = fate.iter().copied().chain([*polarity]).collect();
                (weight * phrase.stated[*polarity], fate)
            };
            open.iter().map(extend).collect::<Vec<_>>()
        };
        fates = fates.iter().flat_map(extended).collect();
    }
    fates
}

/// The reading in which the phrases have that fate: that of the rules where they propose it.
fn reading(
    parsed: &ParsedUtterance<'_>,
    best: &Reading,
    phrases: &[Phrase],
    fate: &[usize],
) -> Reading {
    let of = |n: usize| POLARITIES[fate[n]];
    let mut examples = phrases
        .iter()
        .enumerate()
        .flat_map(|(n, it)| it.examples.iter().map(move |example| (of(n), example)));
    if examples.all(|(fate, example)| fate == example.proposal) {
        return best.clone();
    }
    let fated = |polarity: Polarity| {
        phrases.iter().enumerate().filter(move |(n, _)| of(*n) == polarity).map(|(_, it)| it)
    };
    let doubt = |example: &Example| parsed.tags[example.at].word_doubt();
    let base: Vec<&Example> = fated(Polarity::Wanted).flat_map(|it| &it.examples).collect();
    let excluded: Vec<&Phrase> = fated(Polarity::Denied).collect();
    let mut reading = Reading {
        base: base.iter().map(|example| example.word).collect(),
        excluded: excluded.iter().map(|phrase| words(phrase)).collect(),
        refers: best.refers,
        intent: best.intent,
        ..Reading::default()
    };
    // An answer that stands in no value word stays.
    if !parsed.content.answers.is_empty() {
        (reading.response, reading.doubt.response) = (best.response, best.doubt.response);
    }
    let says_something = !reading.base.is_empty()
        || !reading.excluded.is_empty()
        || reading.response != Response::None;
    reading.intent = if says_something { Intent::Inform } else { best.intent };
    reading.doubt.base = base.iter().map(|example| doubt(example)).collect();
    let group = |phrase: &&Phrase| phrase.examples.iter().map(doubt).fold(0.0, f64::max);
    reading.doubt.excluded = excluded.iter().map(group).collect();
    for doubts in [&mut reading.doubt.base, &mut reading.doubt.excluded] {
        while doubts.last() == Some(&0.0) {
            doubts.pop();
        }
    }
    reading
}

/// The words of a phrase, each once.
fn words(phrase: &Phrase) -> Vec<WordId> {
    let mut words = Vec::new();
    for example in &phrase.examples {
        if !words.contains(&example.word) {
            words.push(example.word);
        }
    }
    words
}
