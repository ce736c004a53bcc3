//! Readers of scenes, their diagnostics, and the shipped scenes.

mod choices;
mod wordings;

use expect_test::expect_file;
use proptest::prelude::*;
use serde_json::json;

use crate::{
    AttributeId, ObjectId, Options, Question, Reading, Role, Scene, Value, ValueId, WordId,
    question_from_json, question_to_json, reading_to_json,
};

const BOWLS: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/scenes/bowls.toml"));
const MARKERS: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/scenes/markers.toml"));
const TOOLS: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/scenes/tools.toml"));
const BOWLS_JSON: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fixtures/scenes/bowls.json"));
const TOOLS_JSON: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fixtures/scenes/tools.json"));

fn shipped(text: &str) -> Scene {
    Scene::from_toml("shipped.toml", text).unwrap_or_else(|problems| panic!("{problems:#?}"))
}

#[test]
fn shipped_scenes_are_the_reference_ones() {
    for (toml, reference) in [(BOWLS, BOWLS_JSON), (TOOLS, TOOLS_JSON)] {
        let json = serde_json::from_str(reference).expect("the fixture is JSON");
        let reference = Scene::from_json("reference", &json).expect("the fixture is a scene");
        assert_eq!(shipped(toml).key(), reference.key());
    }
    let markers = shipped(MARKERS);
    assert_eq!(markers.words(), ["red", "blue"]);
    assert_eq!(markers.objects().len(), 2);
}

#[test]
fn shipped_objects_stand_clear_of_each_other() {
    for scene in [BOWLS, MARKERS, TOOLS].map(shipped) {
        let places: Vec<_> =
            scene.objects().iter().map(|o| (&o.name, o.placement.expect("placed"))).collect();
        for (n, (name, a)) in places.iter().enumerate() {
            assert!((0.55..=0.80).contains(&a.xyz[0]) && a.xyz[1].abs() <= 0.6, "{name}");
            assert!(a.grasp_width <= 0.041, "{name} fits between the fingers");
            for (other, b) in &places[..n] {
                let apart = (a.xyz[0] - b.xyz[0]).hypot(a.xyz[1] - b.xyz[1]);
                assert!(apart > 0.119, "{name} and {other} are {apart} m apart");
            }
        }
    }
}

#[test]
fn questions_are_worded_by_the_scene() {
    let bowls = shipped(BOWLS);
    let ask = |json| bowls.phrase(question_from_json(&bowls, &json).expect("a question"));
    let attr = |k: &str, v: &str| ask(json!({"type": "attr", "attribute": k, "value": v}));
    assert_eq!(attr("location", "dishwasher"), "Is it in the dishwasher?");
    assert_eq!(attr("color", "white"), "Is it white?");
    assert_eq!(attr("material", "metal"), "Is it made of metal?");
    assert_eq!(ask(json!({"type": "which", "attribute": "color"})), "What colour is it?");
    assert_eq!(ask(json!({"type": "point", "object": "clear"})), "This one?");
    assert_eq!(ask(json!(null)), "Which bowl would you like?");
}

#[test]
fn wordings_alternate_and_repetitions_are_reworded() {
    let bowls = shipped(BOWLS);
    for question in all_questions(&bowls) {
        assert_eq!(bowls.phrase_variant(question, 0, 1, &[]), bowls.phrase(question));
        for (n, time) in (0..6).flat_map(|n| (0..6).map(move |time| (n, time))) {
            let text = bowls.phrase_variant(question, n, time, &[]);
            assert!(text.ends_with('?') && !text.contains(['{', '}']), "{text}");
            assert!(text.starts_with(char::is_uppercase) && text.len() < 100, "{text}");
        }
    }
    let say = |json, n, time, choices: &[&str]| {
        let question = question_from_json(&bowls, &json).expect("a question");
        let choices: Vec<String> = choices.iter().map(|it| (*it).to_owned()).collect();
        bowls.phrase_variant(question, n, time, &choices)
    };
    let white = || json!({"type": "attr", "attribute": "color", "value": "white"});
    let color = || json!({"type": "which", "attribute": "color"});
    let this = || json!({"type": "point", "object": "clear"});
    assert_eq!(say(white(), 0, 2, &[]), "White?");
    assert_eq!(say(white(), 0, 3, &[]), "White: yes or no?");
    assert_eq!(say(white(), 0, 4, &[]), "Once more: is it white?");
    assert_ne!(say(white(), 1, 1, &[]), say(white(), 0, 1, &[]));
    assert_eq!(say(color(), 0, 2, &[]), "Which color?");
    assert_eq!(say(color(), 0, 3, &["white", "clear"]), "White or clear?");
    assert_eq!(say(color(), 0, 3, &["white", "metallic", "clear"]), "White, metallic or clear?");
    assert_eq!(say(this(), 0, 3, &[]), "This one: yes or no?");
    assert_eq!(say(this(), 0, 2, &[]), "Is it this one?");
}

