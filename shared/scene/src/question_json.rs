//! Questions and readings as JSON, for batch tools and tests.

use serde_json::{Value as Json, json};

use crate::{AttributeId, Question, Reading, Scene};

/// An invalid question in JSON.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QuestionError {
    /// Neither `null` nor an object with a string `type`.
    #[error("a question is an object with a \"type\"")]
    Shape,
    /// The type is none of the four.
    #[error("unknown question type \"{0}\"; the types are none, point, attr and which")]
    Type(String),
    /// A key of this type of question is missing or not a string.
    #[error("\"{0}\" is missing or not a string")]
    Missing(&'static str),
    /// The scene has no such object.
    #[error("the scene has no object \"{0}\"")]
    Object(String),
    /// The scene has no such attribute.
    #[error("the scene has no attribute \"{0}\"")]
    Attribute(String),
    /// The attribute has no such value.
    #[error("attribute \"{attribute}\" has no value \"{value}\"")]
    Value {
        /// The attribute asked about.
        attribute: String,
        /// The value that it lacks.
        value: String,
    },
}

/// Reads `{"type":"none"}` (or `null`), `{"type":"point","object":ID}`,
/// `{"type":"attr","attribute":K,"value":V}` or `{"type":"which","attribute":K}`.
///
/// # Errors
/// The first thing that is invalid in this scene.
pub fn question_from_json(scene: &Scene, json: &Json) -> Result<Question, QuestionError> {
    if json.is_null() {
        return Ok(Question::None);
    }
    match json.get("type").and_then(Json::as_str).ok_or(QuestionError::Shape)? {
        "none" => Ok(Question::None),
        "point" => {
            let name = field(json, "object")?;
            let object = scene.object_named(name);
            object.map(Question::Point).ok_or_else(|| QuestionError::Object(name.to_owned()))
        }
        "attr" => {
            let k = attribute(scene, json)?;
            let name = field(json, "value")?;
            let v = scene.value_named(k, name).ok_or_else(|| QuestionError::Value {
                attribute: scene.attributes()[k.index()].name.clone(),
                value: name.to_owned(),
            })?;
            Ok(Question::Attribute(k, v))
        }
        "which" => Ok(Question::Which(attribute(scene, json)?)),
        other => Err(QuestionError::Type(other.to_owned())),
    }
}

/// Writes what [`question_from_json`] reads.
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
    json!({
        "base": words(&reading.base),
        "response": reading.response,
        "excluded": reading.excluded.iter().map(|group| words(group)).collect::<Vec<_>>(),
        "intent": reading.intent,
    })
}

fn attribute(scene: &Scene, json: &Json) -> Result<AttributeId, QuestionError> {
    let name = field(json, "attribute")?;
    scene.attribute_named(name).ok_or_else(|| QuestionError::Attribute(name.to_owned()))
}

fn field<'a>(json: &'a Json, name: &'static str) -> Result<&'a str, QuestionError> {
    json.get(name).and_then(Json::as_str).ok_or(QuestionError::Missing(name))
}
