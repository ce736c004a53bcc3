//! Our own utterances, one a line: `scene ? question : text => meaning`, where the question is
//! empty, `attribute=value` or `@object`, and the meaning lists values said, `-a+b` for a group
//! ruled out, `yes` or `no` for the answer and `!intent`; `|` parts readings that are as good.

use scene::{Question, Scene, question_from_json};
use serde_json::json;

use super::{Meaning, scene};
use crate::{Language, Reader};

const CASES: &str = include_str!("cases.txt");

fn question(scene: &Scene, text: &str) -> Question {
    let json = match (text.strip_prefix('@'), text.split_once('=')) {
        _ if text.is_empty() => json!(null),
        (Some(object), _) => json!({"type": "point", "object": object}),
        (None, Some((attribute, value))) => {
            json!({"type": "attr", "attribute": attribute, "value": value})
        }
        (None, None) => json!({"type": "which", "attribute": text}),
    };
    question_from_json(scene, &json).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn meaning(text: &str) -> Meaning {
    let mut json = json!({"base": [], "excluded": [], "response": "none", "intent": "inform"});
    for word in text.split_whitespace() {
        match word.split_at(1) {
            _ if matches!(word, "yes" | "no") => json["response"] = json!(word),
            ("!", intent) => json["intent"] = json!(intent),
            ("-", group) => {
                let group: Vec<&str> = group.split('+').collect();
                json["excluded"].as_array_mut().expect("a list").push(json!(group));
            }
            _ => json["base"].as_array_mut().expect("a list").push(json!(word)),
        }
    }
    Meaning::of(&json)
}

#[test]
fn our_own_utterances_are_understood() {
    let scenes = ["bowls", "tools"].map(|name| (name, scene(name)));
    let readers = scenes.each_ref().map(|(_, scene)| Reader::new(scene, Language::Careful));
    let (mut kind, mut count, mut failures) = ("", 0, Vec::new());
    for line in CASES.lines().filter(|line| !line.is_empty()) {
        if let Some(heading) = line.strip_prefix("## ") {
            kind = heading;
            continue;
        }
        let (input, expected) = line.rsplit_once("=>").expect("a meaning");
        let (context, text) = input.split_once(':').expect("a text");
        let (name, asked) = context.split_once('?').expect("a question");
        let n = usize::from(name.trim() == "tools");
        let scene = &scenes[n].1;
        let read = Meaning::read(&readers[n], scene, text.trim(), question(scene, asked.trim()));
        if !expected.split('|').any(|expected| meaning(expected) == read) {
            failures.push(format!("{kind}: {line}\n    read as {read:?}"));
        }
        count += 1;
    }
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}