/// However often a question is put, it never comes twice in the same words within ten times.
#[test]
fn no_wording_comes_twice_in_ten() {
    let bowls = shipped(BOWLS);
    let of_attributes = |question: &Question| !matches!(question, Question::None);
    for question in all_questions(&bowls).into_iter().filter(of_attributes) {
        let mut said: Vec<String> =
            (1..=10).map(|time| bowls.phrase_variant(question, 0, time, &[])).collect();
        said.sort_unstable();
        said.dedup();
        assert_eq!(said.len(), 10, "{question:?}: {said:?}");
    }
}

/// Every question that there is about a scene.
fn all_questions(scene: &Scene) -> Vec<Question> {
    let mut all = vec![Question::None];
    all.extend((0..scene.objects().len()).map(|i| Question::Point(ObjectId::from(i))));
    for (k, attribute) in scene.attributes().iter().enumerate() {
        let k = AttributeId::from(k);
        all.push(Question::Which(k));
        let values: Vec<ValueId> = (0..attribute.values.len()).map(ValueId::from).collect();
        all.extend(values.iter().map(|v| Question::Attribute(k, *v)));
        let options = values.windows(2).chain([&values[..values.len().min(Options::MAX)]]);
        all.extend(options.filter_map(Options::new).map(|options| Question::Choice(k, options)));
    }
    all
}

#[test]
fn objects_are_described_by_distinguishing_values() {
    let (bowls, tools) = (shipped(BOWLS), shipped(TOOLS));
    let describe = |scene: &Scene, name| scene.describe(scene.object_named(name).expect("there"));
    assert_eq!(describe(&bowls, "white"), "bowl in the dishwasher");
    assert_eq!(describe(&bowls, "clear"), "clear bowl");
    assert_eq!(describe(&tools, "m_green"), "green marker");
    assert_eq!(describe(&tools, "p_black"), "black pen");
    assert_eq!(describe(&tools, "s_blue"), "blue screwdriver");
    let names = |scene: &Scene| -> std::collections::HashSet<String> {
        (0..scene.objects().len()).map(|i| scene.describe(ObjectId::from(i))).collect()
    };
    assert_eq!((names(&bowls).len(), names(&tools).len()), (6, 10));
}

const MUGS: &str = include_str!("../../../tests/fixtures/utterances/mugs.toml");

#[test]
fn objects_are_described_as_a_person_would() {
    let mugs = shipped(MUGS);
    let named = |name: &str| mugs.object_named(name).expect("there");
    let describe = |name| mugs.describe(named(name));
    assert_eq!(describe("green_cup"), "green cup");
    assert_eq!(describe("blue_mug"), "mug next to the sink");
    assert_eq!(describe("blue_cup"), "blue cup");
    let among = |name, others: &[&str]| {
        let others: Vec<ObjectId> = others.iter().map(|name| named(name)).collect();
        mugs.describe_among(named(name), &others)
    };
    assert_eq!(among("white_cup", &["red_mug", "blue_mug"]), "cup");
    assert_eq!(among("white_cup", &["green_cup", "red_mug"]), "white cup");
    assert_eq!(among("red_mug", &[]), "mug");
    let three = ["red_mug", "blue_mug", "white_cup"].map(named);
    assert_eq!(mugs.list(&three, "or"), "the red mug, the blue mug or the white cup");
    assert_eq!(mugs.list(&three[..2], "and"), "the red mug and the blue mug");
    assert_eq!(mugs.list(&three[..1], "or"), "the red mug");
    assert_eq!(mugs.plural_nouns(&three), "mugs and cups");
    assert_eq!(mugs.noun_of(named("white_cup")), "cup");
}

#[test]
fn roles_are_keys_of_the_scene() {
    let text = r#"
name = "s"
noun = "drink"
[[attributes]]
name = "kind"
role = "kind"
values = ["tea", { name = "hot", role = "quality" }]
[[attributes]]
name = "place"
values = [{ name = "sink", spoken = "next to the sink" }, { name = "Rome", spoken = "Rome", role = "place" }]
[[objects]]
name = "a"
attributes = { kind = "tea", place = "sink" }
"#;
    let scene = Scene::from_toml("s", text).expect("a scene");
    let roles =
        |k: usize| -> Vec<Role> { scene.attributes()[k].values.iter().map(Value::role).collect() };
    assert_eq!(roles(0), [Role::Kind, Role::Quality]);
    assert_eq!(roles(1), [Role::Place, Role::Place]);
    let wrong = text.replace("\"quality\"", "\"qality\"");
    let error = Scene::from_toml("s", &wrong).expect_err("an unknown role").to_string();
    assert!(error.contains("unknown role `qality`") && error.contains("`quality`"), "{error}");
}

