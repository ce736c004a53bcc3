//! Readings with weights and doubts.

use ::vocabulary::Language;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use scene::{AttributeId, Doubt, Question, Reading, Response, ValueId};

use super::{QUESTIONS, TOOLS_READERS, scene, sentences};

use crate::{READINGS_MAX, Reader};

const ASKED: Question = Question::Attribute(AttributeId(0), ValueId(0));

fn bowls() -> (scene::Scene, Reader) {
    let scene = scene("bowls");
    let reader = Reader::new(&scene, Language::Careful);
    (scene, reader)
}

/// The best reading, with the confidences of its words.
fn best(text: &str, confidence: &[f32]) -> Reading {
    let (_, reader) = bowls();
    let mut readings = reader.readings(text, confidence, ASKED);
    readings.remove(0).1
}

#[test]
fn reader_does_not_doubt_clear_typed_words() {
    for text in [
        "the small white bowl",
        "yes",
        "no, the clear one",
        "not the white one",
        "nope",
        "the see-through one in the dish washer",
        "no not that one, the silver one",
    ] {
        assert_eq!(best(text, &[]).doubt, Doubt::default(), "{text}");
    }
}

#[test]
fn answer_to_nothing_is_known_as_one() {
    let (_, reader) = bowls();
    for (text, response) in [
        ("no", Response::No),
        ("yep", Response::Yes),
        ("neither", Response::No),
        ("okay, get it", Response::None),
        ("yes, the bowl", Response::None),
        ("no, the white one", Response::None),
    ] {
        assert_eq!(reader.readings(text, &[], Question::None)[0].1.response, response, "{text}");
    }
}

#[test]
fn reader_turns_word_confidences_into_doubts() {
    let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
    let doubt = best("the white bowl", &[1.0, 0.7, 1.0]).doubt;
    assert!(doubt.base.len() == 1 && close(doubt.base[0], 0.3), "{doubt:?}");
    let doubt = best("no the small clear one", &[0.6, 1.0, 0.9, 0.5]).doubt;
    assert!(close(doubt.response, 0.4) && close(doubt.base[0], 0.1) && close(doubt.base[1], 0.5));
    let doubt = best("not the white one", &[0.8, 1.0, 0.5]).doubt;
    assert!(close(doubt.excluded[0], 0.6) && close(doubt.response, 0.6), "{doubt:?}");
    let doubt = best("the see through one", &[1.0, 0.9, 0.4]).doubt;
    assert!(close(doubt.base[0], 0.6), "the least sure of a phrase's words: {doubt:?}");
    let doubt = best("yes the white one yes", &[0.3, 1.0, 1.0, 1.0, 0.9]).doubt;
    assert!(close(doubt.response, 0.1), "said twice: {doubt:?}");
    assert_eq!(best("um the white bowl", &[0.1, 0.2, 1.0, 0.3]).doubt, Doubt::default());
}

#[test]
fn reader_doubts_hedged_content() {
    let response = |text: &str| {
        let reading = best(text, &[]);
        assert_ne!(reading.response, Response::None, "{text}");
        reading.doubt.response
    };
    let order = ["yes", "I'm almost certain it is", "I think so", "probably", "I guess so"];
    let doubts = order.map(response);
    assert!(
        doubts.is_sorted() && doubts[0] == 0.0 && doubts[1] > 0.0 && doubts[4] < 1.0,
        "{doubts:?}"
    );
    assert!(response("I don't think so") > 0.0);
    assert!(response("yes, I think") > 0.0);
    let word = |text: &str| best(text, &[]).doubt.of_word(0);
    assert_eq!(word("the clear one"), 0.0);
    for text in [
        "I think the clear one",
        "the clear one, I think",
        "maybe the clear one",
        "it's probably the clear one",
        "I don't know, the clear one maybe",
    ] {
        assert!(word(text) > 0.1, "{text}");
    }
    assert!(word("maybe the clear one") > word("I think the clear one"));
    // Words in another sentence are not hedged.
    assert_eq!(word("the clear one. I think it's late."), 0.0);
}

#[test]
fn reader_doubts_a_corrected_word() {
    let word = |text: &str| best(text, &[]).doubt.of_word(0);
    assert!(word("the whtie bowl") > 0.0);
    assert!(word("the wide bowl") > word("the whtie bowl"));
    assert_eq!(word("the biiig bowl"), 0.0);
}

#[test]
fn reader_returns_one_reading_per_alternative() {
    let (scene, reader) = bowls();
    let words = |text: &str| -> Vec<Vec<String>> {
        let readings = reader.readings(text, &[], Question::None);
        let names = |reading: &Reading| {
            reading.base.iter().map(|w| scene.words()[w.index()].clone()).collect()
        };
        readings.iter().map(|(_, reading)| names(reading)).collect()
    };
    assert_eq!(words("white or clear"), [vec!["white", "clear"], vec!["white"], vec!["clear"]]);
    assert_eq!(
        words("the white or the clear one on the counter")[1..],
        [vec!["white", "counter"], vec!["clear", "counter"]]
    );
    assert_eq!(words("the white one or the small one")[1..], [["white"], ["small"]]);
    assert_eq!(words("white, clear or metallic").len(), 4);
    assert_eq!(words("the white one")[0], ["white"]);
    assert!(words("not white or clear")[0].is_empty());
}

