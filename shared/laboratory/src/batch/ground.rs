//! `whichone ground`: the meaning of an utterance in a scene.

use std::io::Read;

use command_line::Outcome;
use command_line::output::Output;
use language::{Mention, Reader};

use scene::{Question, Scene, question_from_json, reading_to_json};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use vocabulary::Language;

use super::{parse, run};

/// Reads utterances about one scene.
pub struct Grounder {
    scene: Scene,
    reader: Reader,
}

/// An utterance and the question before it.
#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    text: String,
    #[serde(default)]
    last_question: Json,
    /// The scene of the line, if a file holds lines for several.
    #[serde(default)]
    scene: Option<String>,
}

/// Answers each utterance with `{"id","base","response","excluded","intent","mentions"}`.
///
/// # Errors
/// See [`run`].
pub fn ground(grounder: &Grounder, input: impl Read, out: &mut Output<'_>) -> Outcome {
    run(input, out, |line| grounder.answer(&parse(line)?))
}

impl Grounder {
    /// Prepares for a scene.
    pub fn new(scene: Scene, language: Language) -> Self {
        let reader = Reader::new(&scene, language);
        Self { scene, reader }
    }

    fn answer(&self, line: &Line) -> Result<Json, String> {
        let question = self.question(line).map_err(|e| format!("last_question: {e}"))?;
        let reading = self.reader.read(&line.text, question);
        let mentions = self.reader.mentions(&line.text, question);
        let mut answer = json!({ "id": line.id, "mentions": self.mentions(&mentions) });
        if let (Some(answer), Json::Object(members)) =
            (answer.as_object_mut(), reading_to_json(&self.scene, &reading))
        {
            answer.extend(members);
        }
        Ok(answer)
    }

    /// Returns the polarity of each value word.
    fn mentions(&self, mentions: &[Mention]) -> Json {
        let mention = |it: &Mention| {
            let value = &self.scene.words()[it.word.index()];
            json!({ "value": value, "wanted": it.wanted, "denied": it.denied, "neither": it.neither })
        };
        mentions.iter().map(mention).collect()
    }

    /// A question about another scene's objects was not asked here, so it counts as none; a line
    /// for this scene must get it right.
    fn question(&self, line: &Line) -> Result<Question, scene::QuestionError> {
        let elsewhere = line.scene.as_ref().is_some_and(|name| name != self.scene.name());
        match question_from_json(&self.scene, &line.last_question) {
            Err(_) if elsewhere => Ok(Question::None),
            question => question,
        }
    }
}