#[test]
fn wording_has_defaults() {
    let json = json!({"objects": [{"name": "a", "attributes": {"age": "old"}}]});
    let scene = Scene::from_json("s", &json).expect("a scene");
    let old = Question::Attribute(AttributeId(0), ValueId(0));
    assert_eq!(scene.phrase(old), "Is the age old?");
    assert_eq!(scene.phrase(Question::Which(AttributeId(0))), "What is the age?");
}

/// `invalid.txt` holds each text and its diagnostics; `UPDATE_EXPECT=1 cargo test -p scene`
/// rewrites the diagnostics.
#[test]
fn invalid_scenes_get_every_diagnostic_with_line_and_help() {
    let mut found = String::new();
    for case in include_str!("invalid.txt").split("--- ").skip(1) {
        let (form, rest) = case.split_once('\n').expect("a head");
        let text = rest.split_once("\n+++\n").expect("a separator").0;
        let read = match form {
            "toml" => Scene::from_toml("s.toml", text),
            _ => Scene::from_json("s.json", &serde_json::from_str(text).expect("JSON")),
        };
        let error = read.expect_err(text);
        found += &format!("--- {form}\n{text}\n+++\n{error}\n");
    }
    expect_file!["invalid.txt"].assert_eq(&found);
}

#[test]
fn scene_beyond_the_index_range_is_rejected() {
    let objects: Vec<_> =
        (0..65_536).map(|n| json!({"name": format!("o{n}"), "attributes": {"k": "v"}})).collect();
    let problems = Scene::from_json("s", &json!({"objects": objects})).expect_err("too many");
    let expected = "s: objects: 65536 are too many; help: use at most 65535";
    assert_eq!(problems.iter().next().map(ToString::to_string).as_deref(), Some(expected));
}

#[test]
fn json_without_values_takes_them_from_the_objects() {
    let json = json!({"objects": [
        {"name": "a", "attributes": {"size": "big", "color": "red"}},
        {"name": "b", "attributes": {"color": "blue"}},
    ]});
    let scene = Scene::from_json("s", &json).expect("a scene");
    assert_eq!(scene.words(), ["big", "red", "blue"]);
    assert_eq!(scene.objects()[1].values, [None, Some(ValueId(1))]);
}

#[test]
fn scene_word_of_two_attributes_counts_once() {
    let json = json!({"objects": [
        {"name": "a", "attributes": {"skin": "orange", "pulp": "orange"}},
        {"name": "b", "attributes": {"skin": "green", "pulp": "orange"}},
    ]});
    let scene = Scene::from_json("s", &json).expect("a scene");
    assert_eq!(scene.words(), ["orange", "green"]);
    assert_eq!(scene.vocabulary_len(ObjectId(0)), 1);
    assert_eq!(scene.vocabulary(ObjectId(1)).collect::<Vec<_>>(), [WordId(0), WordId(1)]);
    assert!(!scene.has_word(ObjectId(0), WordId(1)));
}

#[test]
fn scene_key_depends_on_the_problem_only() {
    let key = |text: &str| shipped(text).key();
    let original = key(MARKERS);
    for (from, to, same) in [
        ("0.15, -0.148", "0.25, -0.148", true),
        ("What colour", "Of what colour", true),
        ("values = [\"red\", \"blue\"]", "values = [\"blue\", \"red\"]", false),
        ("name = \"red\"\n", "name = \"crimson\"\n", false),
    ] {
        assert!(MARKERS.contains(from));
        assert_eq!(key(&MARKERS.replacen(from, to, 1)) == original, same, "{from} -> {to}");
    }
}

#[test]
fn ten_thousand_objects_with_twenty_attributes_are_read_at_once() {
    let objects: Vec<_> = (0..10_000_usize)
        .map(|n| {
            let values = (0..20).map(|k| (format!("k{k}"), json!(format!("v{}", (n >> k) % 7))));
            json!({"name": format!("o{n}"), "attributes": values.collect::<serde_json::Map<_, _>>()})
        })
        .collect();
    let scene = Scene::from_json("s", &json!({"objects": objects})).expect("a scene");
    assert_eq!(scene.object_named("o9999"), Some(ObjectId(9_999)));
    assert_eq!(scene.vocabulary_len(ObjectId(0)), 1);
}

