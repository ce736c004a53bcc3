//! The reader understands the robot: every value of every scene as its questions name it.

use ::vocabulary::Language;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use scene::{AttributeId, Question, Response, Role, Scene, ValueId, WordFindings};

use super::scene;

use crate::Reader;
use crate::own_words::own_words;
use crate::word_findings;

const ADJECTIVES: &str = "\
    red, dark green, striped, wooden, small, medium, large, round, old, new, clean, dirty, \
    broken, open, closed, full, empty, heavy, light blue, soft, shiny, left, right, top, \
    second, plain, cold, hot, cheap, half full, metal, stainless steel, thin, spotted, navy, \
    extra large, clear, see-through";
const KINDS: &str = "\
    mug, cup, plate, fork, spoon, tea cup, wine glass, book, cookbook, box, jar, pen, \
    felt tip, stapler, teddy bear, train, sock, knife, towel, key, water bottle, toy car, \
    apple, egg, orange, lamp, hammer, screwdriver";
const PLACES: &str = "\
    sink, door, fridge, table, shelf, top shelf, bottom drawer, window, stove, bed, desk, \
    toolbox, counter, cupboard, dishwasher, chair, lamp, plant, washing machine, armchair, \
    bookcase, left tray, wall, bin, coffee machine";
const RELATIONS: &str = "\
    in, on, at, next to, near, by, beside, close to, under, underneath, behind, above, below, \
    on top of, inside, in front of, to the left of";

const SHIPPED: &str = "\
    bowls, tools, markers, garments, pantry, mugs, talk_books, talk_clothes, talk_cutlery, \
    talk_medicine, talk_mugs, talk_office, talk_toys, talk_workshop";

fn listed(words: &str) -> Vec<&str> {
    words.split(", ").collect()
}

/// Everything that a person who repeats the robot's words might say of a value.
fn echoes(scene: &Scene, k: usize, v: usize) -> Vec<String> {
    let value = &scene.attributes()[k].values[v];
    let spoken = &value.spoken;
    let mut texts = vec![
        spoken.clone(),
        format!("it is {spoken}"),
        format!("it's {spoken}"),
        format!("Is it {spoken}?"),
        format!("yes, it is {spoken}"),
        format!("I want the one that is {spoken}"),
    ];
    match value.role() {
        Role::Quality => texts.push(format!("the {spoken} one")),
        Role::Place | Role::Part => {
            let after = value.after_noun();
            texts.push(format!("the one {after}"));
            if scene.word_named(scene.noun()).is_none() {
                texts.push(format!("get me the {} {after}", scene.noun()));
            }
        }
        Role::Kind => texts.push(format!("get me {spoken}, please")),
    }
    texts
}

/// Returns the misread phrases of one value.
fn misread(scene: &Scene, reader: &Reader, k: usize, v: usize) -> Vec<String> {
    let word = scene.attributes()[k].values[v].word;
    let asked = Question::Attribute(AttributeId::from(k), ValueId::from(v));
    let mut failures = Vec::new();
    for text in echoes(scene, k, v) {
        for question in [Question::None, asked] {
            let read = reader.read(&text, question);
            let answers = question == Question::None || read.response == Response::Yes;
            if read.base != [word] || !read.excluded.is_empty() || !answers {
                failures.push(format!("{text:?} {question:?} read as {read:?}"));
            }
        }
    }
    failures
}

fn all_misread(scene: &Scene) -> Vec<String> {
    let reader = Reader::new(scene, Language::Careful);
    let values = scene.attributes().iter().enumerate();
    let values = values.flat_map(|(k, attribute)| (0..attribute.values.len()).map(move |v| (k, v)));
    values.flat_map(|(k, v)| misread(scene, &reader, k, v)).collect()
}

#[test]
fn reader_understands_the_robots_words_in_shipped_scenes() {
    for name in listed(SHIPPED) {
        let failures = all_misread(&scene(name));
        assert!(failures.is_empty(), "{name}: {failures:#?}");
    }
}

