//! People's words in the lines of `whichone journal --json`.

use std::collections::BTreeSet;

use serde_json::Value as Json;

/// Placeholder of a text.
const LEFT_OUT: &str = "(words left out)";

/// Keys whose texts are words of the program or of the scene, if they look like such. Every other text of a record may
/// hold what somebody said, or who it was.
const KEPT: [&str; 31] = [
    "attribute",
    "base",
    "cause",
    "channel",
    "decision",
    "excluded",
    "gone",
    "intent",
    "kind",
    "language",
    "limb",
    "mode",
    "object",
    "offered",
    "order",
    "outcome",
    "phase",
    "planner",
    "reaction",
    "reason",
    "refusable",
    "response",
    "role",
    "service",
    "source",
    "state",
    "status",
    "task",
    "type",
    "value",
    "values",
];

/// Longest identifier.
const IDENTIFIER_MAX: usize = 40;

/// Returns the lines without texts, and the texts. Lines that are no JSON are left out as a whole.
pub(crate) fn without_words(lines: &str) -> (String, BTreeSet<String>) {
    let mut words = BTreeSet::new();
    let clean = lines.lines().map(|line| match serde_json::from_str::<Json>(line) {
        Ok(mut value) => {
            clean_value("", &mut value, &mut words);
            format!("{value}\n")
        }
        Err(_) => format!("{LEFT_OUT}\n"),
    });
    let clean = clean.collect();
    (clean, words)
}

fn clean_value(key: &str, value: &mut Json, words: &mut BTreeSet<String>) {
    match value {
        Json::String(text) => {
            if text.is_empty() || KEPT.contains(&key) && is_identifier(text) {
                return;
            }
            let text = std::mem::replace(text, LEFT_OUT.to_owned());
            // A single word that somebody said ("no") is in every log; a name counts.
            if key == "from" || text.contains(' ') {
                words.insert(text);
            }
        }
        Json::Array(all) => all.iter_mut().for_each(|value| clean_value(key, value, words)),
        Json::Object(all) => all.iter_mut().for_each(|(key, value)| clean_value(key, value, words)),
        Json::Null | Json::Bool(_) | Json::Number(_) => {}
    }
}

fn is_identifier(text: &str) -> bool {
    let is_plain = |it: char| it.is_alphanumeric() || it == '_' || it == '-';
    text.len() <= IDENTIFIER_MAX && text.chars().all(is_plain)
}
