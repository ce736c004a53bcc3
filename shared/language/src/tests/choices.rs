//! Answers to a choice: by value, by order, or "none of them".

use scene::{AttributeId, Options, Question, Response, ValueId};

use super::scene;
use crate::Reader;

/// Scene, attribute and options; utterance; and its meaning: a value, a value ruled out, an answer.
const CASES: &str = "\
bowls color white,metallic,clear: white; the white one; it is white; white please; the first one; first => white
bowls color white,metallic,clear: the first; number one; the 1st one => white
bowls color white,metallic,clear: the second one; the second; number two; second please; the metallic one => metallic
bowls color white,metallic,clear: the last one; the third; the last; clear; the third one please => clear
bowls location dishwasher,cabinet: the former; the first one; in the dishwasher; the one in the dishwasher => dishwasher
bowls location dishwasher,cabinet: the latter; the second one; the last one; it is in the cabinet => cabinet
tools kind marker,pen,screwdriver,wrench: a pen; the second one; number two; the pen => pen
tools kind marker,pen,screwdriver,wrench: the fourth one; the last one; a wrench => wrench
bowls color white,metallic,clear: neither; none of them; none of those; something else; no; none => no
bowls color white,metallic,clear: neither of them => no
bowls location dishwasher,cabinet: neither; neither of them; no, neither; somewhere else => no
bowls color white,metallic,clear: not the first one; not the white one => -white
bowls color white,metallic,clear: either; I don't mind; it doesn't matter; both are fine; any of them => any
bowls color white,metallic,clear: I don't know => unknown
bowls color white,metallic: the clear one; it is clear => clear
bowls color white,metallic: no, the clear one; neither, the clear one => clear no";

#[test]
fn choices_are_answered_by_value_by_order_and_by_neither() {
    let mut wrong = Vec::new();
    for case in CASES.lines() {
        let (context, rest) = case.split_once(": ").unwrap();
        let (said, meaning) = rest.split_once(" => ").unwrap();
        let [name, attribute, options] =
            context.split(' ').collect::<Vec<_>>().try_into().expect("three words");
        let scene = scene(name);
        let reader = Reader::new(&scene, vocabulary::Language::Careful);
        let k: AttributeId = scene.attribute_named(attribute).unwrap();
        let values = options.split(',').map(|v| scene.value_named(k, v).unwrap());
        let question =
            Question::Choice(k, Options::new(&values.collect::<Vec<ValueId>>()).unwrap());
        let word = |word: &scene::WordId| scene.words()[word.index()].clone();
        for text in said.split("; ") {
            assert_eq!(reader.unknown_word(text, question), None, "{text}");
            let reading = reader.read(text, question);
            let mut read: Vec<String> = reading.base.iter().map(word).collect();
            read.extend(reading.excluded.iter().flatten().map(|it| format!("-{}", word(it))));
            let answer = match reading.response {
                Response::None => None,
                Response::No => Some("no"),
                Response::DoesNotMatter => Some("any"),
                Response::CannotTell => Some("unknown"),
                Response::Yes => Some("yes"),
            };
            read.extend(answer.map(str::to_owned));
            if read.join(" ") != meaning {
                wrong.push(format!("{context}: {text} => {read:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_and_another_attribute_may_take_back_what_was_said_before() {
    let scene = scene("bowls");
    let reader = Reader::new(&scene, vocabulary::Language::Careful);
    let color = scene.attribute_named("color").unwrap();
    let value = |name: &str| scene.value_named(color, name).unwrap();
    let question =
        Question::Choice(color, Options::new(&[value("white"), value("clear")]).unwrap());
    let answers = |text: &str| -> Vec<(f64, Response)> {
        let readings = reader.readings(text, &[], question);
        readings.iter().map(|(weight, reading)| (*weight, reading.response)).collect()
    };
    let [(is_answer, Response::No), (is_correction, Response::None)] = answers("no, small")[..]
    else {
        panic!("{:?}", answers("no, small"));
    };
    assert!((is_answer - is_correction).abs() < 0.1, "{is_answer} {is_correction}");
    for text in ["no", "no, metallic", "neither"] {
        assert!(answers(text).iter().all(|(_, answer)| *answer == Response::No), "{text}");
    }
}
