//! Scenes in TOML and JSON.

use language::Reader;

use scene::{Question, Scene};
use vocabulary::Language;

use super::bytes::{Input, chosen, project_file};

/// Objects up to which a scene is also used: preparing words takes time that grows with them.
const OBJECTS_MAX: usize = 24;

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let kind = input.byte() % 2;
    let text = String::from_utf8_lossy(input.0);
    let read = match kind {
        0 => Scene::from_toml("fuzz.toml", &text),
        _ => match serde_json::from_str(&text) {
            Ok(json) => Scene::from_json("fuzz.json", &json),
            Err(_) => return,
        },
    };
    match read {
        Ok(scene) => use_it(&scene),
        Err(problems) => {
            assert!(problems.iter().count() > 0);
            for problem in problems.iter() {
                assert!(problem.file.starts_with("fuzz."), "{problem}");
                assert!(!problem.what.is_empty(), "{problem}");
                let place = problem.line.is_some() || !problem.key.is_empty();
                assert!(place || kind == 1, "no place: {problem}");
            }
        }
    }
}

fn use_it(scene: &Scene) {
    let again = Scene::from_json("again", &scene.to_json());
    let again = again.unwrap_or_else(|problems| panic!("refused its own JSON: {problems}"));
    assert_eq!(again.key(), scene.key());
    assert!(!scene.objects().is_empty());
    if scene.objects().len() <= OBJECTS_MAX {
        let reader = Reader::new(scene, Language::Careful);
        let said = scene.words().join(" or ");
        reader.readings(&said, &[], Question::None);
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let toml = ["bowls", "markers", "tools"].map(|name| format!("config/scenes/{name}.toml"));
    let json = ["bowls", "tools"].map(|name| format!("tests/fixtures/scenes/{name}.json"));
    let toml = toml.iter().map(|path| chosen(0, project_file(path)));
    toml.chain(json.iter().map(|path| chosen(1, project_file(path)))).collect()
}
