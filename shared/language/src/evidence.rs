//! From what the rules propose and the judge states to weighted readings.
//!
//! The values of one noun phrase share their fate: asserted, denied as a group, or left out. Each reading is one such
//! choice for every phrase, weighed by the judge's probabilities.

use scene::{Intent, Reading, Reference, Response, WordId};

use crate::features::{Example, Features, MENTIONS_MAX, features};
use crate::judge::{FLOOR, Judge};
use crate::mentions::Polarity;
use crate::parsed::{ParsedUtterance, READINGS_MAX};
use crate::tagger::Tag;
use crate::token_class::classes;

/// Probability from which on what the judge states stands alone.
const SURE: f64 = 0.9;
/// All that can be said of a phrase.
const POLARITIES: [Polarity; 3] = [Polarity::Wanted, Polarity::Denied, Polarity::Neither];
/// Intents beside which a wish may stand: "is there a brass screw? I'd like it".
const OPEN: [Intent; 8] = [
    Intent::Inform,
    Intent::None,
    Intent::AskWhich,
    Intent::AskWhere,
    Intent::AskCount,
    Intent::AskWhether,
    Intent::PutBack,
    Intent::Chore,
];
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
    // Orders to a machine are nobody's wishes, whatever stands beside them, nor are foreign words that the rules leave.
    let is_left = best.intent == Intent::None;
    let is_foreign = |tag: &Tag<'_>| {
        tag.is_any(classes![Injection]) || is_left && tag.is_any(classes![OtherLanguage])
    };
    let is_elsewhere = parsed.code || parsed.tags.iter().any(is_foreign);
    if !OPEN.contains(&best.intent) || is_elsewhere {
        return vec![(1.0, best)];
    }
    let features = features(parsed, &best);
    if features.examples.is_empty() || features.examples.len() >= MENTIONS_MAX {
        return vec![(1.0, best)];
    }
    let phrases =
        phrases(&parsed.judge.unwrap_or_else(|| Judge::built_in()).stated(&features), features);
    let mut readings: Vec<(f64, Reading)> = Vec::new();
    let is_possible =
        |(weight, fate): &(f64, Vec<usize>)| *weight > 0.0 && !contradicts(&phrases, fate);
    for (weight, fate) in fates(&phrases).into_iter().filter(is_possible) {
        let reading = reading(parsed, &best, &phrases, &fate);
        // Doubts say how well words were heard: they tell no readings apart.
        match readings.iter_mut().find(|(_, known)| known.says_the_same(&reading)) {
            Some((known, _)) => *known += weight,
            None => readings.push((weight, reading)),
        }
    }
    if readings.is_empty() {
        return vec![(1.0, best)];
    }
    readings.sort_by(|a, b| b.0.total_cmp(&a.0));
    readings.truncate(READINGS_MAX);
    let all: f64 = readings.iter().map(|(weight, _)| weight).sum();
    readings.iter_mut().for_each(|(weight, _)| *weight /= all);
    readings
}

