//! Answers to a choice: by value, by order, and none of them.

use scene::{AttributeId, Options, Question, Response, ValueId};

use super::scene;
use crate::Reader;

#[test]
fn choices_are_answered_by_value_by_order_and_by_neither() {
    // (scene, attribute, options, said, values named, values excluded, response)
    type Case<'a> =
        (&'a str, &'a str, &'a [&'a str], &'a [&'a str], &'a [&'a str], &'a [&'a str], Response);
    let colours = &["white", "metallic", "clear"][..];
    let places = &["dishwasher", "cabinet"][..];
    let kinds = &["marker", "pen", "screwdriver", "wrench"][..];
    let cases: &[Case<'_>] = &[
        (
            "bowls",
            "color",
            colours,
            &[
                "white",
                "the white one",
                "it is white",
                "white please",
                "the first one",
                "first",
                "the first",
                "number one",
                "the 1st one",
            ],
            &["white"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "color",
            colours,
            &["the second one", "the second", "number two", "second please", "the metallic one"],
            &["metallic"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "color",
            colours,
            &["the last one", "the third", "the last", "clear", "the third one please"],
            &["clear"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "location",
            places,
            &["the former", "the first one", "in the dishwasher", "the one in the dishwasher"],
            &["dishwasher"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "location",
            places,
            &["the latter", "the second one", "the last one", "it is in the cabinet"],
            &["cabinet"],
            &[],
            Response::None,
        ),
        (
            "tools",
            "kind",
            kinds,
            &["a pen", "the second one", "number two", "the pen"],
            &["pen"],
            &[],
            Response::None,
        ),
        (
            "tools",
            "kind",
            kinds,
            &["the fourth one", "the last one", "a wrench"],
            &["wrench"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "color",
            colours,
            &[
                "neither",
                "none of them",
                "none of those",
                "something else",
                "no",
                "none",
                "neither of them",
            ],
            &[],
            &[],
            Response::No,
        ),
        (
            "bowls",
            "location",
            places,
            &["neither", "neither of them", "no, neither", "somewhere else"],
            &[],
            &[],
            Response::No,
        ),
        (
            "bowls",
            "color",
            colours,
            &["not the first one", "not the white one"],
            &[],
            &["white"],
            Response::None,
        ),
        (
            "bowls",
            "color",
            colours,
            &["either", "I don't mind", "it doesn't matter", "both are fine", "any of them"],
            &[],
            &[],
            Response::DoesNotMatter,
        ),
        ("bowls", "color", colours, &["I don't know"], &[], &[], Response::CannotTell),
        (
            "bowls",
            "color",
            &colours[..2],
            &["the clear one", "it is clear"],
            &["clear"],
            &[],
            Response::None,
        ),
        (
            "bowls",
            "color",
            &colours[..2],
            &["no, the clear one", "neither, the clear one"],
            &["clear"],
            &[],
            Response::No,
        ),
    ];
    let mut wrong = Vec::new();
    for (name, attribute, options, texts, named, excluded, response) in cases {
        let scene = scene(name);
        let reader = Reader::new(&scene, vocabulary::Language::Careful);
        let k: AttributeId = scene.attribute_named(attribute).unwrap();
        let values: Vec<ValueId> =
            options.iter().map(|v| scene.value_named(k, v).unwrap()).collect();
        let question = Question::Choice(k, Options::new(&values).unwrap());
        let word = |word: &scene::WordId| scene.words()[word.index()].as_str();
        for text in *texts {
            let reading = reader.read(text, question);
            let base: Vec<&str> = reading.base.iter().map(word).collect();
            let out: Vec<&str> = reading.excluded.iter().flatten().map(word).collect();
            if (&base[..], &out[..], reading.response) != (named, excluded, *response) {
                wrong.push(format!("{options:?} {text}: {base:?} -{out:?} {:?}", reading.response));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
