//! Scenes to measure on: those of the configuration, and random ones of any size.

use dialogue::{Belief, DecisionProblem, Model};
use evaluation::simulation::users::ModelUser;
use scene::{Attribute, ObjectId, Perceived, Scene};
use serde_json::{Map, Value, json};
use vocabulary::{Actions, Mode, Params, Rng};

/// Values of an attribute in random scenes.
pub(super) const VALUES: usize = 6;

pub(super) const YES_NO: Actions =
    Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
pub(super) const OPEN: Actions =
    Actions { mode: Mode::Remote, attribute: true, which: true, choice: false };
pub(super) const PRESENT: Actions =
    Actions { mode: Mode::Present, attribute: true, which: false, choice: false };
pub(super) const PRESENT_OPEN: Actions =
    Actions { mode: Mode::Present, attribute: true, which: true, choice: false };
pub(super) const POINTING: Actions =
    Actions { mode: Mode::Present, attribute: false, which: false, choice: false };

/// A scene of the configuration.
pub(crate) fn configured(name: &str) -> Scene {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/scenes");
    let text = std::fs::read_to_string(format!("{root}/{name}.toml")).expect("a scene");
    Scene::from_toml(name, &text).expect("a scene that holds")
}

/// The objects of a scene as a camera reports them: every value is in doubt, more or less.
pub(super) fn in_doubt(scene: &Scene) -> Scene {
    let chances = |(k, attribute): (usize, &Attribute), i: usize| {
        let (own, others) = (scene.objects()[i].values[k], attribute.values.len() - 1);
        let sure = 0.6 + 0.05 * ((i + k) % 7) as f64;
        let of = |v: usize| match own == Some(v.into()) {
            true => sure,
            false => (1.0 - sure) / others as f64,
        };
        let values = attribute.values.iter().enumerate();
        (attribute.name.clone(), values.map(|(v, value)| (value.name.clone(), of(v))).collect())
    };
    let perceived = scene.objects().iter().enumerate().map(|(i, object)| Perceived {
        number: ObjectId::from(scene.objects().len() + i),
        name: object.name.clone(),
        classes: vec![(object.name.clone(), 1.0)],
        attributes: scene.attributes().iter().enumerate().map(|it| chances(it, i)).collect(),
        xyz: [0.0; 3],
        yaw: 0.0,
        seen_by: Vec::new(),
        taken: false,
    });
    scene.with_objects(&perceived.collect::<Vec<_>>())
}

/// A model of objects with random values.
pub(super) fn random(objects: usize, attributes: usize) -> Model {
    drawn(objects, attributes, 0)
}

/// One of many such models.
pub(super) fn drawn(objects: usize, attributes: usize, draw: u64) -> Model {
    let mut rng = Rng::new(1_000_003 * objects as u64 + attributes as u64 + 7_919 * draw);
    let name = |k: usize, v: usize| format!("a{k}v{v}");
    let object = |i: usize| {
        let values = (0..attributes)
            .map(|k| (format!("a{k}"), Value::from(name(k, rng.below(VALUES)))))
            .collect::<Map<_, _>>();
        json!({ "name": format!("o{i}"), "attributes": values })
    };
    let objects: Vec<Value> = (0..objects).map(object).collect();
    let values: Map<String, Value> = (0..attributes)
        .map(|k| (format!("a{k}"), (0..VALUES).map(|v| name(k, v)).collect()))
        .collect();
    let json = json!({ "objects": objects, "values": values });
    let scene = Scene::from_json("random", &json).expect("a scene that holds");
    Model::new(&scene, Params::default())
}

/// Beliefs that dialogues lead to: those of people who answer as the model says, while the robot
/// asks what `entropy` asks.
pub(super) fn beliefs(problem: &DecisionProblem<'_>, dialogues: u64) -> Vec<Belief> {
    let mut planner = dialogue::registry::planner("entropy").expect("a planner of that name");
    let mut beliefs = Vec::new();
    for seed in 0..dialogues {
        let mut user = ModelUser::wanting_any(problem.model, seed);
        let mut belief = Belief::uniform(problem.model.objects());
        for step in 0..6 {
            beliefs.push(belief.clone());
            let step = dialogue::Step { interaction: seed, step };
            let decision = planner.decide(problem, &belief, step);
            let vocabulary::Action::Ask(question) = decision.action else { break };
            let answer = user.answer(problem.model, question);
            belief.update(problem.model, question, &answer.reading(problem.model));
        }
    }
    beliefs
}