/// The phrases, each with what the judge states of its values together. A phrase of which the rules take a part back
/// ("the red wrench, I mean the black one") is two.
fn phrases(stated: &[[f64; 3]], features: Features) -> Vec<Phrase> {
    let mut phrases: Vec<Phrase> = Vec::new();
    for (example, stated) in features.examples.into_iter().zip(stated) {
        let is_its = |it: &&mut Phrase| {
            let first = &it.examples[0];
            (first.phrase, first.proposal) == (example.phrase, example.proposal)
        };
        match phrases.iter_mut().find(is_its) {
            Some(phrase) => {
                phrase.examples.push(example);
                phrase.stated.iter_mut().zip(stated).for_each(|(sum, stated)| *sum += stated);
            }
            None => phrases.push(Phrase { examples: vec![example], stated: *stated }),
        }
    }
    for phrase in &mut phrases {
        let count = phrase.examples.len() as f64;
        let [wanted, denied, neither] = phrase.stated.map(|sum| sum / count * (1.0 - FLOOR));
        phrase.stated = [wanted, denied, neither + FLOOR];
        let best = phrase.best();
        if phrase.stated[best] >= SURE {
            phrase.stated = [0.0; 3];
            phrase.stated[best] = 1.0;
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

/// Whether a phrase is denied all of whose words are wanted elsewhere: "the red mug, no wait, the red cup".
fn contradicts(phrases: &[Phrase], fate: &[usize]) -> bool {
    let of = |polarity: Polarity| {
        let has = move |it: &(&Phrase, &usize)| POLARITIES[*it.1] == polarity;
        phrases.iter().zip(fate).filter(has).map(|(phrase, _)| phrase)
    };
    let is_wanted = |word: WordId| {
        of(Polarity::Wanted).any(|phrase| phrase.examples.iter().any(|it| it.word == word))
    };
    of(Polarity::Denied).any(|phrase| phrase.examples.iter().all(|it| is_wanted(it.word)))
}

/// The reading in which the phrases have that fate: that of the rules, changed in the words of which they propose another.
fn reading(
    parsed: &ParsedUtterance<'_>,
    best: &Reading,
    phrases: &[Phrase],
    fate: &[usize],
) -> Reading {
    let differs =
        |(phrase, fate): &(&Phrase, &usize)| phrase.examples[0].proposal as usize != **fate;
    let changed: Vec<WordId> = phrases
        .iter()
        .zip(fate)
        .filter(differs)
        .flat_map(|(phrase, _)| phrase.examples.iter().map(|example| example.word))
        .collect();
    let mut reading = best.clone();
    // A question, an errand or talk is as the rules read it, if nothing in it is a wish.
    let is_wish = fate.iter().any(|fate| POLARITIES[*fate] != Polarity::Neither);
    if changed.is_empty() || best.intent != Intent::Inform && !is_wish {
        return reading;
    }
    if best.intent != Intent::Inform {
        reading = Reading { refers: best.refers, ..Reading::default() };
    }
    take_out(&mut reading, &changed);
    let concerned = |phrase: &Phrase| phrase.examples.iter().any(|it| changed.contains(&it.word));
    let doubt = |example: &Example| parsed.tags[example.at].word_doubt();
    for (phrase, fate) in phrases.iter().zip(fate).filter(|(phrase, _)| concerned(phrase)) {
        match POLARITIES[*fate] {
            Polarity::Wanted => {
                for example in &phrase.examples {
                    add(&mut reading.doubt.base, reading.base.len(), doubt(example));
                    reading.base.push(example.word);
                }
            }
            Polarity::Denied => {
                let doubt = phrase.examples.iter().map(doubt).fold(0.0, f64::max);
                add(&mut reading.doubt.excluded, reading.excluded.len(), doubt);
                reading.excluded.push(words(phrase));
            }
            Polarity::Neither => {}
        }
    }
    // An answer that stands in no value word stays.
    if parsed.content.answers.is_empty() {
        (reading.response, reading.doubt.response) = (Response::None, 0.0);
    }
    let says_something = !reading.base.is_empty()
        || !reading.excluded.is_empty()
        || reading.response != Response::None;
    if says_something {
        reading.intent = Intent::Inform;
    }
    reading
}

/// Takes words out of a reading, wherever they stand.
fn take_out(reading: &mut Reading, words: &[WordId]) {
    let (base, excluded) =
        (std::mem::take(&mut reading.base), std::mem::take(&mut reading.excluded));
    let doubt = std::mem::take(&mut reading.doubt);
    for (n, word) in base.into_iter().enumerate().filter(|(_, word)| !words.contains(word)) {
        add(&mut reading.doubt.base, reading.base.len(), doubt.of_word(n));
        reading.base.push(word);
    }
    for (n, mut group) in excluded.into_iter().enumerate() {
        group.retain(|word| !words.contains(word));
        if !group.is_empty() {
            add(&mut reading.doubt.excluded, reading.excluded.len(), doubt.of_group(n));
            reading.excluded.push(group);
        }
    }
    reading.doubt.response = doubt.response;
    if matches!(reading.refers, Reference::Relation(_)) {
        return;
    }
    reading.further.iter_mut().for_each(|group| group.retain(|word| !words.contains(word)));
    reading.further.retain(|group| !group.is_empty());
    if reading.base.is_empty() && !reading.further.is_empty() {
        reading.base = reading.further.remove(0);
    }
}

/// Notes the doubt of entry `at`; those at the end that are certain are left out.
fn add(doubts: &mut Vec<f64>, at: usize, doubt: f64) {
    if doubt > 0.0 {
        doubts.resize(at, 0.0);
        doubts.push(doubt);
    }
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