#[test]
fn question_json_rejects_unknown_names() {
    let bowls = shipped(BOWLS);
    let cases = [
        (json!("attr"), "a question is an object with a \"type\""),
        (
            json!({"type": "why"}),
            "unknown question type \"why\"; the types are none, point, attr, which and choice",
        ),
        (json!({"type": "which"}), "\"attribute\" is missing or not a string"),
        (json!({"type": "which", "attribute": "age"}), "the scene has no attribute \"age\""),
        (json!({"type": "point", "object": "cup"}), "the scene has no object \"cup\""),
        (
            json!({"type": "attr", "attribute": "color", "value": "big"}),
            "attribute \"color\" has no value \"big\"",
        ),
        (
            json!({"type": "choice", "attribute": "color", "values": ["white", "big"]}),
            "attribute \"color\" has no value \"big\"",
        ),
        (
            json!({"type": "choice", "attribute": "color", "values": ["white", "white"]}),
            "\"values\" is not a list of 2 to 4 values",
        ),
    ];
    for (json, expected) in cases {
        let error = question_from_json(&bowls, &json).expect_err("not a question");
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn reading_json_uses_the_scene_words() {
    let bowls = shipped(BOWLS);
    let word = |name| bowls.word_named(name).expect("a word");
    let reading = Reading {
        base: vec![word("white"), word("white")],
        excluded: vec![vec![word("small"), word("clear")]],
        ..Reading::default()
    };
    assert_eq!(
        reading_to_json(&bowls, &reading),
        json!({"base": ["white", "white"], "response": "none",
               "excluded": [["small", "clear"]], "intent": "inform"})
    );
}

/// A scene of any size and shape, as JSON: up to 6 attributes with up to 5 values that attributes
/// may share, and up to 12 objects that may lack some.
fn any_scene() -> impl Strategy<Value = serde_json::Value> {
    let values = proptest::collection::vec(1..5_usize, 1..6);
    let objects = proptest::collection::vec(proptest::collection::vec(0..6_usize, 6), 1..12);
    (values, objects).prop_map(|(counts, objects)| {
        let name = |k: usize, v: usize| format!("v{}", v + k % 2);
        let values: serde_json::Map<_, _> = (counts.iter().enumerate())
            .map(|(k, &n)| (format!("k{k}"), json!((0..n).map(|v| name(k, v)).collect::<Vec<_>>())))
            .collect();
        let objects = objects.iter().enumerate().map(|(i, row)| {
            let own = row.iter().zip(&counts).enumerate().filter(|(_, (v, n))| v < n);
            let own = own.map(|(k, (&v, _))| (format!("k{k}"), json!(name(k, v))));
            json!({"name": format!("o{i}"), "attributes": own.collect::<serde_json::Map<_, _>>()})
        });
        json!({"objects": objects.collect::<Vec<_>>(), "values": values})
    })
}

proptest! {
    #[test]
    fn json_form_goes_round(json in any_scene()) {
        let scene = Scene::from_json("s", &json).expect("a scene");
        let again = Scene::from_json("s", &scene.to_json()).expect("its own form");
        prop_assert_eq!(scene, again);
    }

    #[test]
    fn vocabulary_is_the_set_of_an_objects_values(json in any_scene()) {
        let scene = Scene::from_json("s", &json).expect("a scene");
        for i in (0..scene.objects().len()).map(ObjectId::from) {
            let values = scene.object(i).values.iter().zip(scene.attributes());
            let own: std::collections::BTreeSet<&str> =
                values.filter_map(|(v, a)| v.map(|v| &*a.values[v.index()].name)).collect();
            prop_assert_eq!(scene.vocabulary_len(i), own.len());
            for w in (0..scene.words().len()).map(WordId::from) {
                prop_assert_eq!(scene.has_word(i, w), own.contains(&*scene.words()[w.index()]));
            }
        }
    }

    #[test]
    fn every_question_goes_round(json in any_scene()) {
        let scene = Scene::from_json("s", &json).expect("a scene");
        for question in all_questions(&scene) {
            prop_assert!(scene.contains(question));
            let back = question_from_json(&scene, &question_to_json(&scene, question));
            prop_assert_eq!(back, Ok(question));
        }
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>()) {
        let _ = Scene::from_toml("x", &text);
    }
}

#[test]
fn names_of_a_value_are_replaced_as_whole_words() {
    let scene = shipped(BOWLS);
    let attributes = scene.attributes().iter().flat_map(|attribute| &attribute.values);
    let value = attributes.into_iter().find(|value| value.name == "white").unwrap();
    for (phrase, expected) in [
        ("white", "ivory"),
        ("the white, off-white one", "the ivory, off-ivory one"),
        ("whitewashed white", "whitewashed ivory"),
        ("snowwhite", "snowwhite"),
    ] {
        assert_eq!(value.with_name(phrase, "ivory"), expected);
    }
}
