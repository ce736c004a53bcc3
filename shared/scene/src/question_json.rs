//! Questions and readings as JSON, for batch tools and tests.

use serde_json::{Value as Json, json};

use crate::{AttributeId, Intent, Options, Question, Reading, Response, Scene, ValueId};

/// An invalid question in JSON, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct QuestionError(String);

/// Reads `{"type":"none"}` (or `null`), `{"type":"point","object":ID}`,
/// `{"type":"attr","attribute":K,"value":V}`, `{"type":"which","attribute":K}` or
/// `{"type":"choice","attribute":K,"values":[V,…]}`.
///
/// # Errors
/// The first thing that is invalid in this scene.
pub fn question_from_json(scene: &Scene, json: &Json) -> Result<Question, QuestionError> {
    if json.is_null() {
        return Ok(Question::None);
    }
    let shape = || QuestionError("a question is an object with a \"type\"".to_owned());
    match json.get("type").and_then(Json::as_str).ok_or_else(shape)? {
        "none" => Ok(Question::None),
        "point" => {
            let name = field(json, "object")?;
            let object = scene.object_named(name);
            object.map(Question::Point).ok_or_else(|| none("object", name))
        }
        "attr" => {
            let k = attribute(scene, json)?;
            Ok(Question::Attribute(k, value(scene, k, field(json, "value")?)?))
        }
        "which" => Ok(Question::Which(attribute(scene, json)?)),
        "choice" => {
            let k = attribute(scene, json)?;
            let names = json.get("values").and_then(Json::as_array);
            let names: Option<Vec<&str>> =
                names.and_then(|names| names.iter().map(Json::as_str).collect());
            let wrong = || QuestionError("\"values\" is not a list of 2 to 4 values".to_owned());
            let values: Vec<ValueId> = (names.ok_or_else(wrong)?.into_iter())
                .map(|name| value(scene, k, name))
                .collect::<Result<_, _>>()?;
            Ok(Question::Choice(k, Options::new(&values).ok_or_else(wrong)?))
        }
        other => {
            let known = "the types are none, point, attr, which and choice";
            Err(QuestionError(format!("unknown question type \"{other}\"; {known}")))
        }
    }
}

/// Writes a question in the form that [`question_from_json`] reads.
///
/// # Panics
/// If the question is not of this scene ([`Scene::contains`]).
pub fn question_to_json(scene: &Scene, question: Question) -> Json {
    match question {
        Question::None => json!({ "type": "none" }),
        Question::Point(i) => json!({ "type": "point", "object": scene.object(i).name }),
        Question::Attribute(k, v) => {
            let attribute = &scene.attributes()[k.index()];
            let value = &attribute.values[v.index()].name;
            json!({ "type": "attr", "attribute": attribute.name, "value": value })
        }
        Question::Which(k) => {
            json!({ "type": "which", "attribute": scene.attributes()[k.index()].name })
        }
        Question::Choice(k, options) => {
            let attribute = &scene.attributes()[k.index()];
            let names = options.values().iter().map(|v| attribute.values[v.index()].name.as_str());
            let names: Vec<&str> = names.collect();
            json!({ "type": "choice", "attribute": attribute.name, "values": names })
        }
    }
}

/// A reading with the scene's own words:
/// `{"base":[…],"response":"yes|no|none","excluded":[[…],…],"intent":…}`.
///
/// # Panics
/// If the reading holds words of another scene.
pub fn reading_to_json(scene: &Scene, reading: &Reading) -> Json {
    let words = |ids: &[crate::WordId]| -> Vec<&str> {
        ids.iter().map(|w| scene.words()[w.index()].as_str()).collect()
    };
    // The object of a user's question, or of an order to put back or wash, is not wanted.
    let intent = published_intent(reading);
    let is_other = matches!(reading.intent, Intent::PutBack | Intent::Chore);
    let wants = intent != Intent::AskBack && !is_other;
    // The published format has one description, of all that is wanted.
    let said = std::iter::once(&reading.base).chain(&reading.further).filter(|_| wants);
    let base: Vec<crate::WordId> = said.flatten().copied().collect();
    let excluded: &[Vec<crate::WordId>] = if wants { &reading.excluded } else { &[] };
    json!({
        "base": words(&base),
        "response": published_response(reading.response),
        "excluded": excluded.iter().map(|group| words(group)).collect::<Vec<_>>(),
        "intent": intent,
    })
}

/// The published format knows `l_r` of the paper alone.
fn published_response(response: Response) -> Response {
    match response {
        Response::CannotTell | Response::DoesNotMatter => Response::None,
        told => told,
    }
}

/// The published format has one intent for all questions to the robot, and fewer others.
fn published_intent(reading: &Reading) -> Intent {
    match reading.intent {
        Intent::Cancel if !reading.excluded.is_empty() => Intent::Inform,
        Intent::StopAndCancel => Intent::Stop,
        Intent::GoOn if reading.response != Response::None => Intent::Inform,
        Intent::AskCount
        | Intent::AskWhich
        | Intent::AskWhether
        | Intent::AskWhere
        | Intent::AskWhy
        | Intent::AskStatus
        | Intent::AskHelp => Intent::AskBack,
        Intent::Greet
        | Intent::Thank
        | Intent::PutBack
        | Intent::Leave
        | Intent::Chore
        | Intent::GoOn => Intent::None,
        other => other,
    }
}

fn attribute(scene: &Scene, json: &Json) -> Result<AttributeId, QuestionError> {
    let name = field(json, "attribute")?;
    scene.attribute_named(name).ok_or_else(|| none("attribute", name))
}

fn value(scene: &Scene, k: AttributeId, name: &str) -> Result<ValueId, QuestionError> {
    scene.value_named(k, name).ok_or_else(|| {
        let attribute = &scene.attributes()[k.index()].name;
        QuestionError(format!("attribute \"{attribute}\" has no value \"{name}\""))
    })
}

fn none(what: &str, name: &str) -> QuestionError {
    QuestionError(format!("the scene has no {what} \"{name}\""))
}

fn field<'a>(json: &'a Json, name: &str) -> Result<&'a str, QuestionError> {
    let missing = || QuestionError(format!("\"{name}\" is missing or not a string"));
    json.get(name).and_then(Json::as_str).ok_or_else(missing)
}