#[test]
fn question_about_an_object_from_perception_is_answered_by_yes_or_no() {
    let (_, reader) = bowls();
    for (text, response) in
        [("no", Response::No), ("yes", Response::Yes), ("white", Response::None)]
    {
        let read = reader.read(text, Question::Point(scene::ObjectId(9)));
        assert_eq!(read.response, response, "{text}");
    }
}

#[test]
fn maybe_is_neither_a_yes_nor_a_no() {
    let (_, reader) = bowls();
    for text in ["maybe", "perhaps", "it could be"] {
        let readings = reader.readings(text, &[], ASKED);
        let weight = |response: Response| -> f64 {
            let given = readings.iter().filter(|(_, reading)| reading.response == response);
            given.map(|(weight, reading)| weight * (1.0 - reading.doubt.response)).sum()
        };
        let (yes, no) = (weight(Response::Yes), weight(Response::No));
        assert!(yes < 0.5 && no < 0.3 && no <= yes, "{text}: {readings:?}");
        assert_eq!(reader.readings(text, &[], Question::None).len(), 1);
    }
    for text in ["I don't know", "no", "um"] {
        assert_eq!(reader.readings(text, &[], ASKED).len(), 1, "{text}");
    }
}

#[test]
fn reader_is_sure_of_plain_words_and_in_doubt_about_what_its_rules_do_not_cover() {
    let (_, reader) = bowls();
    let white = reader.read("white", Question::None).base[0];
    let wanted = |text: &str| -> f64 {
        let readings = reader.readings(text, &[], Question::None);
        let asserts = readings.iter().filter(|(_, reading)| reading.base.contains(&white));
        asserts.map(|(weight, _)| weight).sum()
    };
    for text in ["the white one", "get me the white bowl please", "white", "a small white bowl"] {
        let wanted = wanted(text);
        assert!(wanted > 0.9, "{text}: {wanted}");
    }
    for text in [
        "white is out",
        "avoid white",
        "I already have a white one",
        "leave the white one alone",
        "nto the white one",
        "we are out of white ones",
        "steer clear of white",
    ] {
        let wanted = wanted(text);
        assert!(wanted < 0.75, "{text}: {wanted}");
    }
}

#[test]
fn paper_reader_has_no_doubts() {
    let scene = scene("bowls");
    let reader = Reader::new(&scene, Language::Paper);
    let readings = reader.readings("maybe the white or clear one", &[0.1; 6], ASKED);
    assert_eq!(readings, [(1.0, reader.read("maybe the white or clear one", ASKED))]);
}

/// Words of the dialogue, separated by bars.
const WORDS: &str = "\
    the|not|no|yes|red|blue|marker|one|and|or|but|,|.|on|table|sorry|i|do|want|get|me|is|it|\
    that|what|other|than|anything|foo|uh|sure|if|next to|short|never mind|start over|stop|\
    isn't|you|my|was|clear|pen|any|except|maybe|think|so|wait|right|of|in|dish|-|'|?|le|\
    drop table|put|non|probably|markre|screw|driver|green|perhaps";

/// Salads of words, sentences with one part replaced, and any characters at all.
fn unlikely_text() -> impl Strategy<Value = String> {
    let word = select(WORDS.split('|').collect::<Vec<_>>());
    let sentence = select(sentences(include_str!("cases.txt")).collect::<Vec<_>>());
    let mutated = (sentence, any::<[Index; 2]>(), ".{0,3}").prop_map(|(sentence, ends, part)| {
        let [from, to] = ends.map(|end| end.index(sentence.len() + 1));
        format!("{}{part}{}", &sentence[..from.min(to)], &sentence[from.max(to)..])
    });
    prop_oneof![vec(word, 0..30).prop_map(|words| words.join(" ")), mutated, any::<String>()]
}

proptest! {
    /// For any text with any confidence: few readings of known words, weights that sum to 1, doubts
    /// that are probabilities, no answer without a question, and the best one equals `read`.
    #[test]
    fn readings_are_a_distribution(
        text in unlikely_text(),
        confidence in vec(-0.5..1.5_f32, 0..30),
        question in select(&QUESTIONS[..]),
    ) {
        let (scene, [paper, reader]) = &*TOOLS_READERS;
        paper.read(&text, question);
        let readings = reader.readings(&text, &confidence, question);
        prop_assert!((1..=READINGS_MAX).contains(&readings.len()));
        prop_assert!((readings.iter().map(|(weight, _)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
        prop_assert!(readings.iter().all(|(weight, _)| *weight <= readings[0].0));
        for (_, Reading { doubt, base, excluded, response, .. }) in &readings {
            // Without a question, an answer is the whole utterance; but "any of them" is a request.
            let unasked = matches!(response, Response::None | Response::DoesNotMatter);
            let is_alone = base.is_empty() && excluded.is_empty();
            prop_assert!(question != Question::None || unasked || is_alone);
            prop_assert!(base.iter().all(|word| word.index() < scene.words().len()));
            prop_assert!(excluded.iter().all(|group| !group.is_empty()));
            let doubts = doubt.base.iter().chain(&doubt.excluded).chain([&doubt.response]);
            prop_assert!(doubts.into_iter().all(|doubt| (0.0..=1.0).contains(doubt)), "{doubt:?}");
            prop_assert!(doubt.base.len() <= base.len() && doubt.excluded.len() <= excluded.len());
        }
        let read = reader.read(&text, question);
        prop_assert_eq!(&reader.readings(&text, &[], question)[0].1, &read);
    }
}
