//! The reader on whole utterances: the public set, our own table, and any text at all.

mod choices;
mod conversation;
mod formatting;
mod halting;
mod own_words;
mod readings;
mod shapes;
pub(crate) mod table;
mod wordings;

use std::sync::LazyLock;

use scene::{Question, Role, Scene, question_from_json};
use serde_json::Value as Json;

use ::vocabulary::Language;

use crate::Reader;

/// A file of the utterance fixtures.
macro_rules! fixture {
    ($file:literal) => {
        include_str!(concat!("../../../../tests/fixtures/utterances/", $file))
    };
}
use fixture;

const PUBLIC: &str = fixture!("public.jsonl");

pub(crate) fn scene(name: &str) -> Scene {
    let text = match name {
        "bowls" => include_str!("../../../../config/scenes/bowls.toml"),
        "tools" => include_str!("../../../../config/scenes/tools.toml"),
        "markers" => include_str!("../../../../config/scenes/markers.toml"),
        "talk_books" => include_str!("../../../../tests/talk/scenes/books.toml"),
        "talk_clothes" => include_str!("../../../../tests/talk/scenes/clothes.toml"),
        "talk_cutlery" => include_str!("../../../../tests/talk/scenes/cutlery.toml"),
        "talk_medicine" => include_str!("../../../../tests/talk/scenes/medicine.toml"),
        "talk_mugs" => include_str!("../../../../tests/talk/scenes/mugs.toml"),
        "talk_office" => include_str!("../../../../tests/talk/scenes/office.toml"),
        "talk_toys" => include_str!("../../../../tests/talk/scenes/toys.toml"),
        "talk_workshop" => include_str!("../../../../tests/talk/scenes/workshop.toml"),
        "mugs" => fixture!("mugs.toml"),
        "garments" => fixture!("garments.toml"),
        "pantry" => fixture!("pantry.toml"),
        other => panic!("no scene {other}"),
    };
    Scene::from_toml(name, text).expect("a shipped scene")
}

/// The sentences of a table that are plain ASCII.
fn sentences(table: &'static str) -> impl Iterator<Item = &'static str> {
    let text = |line: &'static str| {
        let (input, _) = line.rsplit_once("=>")?;
        let text = input.split_once(':')?.1.trim();
        (text.is_ascii() && !text.is_empty()).then_some(text)
    };
    table.lines().filter_map(text)
}

/// The tools and a reader of each language, built once for the many cases of random tests.
static TOOLS_READERS: LazyLock<(Scene, [Reader; 2])> = LazyLock::new(|| {
    let scene = scene("tools");
    let readers =
        [Language::Paper, Language::Careful].map(|language| Reader::new(&scene, language));
    (scene, readers)
});

/// A meaning with the scene's words, in a form that compares as sets do.
#[derive(Clone, Debug, Default, PartialEq)]
struct Meaning {
    base: Vec<String>,
    response: String,
    excluded: Vec<Vec<String>>,
    intent: String,
}

impl Meaning {
    fn of(json: &Json) -> Self {
        let set = |json: &Json| {
            let words = json.as_array().into_iter().flatten();
            let mut words: Vec<String> =
                words.map(|word| word.as_str().expect("a word").to_owned()).collect();
            words.sort();
            words.dedup();
            words
        };
        let mut excluded: Vec<Vec<String>> =
            json["excluded"].as_array().into_iter().flatten().map(set).collect();
        excluded.sort();
        excluded.dedup();
        Self {
            base: set(&json["base"]),
            response: json["response"].as_str().unwrap_or("none").to_owned(),
            excluded,
            intent: json["intent"].as_str().unwrap_or("inform").to_owned(),
        }
    }

    fn read(reader: &Reader, scene: &Scene, text: &str, question: Question) -> Self {
        let understood = reader.read(text, question);
        Self::of(&scene::reading_to_json(scene, &understood))
    }
}

/// Reads every public line; returns their number and the failures.
fn failures(language: Language, right: impl Fn(&Json, &Meaning) -> bool) -> Vec<String> {
    let scenes = ["bowls", "tools"].map(|name| (name, scene(name)));
    let readers = scenes.each_ref().map(|(_, scene)| Reader::new(scene, language));
    let mut failures = Vec::new();
    for line in PUBLIC.lines() {
        let json: Json = serde_json::from_str(line).expect("a line of JSON");
        let n = usize::from(json["scene"] == "tools");
        let scene = &scenes[n].1;
        let question = question_from_json(scene, &json["last_question"]).expect("a question");
        let text = json["text"].as_str().expect("a text");
        let read = Meaning::read(&readers[n], scene, text, question);
        if !right(&json, &read) {
            failures.push(format!("{}: {text:?} read as {read:?}", json["id"]));
        }
    }
    failures
}

