//! The robot's own descriptions are read as the values that they are of.

use ::vocabulary::Language;
use scene::{AttributeId, Question, Scene, ValueId};

use crate::Reader;

include!("../../../scene/src/tests/wordings_table.rs");

/// Descriptions that are not yet read as the values that they are of; the number may only fall.
const LEFT: usize = 10; // 12 before any rule, of 324

#[test]
fn descriptions_are_read_as_the_values_that_they_are_of() {
    let (mut all, mut wrong) = (0, Vec::new());
    for head in TABLE.lines().filter(|line| !line.starts_with('#') && is_scene(line)) {
        let scene = Scene::from_toml("table.toml", &scene_text(head)).expect("a scene");
        let reader = Reader::new(&scene, Language::Careful);
        for (k, attribute) in scene.attributes().iter().enumerate() {
            for (v, value) in attribute.values.iter().enumerate() {
                let (k, v) = (AttributeId::from(k), ValueId::from(v));
                let description = scene.request_for(&[(k, v)]);
                let answer = description.replacen("get me ", "", 1);
                let said = [
                    (description, Question::None),
                    (answer, Question::Which(k)),
                    (value.spoken.clone(), Question::Which(k)),
                ];
                for (text, asked) in said {
                    all += 1;
                    let read = reader.read(&text, asked);
                    let is_right = |word: &scene::WordId| *word == value.word;
                    let is_read = !read.base.is_empty() && read.base.iter().all(is_right);
                    if !is_read || !read.excluded.is_empty() {
                        let name = |word: &scene::WordId| &scene.words()[word.index()];
                        let base: Vec<_> = read.base.iter().map(name).collect();
                        let no: Vec<_> = read.excluded.iter().flatten().map(name).collect();
                        wrong.push(format!("{}: {text}: {base:?}, no {no:?}", value.name));
                    }
                }
            }
        }
    }
    assert_eq!(wrong.len(), LEFT, "of {all}:\n{}", wrong.join("\n"));
}
