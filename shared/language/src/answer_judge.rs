//! The judge of answers: how probable each answer to a question of yes or no is, by the words and by what the rules
//! propose.
//!
//! A linear model over hashed features, trained by `reader_training` on answers of people (`training/answers/`).

use std::sync::LazyLock;

use scene::{Intent, Reading, Reference, Response};

use crate::features::{Element, hash, mix, sort, text};
use crate::judge::softmax;
use crate::parsed::ParsedUtterance;
use crate::question_words::QuestionWords;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// The weights, as `reader_training` writes them: a hash of the inputs, a scale, and the weights of the answers by row.
const FILE: &[u8] = include_bytes!("vocabulary/answer_judge.bin");
/// Length of the hash, bytes.
const HASH: usize = 8;
/// Number of rows of weights.
pub const ANSWER_ROWS: usize = 1 << 15;
/// The answers that are judged, by number.
pub const ANSWERS: [Response; 5] =
    [Response::Yes, Response::No, Response::CannotTell, Response::DoesNotMatter, Response::None];
/// From this probability on, an answer stands alone, and what is missing is its doubt.
const SURE: f64 = 0.75;
/// From this probability on, so does the one that a value implies, without a doubt.
const SURE_OF_VALUE: f64 = 0.5;
/// From this probability on, it is beyond doubt.
const CERTAIN: f64 = 0.9;
/// Less probable answers are left out.
const LEAST: f64 = 0.05;
/// Most elements that are looked at.
const FAR: usize = 32;
/// Longest utterance that is known as a whole, elements.
const WHOLE: usize = 5;

static BUILT_IN: LazyLock<AnswerJudge> = LazyLock::new(|| {
    AnswerJudge::from_bytes(FILE).expect("vocabulary/answer_judge.bin has all weights")
});

/// Weights of the features.
#[derive(Clone, Debug)]
pub struct AnswerJudge {
    scale: f64,
    weights: Vec<[i8; 5]>,
}

impl AnswerJudge {
    /// Reads the weights as `reader_training` writes them; `None` if there are too few.
    pub fn from_bytes(file: &[u8]) -> Option<Self> {
        let (scale, rows) = file.get(HASH..)?.split_first_chunk()?;
        let row = |row: &[u8; 5]| row.map(|byte| byte as i8);
        let weights = rows.get(..5 * ANSWER_ROWS)?.as_chunks().0.iter().map(row).collect();
        Some(Self { scale: f64::from(f32::from_le_bytes(*scale)), weights })
    }

    /// The judge whose weights are part of the program.
    pub(crate) fn built_in() -> &'static Self {
        &BUILT_IN
    }

    /// Returns the probability of each of [`ANSWERS`].
    pub fn stated(&self, rows: &[u32]) -> [f64; 5] {
        // Sums of whole numbers: they do not depend on the order.
        let mut sums = [0_i64; 5];
        for row in rows {
            let weights = self.weights[*row as usize];
            sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += i64::from(weight));
        }
        softmax(sums.map(|sum| sum as f64 * self.scale))
    }

    /// Returns the readings that a reading of the rules becomes: with the answers that are probable, each with its
    /// share.
    pub(crate) fn judged(
        &self,
        parsed: &ParsedUtterance<'_>,
        reading: Reading,
    ) -> Vec<(f64, Reading)> {
        let Some(rows) = features(parsed, &reading) else { return vec![(1.0, reading)] };
        let stated = self.stated(&rows);
        let best = (0..ANSWERS.len()).max_by(|a, b| stated[*a].total_cmp(&stated[*b]));
        let best = best.unwrap_or(0);
        // A value has a judge of its own.
        let is_implied = parsed.content.answers.is_empty() && !reading.base.is_empty();
        let is_agreed = ANSWERS[best] == reading.response && stated[best] >= SURE_OF_VALUE;
        if is_implied && is_agreed {
            return vec![(1.0, reading)];
        } else if stated[best] >= SURE {
            return vec![(1.0, answered(&reading, best, stated[best]))];
        }
        let probable = (0..ANSWERS.len()).filter(|n| stated[*n] >= LEAST);
        probable.map(|n| (stated[n], answered(&reading, n, 1.0))).collect()
    }
}

/// The reading with another answer. A hedge and the judge doubt the same thing.
fn answered(reading: &Reading, answer: usize, probability: f64) -> Reading {
    let mut answered = Reading { response: ANSWERS[answer], ..reading.clone() };
    let judged = if probability < CERTAIN { 1.0 - probability } else { 0.0 };
    answered.doubt.response = match answered.response {
        Response::None => 0.0,
        response if response == reading.response => reading.doubt.response.max(judged),
        _ => judged,
    };
    if answered.response != Response::None {
        answered.intent = Intent::Inform;
    }
    answered
}

/// A mere yes or no needs no judge, nor a denied value; requests, commands and questions are no answers.
fn may_be_judged(parsed: &ParsedUtterance<'_>, reading: &Reading) -> bool {
    let tags = &parsed.tags;
    let only = |class: Class| tags.iter().all(|tag| tag.is(class) || tag.is(Class::Filler));
    let is_new = reading.response == Response::None
        && parsed.clauses.iter().any(|clause| clause.requests)
        && tags.iter().any(|tag| tag.is_any(classes![Fetch Want]))
        && !tags.iter().any(|tag| tag.is_any(classes![Not Be]));
    let denies = reading.excluded.iter().any(|group| parsed.asked.is_denied_by(group));
    let is_denied = denies == (reading.response == Response::No)
        && (denies || reading.base.is_empty() && !reading.excluded.is_empty());
    !parsed.code
        && matches!(reading.intent, Intent::Inform | Intent::None)
        && reading.refers == Reference::None
        && !tags.iter().all(|tag| tag.is_unknown() || tag.is_any(classes![Filler PutBack]))
        && !(only(Class::Yes) || only(Class::No) || is_new || is_denied)
}

