//! Scenes and readings for the tests of this crate.

use scene::{ObjectId, Perceived, Question, Reading, Response, Scene};
use serde_json::{Value as Json, json};
use vocabulary::{Costs, Durations, Rng};

use crate::{Answer, Model};

pub(crate) fn scene(text: &str) -> Scene {
    let json: Json = serde_json::from_str(text).unwrap();
    scene_of(&json)
}

pub(crate) fn scene_of(json: &Json) -> Scene {
    Scene::from_json("test", json).unwrap_or_else(|problems| panic!("{problems:?}"))
}

/// The paper's six bowls (section 6).
pub(crate) fn bowls() -> Scene {
    scene(include_str!("../../../tests/fixtures/scenes/bowls.json"))
}

/// Ten tools.
pub(crate) fn tools() -> Scene {
    scene(include_str!("../../../tests/fixtures/scenes/tools.json"))
}

/// The two markers of section 4.1.
pub(crate) fn markers() -> Scene {
    scene(
        r#"{"objects":[{"name":"R","attributes":{"color":"red"}},
            {"name":"B","attributes":{"color":"blue"}}],"values":{"color":["red","blue"]}}"#,
    )
}

/// Objects with random values; about one in `lacking` values is missing (0: none).
pub(crate) fn random_scene(
    rng: &mut Rng,
    objects: usize,
    values: &[usize],
    lacking: usize,
) -> Scene {
    let named = |k: usize, v: usize| format!("a{k}v{v}");
    let mut list = Vec::new();
    for i in 0..objects {
        let mut attributes = serde_json::Map::new();
        for (k, &count) in values.iter().enumerate() {
            if lacking == 0 || rng.below(lacking) > 0 {
                attributes.insert(format!("a{k}"), json!(named(k, rng.below(count))));
            }
        }
        list.push(json!({ "name": format!("o{i}"), "attributes": attributes }));
    }
    let all: serde_json::Map<String, Json> = (values.iter().enumerate())
        .map(|(k, &count)| {
            (format!("a{k}"), json!((0..count).map(|v| named(k, v)).collect::<Vec<_>>()))
        })
        .collect();
    scene_of(&json!({ "objects": list, "values": all }))
}

pub(crate) fn heard(scene: &Scene, words: &[&str], response: Response) -> Reading {
    let base = words.iter().map(|word| scene.word_named(word).unwrap()).collect();
    Reading { base, response, ..Reading::default() }
}

/// An answer of a user who wants that object, drawn with the probabilities that the model expects.
pub(crate) fn drawn(rng: &mut Rng, model: &Model, question: Question, wanted: ObjectId) -> Answer {
    let answers = Answer::possible(model, question);
    let chances = answers.iter().map(|answer| answer.probability(model, question, wanted));
    rng.index(chances).map_or(Answer::Silence, |index| answers[index])
}

pub(crate) fn everyone(count: usize) -> impl Iterator<Item = ObjectId> {
    (0..count).map(ObjectId::from)
}

/// Every question at its uniform cost, as if that had been measured.
pub(crate) fn uniform(model: &Model, costs: Costs) -> Durations {
    let attributes = 0..model.attributes();
    let values = |k: usize| vec![costs.attribute_s; model.values(k.into())];
    Durations {
        attribute: attributes.clone().map(values).collect(),
        which: attributes.map(|_| costs.which_s).collect(),
        point: vec![costs.point_s; model.objects()],
        pick: Vec::new(),
    }
}

/// Every question at a cost of its own between half and twice the uniform one.
pub(crate) fn random_durations(rng: &mut Rng, model: &Model, costs: Costs) -> Durations {
    let mut own = uniform(model, costs);
    let lists = own.attribute.iter_mut().chain([&mut own.which, &mut own.point]);
    lists.flatten().for_each(|seconds| *seconds *= 0.5 + 1.5 * rng.uniform());
    own
}

/// The scene's objects as perceived: about half of the values in doubt.
pub(crate) fn perceived(rng: &mut Rng, scene: &Scene) -> Scene {
    let chances = |rng: &mut Rng, k: usize| {
        let values = scene.attributes()[k].values.iter();
        values.map(|value| (value.name.clone(), rng.uniform())).collect::<Vec<_>>()
    };
    let objects = scene.objects().iter().zip(100..).map(|(object, number)| {
        let all = 0..scene.attributes().len();
        let doubtful: Vec<usize> = all.filter(|_| rng.below(2) == 0).collect();
        let attributes = doubtful.into_iter().map(|k| {
            let mut values = chances(rng, k);
            let sum: f64 = values.iter().map(|(_, p)| p).sum();
            values.iter_mut().for_each(|(_, p)| *p /= sum);
            (scene.attributes()[k].name.clone(), values)
        });
        Perceived {
            number: ObjectId(number),
            name: format!("{}-{number}", object.name),
            attributes: attributes.collect(),
            classes: vec![(object.name.clone(), 1.0)],
            xyz: [0.0; 3],
            yaw: 0.0,
            seen_by: Vec::new(),
            taken: false,
        }
    });
    scene.with_objects(&objects.collect::<Vec<_>>())
}
