//! Reading of the public utterances over the six bowls.

use super::scenes::configured;
use crate::report::Report;
use language::Reader;
use scene::Question;
use std::hint::black_box;
use std::time::Instant;
use vocabulary::Language;

const UTTERANCES: &str = include_str!("../../fixtures/utterances/public.jsonl");
/// Readings that make one sample, so that the clock's own cost does not count.
const REPETITIONS: u32 = 200;

pub(super) fn measure(report: &mut Report) {
    let reader = Reader::new(&configured("bowls"), Language::Careful);
    let mut add = |what: &str, read: &dyn Fn(&str)| {
        let samples: Vec<f64> = UTTERANCES.lines().map(|line| micros(&text(line), read)).collect();
        report.add(what, "µs", &samples, "the 60 public utterances; one sample each");
    };
    add("reading an utterance", &|text| {
        black_box(reader.read(text, Question::None));
    });
    add("reading an utterance, with weights and doubts", &|text| {
        black_box(reader.readings(text, &[], Question::None));
    });
}

fn text(line: &str) -> String {
    let json: serde_json::Value = serde_json::from_str(line).expect("a line of JSON");
    json["text"].as_str().expect("a text").to_owned()
}

fn micros(text: &str, read: &dyn Fn(&str)) -> f64 {
    let started = Instant::now();
    (0..REPETITIONS).for_each(|_| read(text));
    started.elapsed().as_secs_f64() * 1e6 / f64::from(REPETITIONS)
}