/// Returns the features of a reading's words, each a row of weights; `None` if it is not judged.
pub(crate) fn features(parsed: &ParsedUtterance<'_>, reading: &Reading) -> Option<Vec<u32>> {
    let question = match parsed.asked {
        QuestionWords::Value(..) => 0,
        QuestionWords::Object(_) | QuestionWords::PerceivedObject => 1,
        _ => return None,
    };
    may_be_judged(parsed, reading).then_some(())?;
    let proposal = if reading.intent == Intent::None { 5 } else { reading.response as u64 };
    Some(rows(&elements(&parsed.tags, parsed.asked), question, proposal))
}

fn rows(said: &[Said], question: u64, proposal: u64) -> Vec<u32> {
    let (mut rows, count) = (Rows(Vec::new()), said.len() as u64);
    rows.add(b"proposal", &[proposal]);
    rows.add(b"question", &[question, proposal]);
    rows.add(b"count", &[count.min(8), proposal]);
    if said.len() <= WHOLE {
        let all = |part: fn(&Said) -> u64| said.iter().fold(count, |all, it| mix(all, part(it)));
        rows.add(b"texts", &[all(|it| it.text)]);
        rows.add(b"sorts", &[all(|it| it.sort)]);
        rows.add(b"sorts of", &[question, proposal, all(|it| it.sort)]);
    }
    let at = |n: usize| said.get(n).copied().unwrap_or(Said::END);
    let last = |n: usize| said.len().checked_sub(n + 1).map_or(Said::END, at);
    for (side, ends) in [[at(0), at(1), at(2)], [last(0), last(1), last(2)]].iter().enumerate() {
        let [one, two, three] = ends;
        rows.add(b"end", &[side as u64, one.text]);
        rows.add(b"end sort", &[side as u64, one.sort, proposal]);
        rows.add(b"end two", &[side as u64, one.text, two.text]);
        rows.add(b"end two sorts", &[side as u64, one.sort, two.sort]);
        rows.add(b"end three", &[side as u64, one.sort, two.sort, three.sort]);
    }
    for n in 0..said.len() {
        let [one, two, three] = [at(n), at(n + 1), at(n + 2)];
        rows.add(b"text", &[one.text]);
        rows.add(b"text of", &[one.text, proposal]);
        rows.add(b"text in", &[one.text, question]);
        rows.add(b"sort", &[one.sort]);
        rows.add(b"sort of", &[one.sort, proposal, question]);
        rows.add(b"two", &[one.text, two.text]);
        rows.add(b"two sorts", &[one.sort, two.sort]);
        rows.add(b"two mixed", &[one.text, two.sort]);
        rows.add(b"mixed two", &[one.sort, two.text]);
        rows.add(b"apart", &[one.text, three.text]);
        rows.add(b"three", &[one.text, two.text, three.text]);
        rows.add(b"three sorts", &[one.sort, two.sort, three.sort]);
    }
    rows.0
}

/// A word as the judge sees it: itself, and its group of like words or its class.
#[derive(Clone, Copy)]
struct Said {
    text: u64,
    sort: u64,
}

const PAUSE: u64 = 2;

impl Said {
    const END: Self = Self { text: 1, sort: 1 };

    /// A value, by its relation to what was asked.
    fn value(tag: &Tag<'_>, asked: QuestionWords<'_>) -> Option<Self> {
        let value = tag.value()?;
        let relation = match asked {
            QuestionWords::Value(_, word) if value.word == word => 6,
            QuestionWords::Value(attribute, _) if value.attributes.contains(&attribute) => 7,
            QuestionWords::Object(words) if words.contains(&value.word) => 6,
            QuestionWords::Object(_) => 7,
            _ => 8,
        };
        Some(Self { text: relation, sort: relation })
    }
}

fn elements(tags: &[Tag<'_>], asked: QuestionWords<'_>) -> Vec<Said> {
    let mut said = Vec::new();
    for tag in tags.iter().filter(|tag| !tag.is(Class::Filler)).take(FAR) {
        if tag.pauses() && !said.is_empty() {
            said.push(Said { text: PAUSE, sort: PAUSE });
        }
        let word = Element::Word(tag);
        let other = || Said { text: text(Some(&word)), sort: sort(Some(&word)) };
        said.push(Said::value(tag, asked).unwrap_or_else(other));
    }
    said
}

/// Rows of weights.
struct Rows(Vec<u32>);

impl Rows {
    fn add(&mut self, name: &[u8], parts: &[u64]) {
        let hash = parts.iter().fold(hash(name.iter().copied()), |hash, part| mix(hash, *part));
        self.0.push((hash >> 16) as u32 % ANSWER_ROWS as u32);
    }
}

/// Returns the hash of the inputs on which the weights were trained.
pub fn answers_trained_on() -> u64 {
    FILE[..HASH].try_into().map_or(0, u64::from_le_bytes)
}