/// A scene of these words; a word that two attributes would share goes to the first.
fn generated<'a>(
    noun: &'a str,
    adjectives: &[&'a str],
    kinds: &[&'a str],
    places: &[(&str, &'a str)],
) -> Option<Scene> {
    let mut taken = vec![noun];
    let mut values = |named: Vec<(&'a str, String)>| -> String {
        let is_new = |(name, _): &(&'a str, String)| {
            taken.push(name);
            !taken[..taken.len() - 1].contains(name)
        };
        let value = |(name, spoken)| format!("{{ name = {name:?}, spoken = {spoken:?} }}, ");
        named.into_iter().filter(is_new).map(value).collect()
    };
    let article = |name: &str| if name.starts_with(['a', 'e', 'o']) { "an" } else { "a" };
    let kinds = kinds.iter().map(|name| (*name, format!("{} {name}", article(name)))).collect();
    let qualities = adjectives.iter().map(|name| (*name, (*name).to_owned())).collect();
    let places = places.iter().map(|(at, name)| (*name, format!("{at} the {name}"))).collect();
    let attributes =
        [("kind", values(kinds)), ("look", values(qualities)), ("place", values(places))];
    let attributes: String = attributes
        .iter()
        .filter(|(_, values)| !values.is_empty())
        .map(|(name, values)| format!("[[attributes]]\nname = \"{name}\"\nvalues = [{values}]\n"))
        .collect();
    let text = format!("name = \"s\"\nnoun = \"{noun}\"\n{attributes}[[objects]]\nname = \"a\"\n");
    Scene::from_toml("generated", &text).ok()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn reader_understands_the_robots_words(
        noun in select(&["thing", "object", "mug", "tool", "item"][..]),
        adjectives in prop::sample::subsequence(listed(ADJECTIVES), 1..6),
        kinds in prop::sample::subsequence(listed(KINDS), 1..5),
        places in prop::sample::subsequence(listed(PLACES), 1..6),
        relations in prop::collection::vec(any::<Index>(), 6),
    ) {
        let known = listed(RELATIONS);
        let relations = relations.iter().map(|at| *at.get(&known));
        let places: Vec<(&str, &str)> = relations.zip(places).collect();
        let scene = generated(noun, &adjectives, &kinds, &places).expect("a scene");
        let failures = all_misread(&scene);
        prop_assert!(failures.is_empty(), "{failures:#?}");
    }
}

#[test]
fn scenes_are_told_of_words_that_are_the_robots_own() {
    for name in listed(SHIPPED) {
        assert_eq!(own_words(&scene(name)), [] as [&str; 0], "{name}");
    }
    let text = "name = 's'\nnoun = 'record'\n[[attributes]]\nname = 'title'\n\
                values = ['stop', 'hold on', { name = 'queen', synonyms = ['Yes'] }, 'one', 'right', \
                'stop sign']\n[[objects]]\nname = 'a'\nattributes = { title = 'stop' }\n";
    let found = own_words(&Scene::from_toml("s", text).expect("a scene"));
    let is_told = |part: &str| found.iter().any(|line| line.contains(part));
    assert!(is_told("\"stop\", a value of `title`, halts the arm"), "{found:#?}");
    assert!(is_told("\"hold on\", a value of `title`, halts the arm"), "{found:#?}");
    assert!(
        is_told("\"yes\", a value of `title`, is understood as \"title yes\" only"),
        "{found:#?}"
    );
    assert!(is_told("\"one\", a value of `title`"), "{found:#?}");
    assert_eq!(found.len(), 4, "{found:#?}");
}

#[test]
fn a_can_is_one_but_where_somebody_asks() {
    let text = "name = 's'\nnoun = 'item'\n[[attributes]]\nname = 'container'\n\
                values = ['can', { name = 'jar', spoken = 'in a jar' }]\n\
                [[objects]]\nname = 'a'\nattributes = { container = 'can' }\n";
    let scene = Scene::from_toml("s", text).expect("a scene");
    let reader = Reader::new(&scene, Language::Careful);
    for (text, base) in [
        ("can you get me the jar", &["jar"][..]),
        ("can i have the jar please", &["jar"]),
        ("can you get me the can", &["can"]),
        ("the can please", &["can"]),
    ] {
        let read = reader.read(text, Question::None);
        let words: Vec<&str> = read.base.iter().map(|it| &*scene.words()[it.index()]).collect();
        assert_eq!(words, base, "{text}");
    }
}

#[test]
fn shipped_scenes_read_back_without_a_fault() {
    for name in listed(SHIPPED) {
        assert_eq!(word_findings(&scene(name)), WordFindings::default(), "{name}");
    }
}

#[test]
fn words_that_are_read_as_others_are_problems() {
    let found = |values: &str| {
        let text = format!(
            "name = 's'\nnoun = 'box'\n[[attributes]]\nname = 'label'\nvalues = [{values}]\n\
             [[objects]]\nname = 'a'\nattributes = {{ label = 'red' }}\n"
        );
        word_findings(&Scene::from_toml("s", &text).expect("a scene"))
    };
    assert_eq!(
        found("'red', 'A/B', 'v1.2', 'Dr. Lee', '2.5 kg', 'right'"),
        WordFindings::default()
    );
    for (values, key, part) in [
        ("'red', '???'", "attributes[0].values[1]", "expected a plain phrase for `???`"),
        ("'red', 'the red one'", "attributes[0].values[0]", "found `the red one`"),
    ] {
        let found = found(values);
        let problem = found.problems.first().unwrap_or_else(|| panic!("{values}: {found:?}"));
        assert!(problem.key == key && problem.what.contains(part), "{problem:?}");
    }
}
