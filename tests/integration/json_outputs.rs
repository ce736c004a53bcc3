//! The JSON of the verbs is a contract with scripts (docs/stability.md): the schema's number, and the keys of each
//! verb. `WHICHONE_BLESS=1` writes the new keys.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;
use whichone_tests::Group;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/json_keys.txt");

/// Verbs whose output is looked at, in the order of a dialogue.
const LINES: [&str; 30] = [
    "--version",
    "status",
    "console",
    "check",
    "doctor",
    "say get me the bowl",
    "await pick --answer-as white2 --timeout 120",
    "watch --once",
    "journal policy",
    "journal policy --verify",
    "journal --verify",
    "logs --tail 3",
    "record list",
    "people list",
    "token add hall",
    "token list",
    "token revoke hall",
    "stop-motion",
    "restart grounding",
    "hold grounding",
    "release grounding",
    "reload",
    "scene show bowls",
    "scene check bowls",
    "init DIR/config",
    "export mcap --out DIR/x.mcap",
    "export trace --out DIR/x.json",
    "report --out DIR/report",
    "licences",
    "down",
];

/// Keys of all lines of an output. Each line is an object that begins with the schema.
fn keys(line: &str, text: &str) -> BTreeSet<String> {
    let mut keys = BTreeSet::new();
    assert!(!text.is_empty(), "whichone {line} --json prints nothing");
    for one in text.lines() {
        assert!(one.starts_with("{\"schema\":1"), "whichone {line} --json: {one}");
        let value: Value = serde_json::from_str(one).unwrap();
        keys.extend(value.as_object().unwrap().keys().cloned());
    }
    keys
}

#[test]
fn json_of_the_verbs_has_the_agreed_keys() {
    let mut group = Group::new();
    let folder = tempfile::tempdir().unwrap();
    let mut found = BTreeMap::new();
    group.start(&[]);
    for line in LINES {
        let place = folder.path().display().to_string();
        let words: Vec<String> = line.split(' ').map(|word| word.replace("DIR", &place)).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).chain(["--json"]).collect();
        let ended = group.call(&words);
        assert!(matches!(ended.code, Some(0 | 1)), "{line}: {ended:?}");
        found.insert(line, keys(line, &ended.stdout));
    }
    let refused = group.call(&["fly", "--json"]);
    found.insert("(an error)", keys("fly", &refused.stdout));
    let line = |(line, keys): (&&str, &BTreeSet<String>)| {
        format!("{line}: {}\n", keys.iter().map(String::as_str).collect::<Vec<_>>().join(" "))
    };
    let found: String = found.iter().map(line).collect();
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(GOLDEN, &found).unwrap();
    }
    let agreed = std::fs::read_to_string(Path::new(GOLDEN)).unwrap_or_default();
    assert_eq!(found, agreed, "if the change is intended, run this test with WHICHONE_BLESS=1");
}
