//! Belief, decision and reading.

use dialogue::{Belief, DecisionProblem, Lookahead, Model, Planner, Step};
use language::Reader;
use scene::{AttributeId, Question, Reading, Response, Scene, ValueId};
use serde_json::{Value, json};
use std::hint::black_box;
use vocabulary::{Actions, Costs, Language, Mode, Params, Rng};

const ATTRIBUTES: [&str; 3] = ["colour", "size", "place"];
const VALUES: [&str; 4] = ["one", "two", "three", "four"];
const UTTERANCES: [&str; 4] = [
    "get me the small white plastic bowl from the counter",
    "no, not the metal one",
    "I don't know",
    "the other one, please",
];

/// The six bowls of the configuration.
pub(crate) fn bowls() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/scenes/bowls.toml");
    let text = std::fs::read_to_string(path).expect("a readable scene");
    Scene::from_toml("bowls.toml", &text).expect("a valid scene")
}

/// Objects with random values.
fn random(objects: usize) -> Model {
    let mut rng = Rng::new(objects as u64);
    let mut value = |k: &str| format!("{k} {}", VALUES[rng.below(VALUES.len())]);
    let objects: Vec<Value> = (0..objects)
        .map(|i| {
            let values: serde_json::Map<_, _> =
                ATTRIBUTES.iter().map(|k| ((*k).to_owned(), value(k).into())).collect();
            json!({ "name": format!("o{i}"), "attributes": values })
        })
        .collect();
    let all = |k: &str| VALUES.iter().map(|v| format!("{k} {v}")).collect::<Vec<_>>();
    let values: serde_json::Map<_, _> =
        ATTRIBUTES.iter().map(|k| ((*k).to_owned(), all(k).into())).collect();
    let json = json!({ "objects": objects, "values": values });
    Model::new(&Scene::from_json("random", &json).expect("a valid scene"), Params::default())
}

/// Yes and no in turn.
pub(crate) fn update(objects: usize, times: u32) {
    let model = random(objects);
    let question = Question::Attribute(AttributeId(1), ValueId(2));
    let readings =
        [Response::Yes, Response::No].map(|response| Reading { response, ..Reading::default() });
    let mut belief = Belief::uniform(model.objects());
    for n in 0..times {
        belief.update(&model, question, black_box(&readings[n as usize % 2]));
        black_box(&belief);
    }
}

/// A new planner for each decision, so that nothing is remembered.
pub(crate) fn lookahead(times: u32) {
    let model = Model::new(&bowls(), Params::default());
    let actions = Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
    let problem = DecisionProblem::new(&model, Costs::SECONDS, actions);
    let belief = Belief::uniform(model.objects());
    for _ in 0..times {
        black_box(Lookahead::default().decide(&problem, black_box(&belief), Step::default()));
    }
}

/// All of the utterances each time.
pub(crate) fn read(times: u32) {
    let reader = Reader::new(&bowls(), Language::Careful);
    for _ in 0..times {
        for text in UTTERANCES {
            black_box(reader.readings(black_box(text), &[], Question::None));
        }
    }
}
