//! `whichone belief`: the posterior after a dialogue.

use std::io::Read;

use command_line::Outcome;
use command_line::output::Output;
use dialogue::{Belief, Model};
use language::Reader;
use scene::{Question, Reading, Response, Scene, question_from_json};
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};
use vocabulary::{Language, Params};

use super::{parse, run};

/// One dialogue about one scene.
#[derive(Deserialize)]
struct Case {
    #[serde(default)]
    id: Json,
    scene: Json,
    #[serde(default)]
    params: Params,
    #[serde(default)]
    prior: Json,
    #[serde(default)]
    turns: Vec<Turn>,
}

/// A question and the utterance that followed it.
#[derive(Deserialize)]
struct Turn {
    #[serde(default)]
    question: Json,
    #[serde(default)]
    utterance: Option<String>,
    #[serde(default)]
    l_b: Option<Vec<String>>,
    #[serde(default)]
    l_r: Option<Response>,
}

/// Answers each case with `{"id","belief":{object:probability}}`, objects in the scene's order.
///
/// # Errors
/// See [`run`].
pub fn belief(input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| answer(parse(line)?))
}

fn answer(case: Case) -> Result<Json, String> {
    let scene = Scene::from_json("scene", &case.scene).map_err(|problems| {
        let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
        lines.join("; ")
    })?;
    let faults: Vec<String> =
        case.params.check().iter().map(|(key, what, _)| format!("params.{key}: {what}")).collect();
    if !faults.is_empty() {
        return Err(faults.join("; "));
    }
    let mut belief = prior(&scene, &case.prior).map_err(|error| format!("prior: {error}"))?;
    let model = Model::new(&scene, case.params);
    let mut reader = PaperReader { scene: &scene, reader: None };
    for (n, turn) in case.turns.iter().enumerate() {
        let (question, reading) =
            reader.understand(turn).map_err(|error| format!("turns[{n}]: {error}"))?;
        belief.update(&model, question, &reading);
    }
    let names = scene.objects().iter().map(|object| object.name.clone());
    let probabilities = belief.probabilities().into_iter().map(Json::from);
    let belief: Map<String, Json> = names.zip(probabilities).collect();
    Ok(json!({ "id": case.id, "belief": belief }))
}

/// Parses a prior: `"uniform"`, the default, or `{object:weight}`, where unnamed objects have
/// weight 0.
fn prior(scene: &Scene, json: &Json) -> Result<Belief, String> {
    let objects = scene.objects().len();
    let weights = match json {
        Json::Null => return Ok(Belief::uniform(objects)),
        Json::String(name) if name == "uniform" => return Ok(Belief::uniform(objects)),
        Json::Object(weights) => weights,
        _ => return Err("write \"uniform\" or {object: probability}".to_owned()),
    };
    let mut probabilities = vec![0.0; objects];
    for (name, weight) in weights {
        let object = scene.object_named(name);
        let object = object.ok_or_else(|| format!("the scene has no object \"{name}\""))?;
        let weight = weight.as_f64().ok_or_else(|| format!("\"{name}\" has no number"))?;
        probabilities[object.index()] = weight;
    }
    Belief::from_probabilities(&probabilities).map_err(|error| error.to_string())
}

/// Reader in the paper's mode, created when the first turn needs it.
struct PaperReader<'a> {
    scene: &'a Scene,
    reader: Option<Reader>,
}

impl PaperReader<'_> {
    /// Returns the question and the reading of a turn: as given, else read from the utterance.
    fn understand(&mut self, turn: &Turn) -> Result<(Question, Reading), String> {
        let question =
            question_from_json(self.scene, &turn.question).map_err(|error| error.to_string())?;
        let mut reading = match &turn.utterance {
            Some(text) if turn.l_b.is_none() || turn.l_r.is_none() => self.read(text, question),
            _ => Reading::default(),
        };
        if let Some(words) = &turn.l_b {
            // Words outside V are not base words: the model has no factor for them.
            reading.base = words.iter().filter_map(|w| self.scene.word_named(w)).collect();
        }
        if let Some(response) = turn.l_r {
            reading.response = response;
        }
        Ok((question, reading))
    }

    fn read(&mut self, text: &str, question: Question) -> Reading {
        let new = || Reader::new(self.scene, Language::Paper);
        self.reader.get_or_insert_with(new).read(text, question)
    }
}
