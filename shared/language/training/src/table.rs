//! The reader's own tables, `scene ? question : text => meaning`: a value word that the meaning has
//! is wanted or denied, any other neither.

use std::fs;
use std::path::Path;

use scene::{Question, Response, Scene, WordId, question_from_json};
use serde_json::json;

use crate::scenes::Scenes;

/// A line of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the case's scene among [`Scenes`].
    pub scene: String,
    /// The question before the utterance.
    pub question: Question,
    /// The words.
    pub text: String,
    /// The words that are wanted, and those that are denied.
    pub said: [Vec<WordId>; 2],
    /// The answer, if the table states one: most state neither doubts nor indifference.
    pub response: Option<Response>,
    /// The heading that it stands under.
    pub kind: String,
}

/// Reads a table.
///
/// # Errors
/// The file cannot be read, or is not a table.
pub fn table(scenes: &Scenes, path: &Path) -> Result<Vec<Row>, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (mut rows, mut kind) = (Vec::new(), "");
    for line in text.lines().filter(|line| !line.is_empty()) {
        if let Some(heading) = line.strip_prefix("## ") {
            kind = heading;
        }
        if !line.starts_with(['#', '~']) {
            let row = row(scenes, line)
                .ok_or_else(|| format!("{}: expected a row, found {line}", path.display()))?;
            rows.push(Row { kind: kind.to_owned(), ..row });
        }
    }
    Ok(rows)
}

fn row(scenes: &Scenes, line: &str) -> Option<Row> {
    let (input, meaning) = line.rsplit_once("=>")?;
    let (context, text) = input.split_once(':')?;
    let (name, asked) = context.split_once('?')?;
    let (name, asked) = (name.trim(), asked.trim());
    let name = match name {
        "mugs" | "garments" | "pantry" => format!("table {name}"),
        name => name.trim_start_matches("talk_").to_owned(),
    };
    let (scene, _) = scenes.get(&name).ok()?;
    let (question, text) = (question(scene, asked)?, text.trim().to_owned());
    let said = said(scene, meaning);
    let response = response(meaning);
    Some(Row { scene: name, question, text, said, response, kind: String::new() })
}

fn response(meaning: &str) -> Option<Response> {
    meaning.split('|').next()?.split_whitespace().find_map(|part| match part {
        "yes" => Some(Response::Yes),
        "no" => Some(Response::No),
        "cannot_tell" => Some(Response::CannotTell),
        "does_not_matter" => Some(Response::DoesNotMatter),
        _ => None,
    })
}

/// The words that a meaning wants and denies. Objects to put back, or asked about, are not.
fn said(scene: &Scene, meaning: &str) -> [Vec<WordId>; 2] {
    const WISHES: [&str; 4] = ["!inform", "!cancel", "!stop", "!stop_and_cancel"];
    let mut said = [Vec::new(), Vec::new()];
    // Of several meanings the first.
    let parts = || meaning.split('|').next().unwrap_or("").split_whitespace();
    if parts().any(|part| part.starts_with('!') && !WISHES.contains(&part)) {
        return said;
    }
    for part in parts().filter(|part| !part.starts_with(['!', '@'])) {
        let (denied, words) = part.strip_prefix('-').map_or((0, part), |rest| (1, rest));
        let words = words.split('+').map(|word| word.replace('_', " "));
        said[denied].extend(words.filter_map(|word| scene.word_named(&word)));
    }
    said
}

fn question(scene: &Scene, text: &str) -> Option<Question> {
    let json = match (text.strip_prefix('@'), text.split_once('=')) {
        _ if text.is_empty() => json!(null),
        (Some(object), _) => json!({ "type": "point", "object": object }),
        (None, Some((attribute, value))) => {
            json!({ "type": "attr", "attribute": attribute, "value": value })
        }
        (None, None) => json!({ "type": "which", "attribute": text }),
    };
    question_from_json(scene, &json).ok()
}
