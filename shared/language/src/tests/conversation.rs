//! Utterances other than descriptions and answers: not knowing, not minding, references, several
//! objects, questions to the robot, greetings.
//!
//! One utterance a line: `scene ? question : text => meaning`. The meaning lists words said, `-a+b`
//! for a group ruled out, the response (`yes`, `no`, `cannot_tell`, `does_not_matter`), `!intent`,
//! `@reference`, and after a `;` the words of each further object. `_` is a blank inside a value.
//!
//! The lines from "orders other than to fetch" on predate their code: it misread 36 of 66 then.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use ::vocabulary::Language;
use scene::{Reading, Reference, Scene, WordId};

use super::scene;
use super::table::{Case, cases, question};

use crate::Reader;

/// The reading in the words of the table, those of a list in alphabetical order.
fn written(scene: &Scene, reading: &Reading) -> String {
    let word = |id: &WordId| scene.words()[id.index()].replace(' ', "_");
    let words = |ids: &[WordId]| {
        let mut words: Vec<String> = ids.iter().map(word).collect();
        words.sort();
        words.dedup();
        words
    };
    let name = |value: serde_json::Value| value.as_str().expect("a name").to_owned();
    let mut parts = words(&reading.base);
    parts.extend(reading.excluded.iter().map(|group| format!("-{}", words(group).join("+"))));
    let response = name(serde_json::json!(reading.response));
    let refers = match reading.refers {
        Reference::Relation(relation) => relation.text().replace(' ', "_"),
        refers => name(serde_json::json!(refers)),
    };
    let intent = name(serde_json::json!(reading.intent));
    parts.extend(Some(response).filter(|name| name != "none"));
    parts.extend(Some(format!("@{refers}")).filter(|name| name != "@none"));
    parts.extend(Some(format!("!{intent}")).filter(|name| name != "!inform"));
    for further in &reading.further {
        parts.push(";".to_owned());
        parts.extend(words(further));
    }
    parts.join(" ")
}

/// A meaning of the table, ordered as [`written`] orders it.
fn ordered(text: &str) -> String {
    let mut parts: Vec<&str> = text.split_whitespace().collect();
    let objects = parts.split_mut(|part| *part == ";");
    for object in objects {
        object.sort_by_key(|part| {
            let rank = match part.chars().next() {
                Some('-') => 1,
                Some('@') => 3,
                Some('!') => 4,
                _ if ["yes", "no", "cannot_tell", "does_not_matter"].contains(part) => 2,
                _ => 0,
            };
            (rank, if rank == 0 { *part } else { "" })
        });
    }
    parts.join(" ")
}

#[test]
fn reader_understands_a_conversation() {
    let mut readers: BTreeMap<&str, (Scene, Reader)> = BTreeMap::new();
    let mut failures = String::new();
    for Case { scene: name, asked, text, line, .. } in cases(include_str!("conversation.txt")) {
        let (scene, reader) = readers.entry(name).or_insert_with(|| {
            let scene = scene(name);
            let reader = Reader::new(&scene, Language::Careful);
            (scene, reader)
        });
        let read = written(scene, &reader.read(text, question(scene, asked)));
        let (_, meaning) = line.rsplit_once("=>").expect("a meaning");
        if meaning.split('|').all(|meaning| ordered(meaning) != read) {
            let _ = writeln!(failures, "{line}\n    read as {read}");
        }
    }
    assert!(failures.is_empty(), "\n{failures}");
}
