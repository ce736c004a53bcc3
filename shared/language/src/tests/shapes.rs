//! Values that are not plain adjectives, nouns or places: parts, numbers, names, words of dialogue.

use ::vocabulary::Language;
use scene::{Question, Response, Scene};

use crate::Reader;

/// Attribute, values and their `spoken` forms.
const SCENES: [(&str, &str); 5] = [
    (
        "caddy",
        "[[attributes]]\nname = 'filling'\nvalues = [{ name = 'lentils', spoken = 'with lentils' }, \
         { name = 'screws', spoken = 'full of screws' }, { name = 'nuts', spoken = 'with nuts' }]\n",
    ),
    (
        "pan",
        "[[attributes]]\nname = 'handle'\nvalues = [{ name = 'green', spoken = 'a green handle' }, \
         { name = 'black', spoken = 'a black handle' }]\n[[attributes]]\nname = 'kind'\n\
         values = [{ name = 'wok', spoken = 'a wok' }, { name = 'pan', spoken = 'a pan' }]\n",
    ),
    (
        "flask",
        "[[attributes]]\nname = 'volume'\nvalues = ['0.25 l', '2.5 l', '5 l']\n[[attributes]]\nname = 'label'\n\
         values = ['A/B', 'v1.2', 'Dr. Lee', '9:40']\n",
    ),
    (
        "key",
        "[[attributes]]\nname = 'hook'\nvalues = ['left', 'right', 'other']\n[[attributes]]\nname = 'number'\n\
         values = ['one', 'two']\n[[attributes]]\nname = 'spare'\nvalues = ['yes', 'no']\n[[attributes]]\n\
         name = 'tag'\nvalues = ['stop', 'go']\n",
    ),
    (
        "tool",
        "[[attributes]]\nname = 'type'\nrole = 'kind'\nvalues = ['flashlight', 'screwdriver', 'hammer', 'claw hammer']\n",
    ),
];

/// Noun of the scene, utterance, values wanted, values denied.
const SAID: &[(&str, &str, &[&str], &[&str])] = &[
    ("caddy", "get me the lentils", &["lentils"], &[]),
    ("caddy", "some nuts", &["nuts"], &[]),
    ("caddy", "could you bring the nuts over here", &["nuts"], &[]),
    ("caddy", "can I have a nut", &["nuts"], &[]),
    ("caddy", "the caddy full of screws", &["screws"], &[]),
    ("caddy", "nto the lentils, the screws", &["screws"], &["lentils"]),
    ("pan", "the green one", &["green"], &[]),
    ("pan", "the wok with a black handle", &["black", "wok"], &[]),
    ("pan", "the wok wihtout a green handle", &["wok"], &["green"]),
    ("pan", "anything excpet the wok", &[], &["wok"]),
    ("flask", "get me the 2.5 l flask", &["2.5 l"], &[]),
    ("flask", "not the 0.25 l one", &[], &["0.25 l"]),
    ("flask", "the 7.5 l one", &[], &[]),
    ("flask", "the A/B flask", &["A/B"], &[]),
    ("flask", "v1.2 or Dr. Lee's", &["v1.2", "Dr. Lee"], &[]),
    ("flask", "the one from 9:40", &["9:40"], &[]),
    ("key", "the left one", &["left"], &[]),
    ("key", "the one on the other hook", &["other"], &[]),
    ("key", "number one", &["one"], &[]),
    ("key", "spare yes", &["yes"], &[]),
    ("key", "the stop key", &["stop"], &[]),
    ("tool", "not the light", &[], &["flashlight"]),
    ("tool", "hand me the driver", &["screwdriver"], &[]),
];

fn scene(noun: &str) -> Scene {
    let (_, attributes) = SCENES.iter().find(|(name, _)| *name == noun).expect("listed");
    let text = format!("name = 's'\nnoun = '{noun}'\n{attributes}[[objects]]\nname = 'a'\n");
    Scene::from_toml(noun, &text).expect("a scene")
}

#[test]
fn values_of_every_shape_can_be_said() {
    for (noun, text, wanted, denied) in SAID {
        let scene = scene(noun);
        let read = Reader::new(&scene, Language::Careful).read(text, Question::None);
        let name = |word: &scene::WordId| scene.words()[word.index()].as_str();
        let mut base: Vec<&str> = read.base.iter().map(name).collect();
        let excluded: Vec<&str> = read.excluded.iter().flatten().map(name).collect();
        base.sort_by_key(|value| wanted.iter().position(|wanted| wanted == value));
        assert_eq!((&base[..], &excluded[..]), (*wanted, *denied), "{text}");
    }
}

#[test]
fn answers_stay_answers_beside_values_of_their_name() {
    let scene = scene("key");
    let reader = Reader::new(&scene, Language::Careful);
    let asked = |attribute: &str, value: &str| {
        let k = scene.attribute_named(attribute).expect("listed");
        Question::Attribute(k, scene.value_named(k, value).expect("listed"))
    };
    for (attribute, value, said, response) in [
        ("hook", "left", "that's right", Response::Yes),
        ("hook", "left", "right", Response::Yes),
        ("hook", "right", "right", Response::Yes),
        ("hook", "left", "the right one", Response::No),
        ("spare", "yes", "no", Response::No),
        ("spare", "no", "yes", Response::Yes),
    ] {
        let read = reader.read(said, asked(attribute, value));
        assert_eq!(read.response, response, "{attribute} {value}: {said}");
    }
}