#[test]
fn paper_mode_reproduces_the_word_spotting_model() {
    assert_eq!(PUBLIC.lines().count(), 60);
    let failures = failures(Language::Paper, |json, read| Meaning::of(&json["seed"]) == *read);
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn careful_mode_understands_the_public_utterances() {
    let failures = failures(Language::Careful, |json, read| {
        let others = json["accept"].as_array().into_iter().flatten();
        std::iter::once(&json["expect"]).chain(others).any(|json| Meaning::of(json) == *read)
    });
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn reader_names_unknown_words() {
    let scene = scene("bowls");
    let reader = Reader::new(&scene, Language::Careful);
    for (text, unknown) in [
        ("get me the purple one", vec!["purple"]),
        ("the big wooden bowl", vec!["wooden"]),
        ("bring me the frobnitz", vec!["frobnitz"]),
        ("the white one", vec![]),
        ("my phone is ringing", vec![]),
        ("the one on the left", vec!["on the left"]),
        ("the left one", vec!["left"]),
        ("bring me the third bowl please", vec!["third"]),
        ("the second bowl from the left", vec!["second bowl from the left"]),
        ("the white bowl next to the cup", vec!["next to the cup"]),
        ("the clear bowl behind the white one", vec!["behind the white one"]),
        ("the bowl next to the red one", vec!["next to the red one"]),
        ("the white bowl, but not the leftmost", vec!["leftmost"]),
        ("the bowl between the mugs", vec!["between the mugs"]),
        ("the bowl in front of the toaster", vec!["in front of the toaster"]),
        ("first the white bowl, then the clear one", vec![]),
        ("the clear bowl, then the next one", vec![]),
        ("the smallest one", vec![]),
        ("the bowl near you", vec![]),
        ("the clear bowl close to me", vec![]),
        ("the clear bowl close to me please", vec![]),
        ("the clear bowl in front of you", vec![]),
        ("put the clear bowl in front of me", vec![]),
        ("get me the clear bowl that is nearby", vec![]),
        ("the bowl next to your plate", vec!["next to your plate"]),
        ("right, the clear one", vec![]),
        ("first of all I need the clear bowl", vec![]),
        ("the chair my grandmother gave me is broken, the clear bowl please", vec![]),
    ] {
        let words = reader.unknown_words(text, Question::None).into_iter().map(|word| word.text);
        assert_eq!(words.collect::<Vec<_>>(), unknown, "{text}");
    }
}

#[test]
fn reader_tells_an_unknown_thing_from_an_unknown_quality() {
    let scene = scene("mugs");
    let reader = Reader::new(&scene, Language::Careful);
    for (text, word, role) in [
        ("can you bring me a plate", "plate", Role::Kind),
        ("get me the frying pan", "frying pan", Role::Kind),
        ("I would like a newspaper", "newspaper", Role::Kind),
        ("can I have the dinosaur", "dinosaur", Role::Kind),
        ("do you have a novel?", "novel", Role::Kind),
        ("have you got any rivets", "rivets", Role::Kind),
        ("a wooden mug", "wooden", Role::Quality),
        ("the yellow mug", "yellow", Role::Quality),
        ("get me the purpure one", "purpure", Role::Quality),
        ("the mug in the garage", "garage", Role::Place),
        ("is there a yellow mug?", "yellow", Role::Quality),
        ("penicillin please", "penicillin", Role::Kind),
    ] {
        let words = reader.unknown_words(text, Question::None);
        let first = words.first().map(|word| (word.text.as_str(), word.role));
        assert_eq!(first, Some((word, role)), "{text}");
    }
    assert_eq!(reader.unknown_words("the red mug please", Question::None), []);
}

/// A question of each kind about the scene of [`TOOLS_READERS`].
const QUESTIONS: [Question; 4] = [
    Question::None,
    Question::Point(scene::ObjectId(3)),
    Question::Attribute(scene::AttributeId(1), scene::ValueId(2)),
    Question::Which(scene::AttributeId(0)),
];

/// A scene whose values are words that mean something else in other scenes, or are several words.
#[test]
fn reader_uses_the_words_of_each_scene() {
    let mut json = serde_json::json!({"noun": "jar", "objects": [], "values": {
        "position": ["left", "middle", "right"],
        "color": ["blue", "light blue", "orange", "medium grey"],
        "label": ["no. 7", "x-aligned", "stop", "ÄPFEL"],
        "state": ["lit", "unlit", "broken"],
    }});
    json["objects"] = serde_json::json!([{"name": "a", "attributes": {"color": "blue"}}]);
    let scene = Scene::from_json("jars", &json).expect("a scene");
    let reader = Reader::new(&scene, Language::Careful);
    for (text, base) in [
        ("the one on the left", vec!["left"]),
        ("the light blue jar", vec!["light blue"]),
        ("the blue jar", vec!["blue"]),
        ("the right one", vec!["right"]),
        ("get me the medium grey one", vec!["medium grey"]),
        ("the x aligned jar", vec!["x-aligned"]),
        ("the broken jar in the middle", vec!["broken", "middle"]),
        ("the äpfel jar", vec!["ÄPFEL"]),
        ("the jar with the no 7", vec!["no. 7"]),
        ("the orange jars", vec!["orange"]),
        ("the lightblue jar", vec!["light blue"]),
    ] {
        let read = Meaning::read(&reader, &scene, text, Question::None);
        let mut base: Vec<String> = base.iter().map(|word| (*word).to_owned()).collect();
        base.sort();
        assert_eq!(read.base, base, "{text}");
        assert_eq!(read.excluded, Vec::<Vec<String>>::new(), "{text}");
    }
    // A retracted value may be denied as well.
    let text = "the blue, no, the light blue one";
    assert_eq!(Meaning::read(&reader, &scene, text, Question::None).base, ["light blue"]);
}
