//! Interactions in files, as the page writes them to share one.

use std::io::{self, Read};
use std::path::Path;

use serde::Deserialize;
use service::exit::{Exit, Failure};

use crate::Interaction;

/// Mark of the page in a file.
const FORMAT: &str = "whichone.interaction/1";
/// Largest file, bytes: many times the size of an interaction.
const FILE_MAX: u64 = 32 << 20;

/// Reads a file, which must hold an interaction.
///
/// # Errors
/// It does not, or cannot be read.
pub fn read(file: &Path) -> Result<String, Failure> {
    let failed = |error: io::Error| Failure::file(file, &error);
    let mut opened = safe_files::open_regular(file).map_err(failed)?;
    let length = opened.metadata().map_err(failed)?.len();
    let wrong = |found: String| {
        let help = "help: save one with the arrow in the history of the console's page";
        let expected = format!("expected an interaction, JSON with \"format\": \"{FORMAT}\"");
        Failure::new(Exit::Config, format!("{}: {expected}, found {found}; {help}", file.display()))
    };
    if length > FILE_MAX {
        return Err(wrong(format!("{length} bytes")));
    }
    let mut bytes = Vec::new();
    opened.read_to_end(&mut bytes).map_err(failed)?;
    let text = String::from_utf8(bytes).map_err(|_| wrong("a file that is not text".to_owned()))?;
    let json: serde_json::Value =
        serde_json::from_str(&text).map_err(|error| wrong(format!("no JSON ({error})")))?;
    match &json["format"] {
        format if format == FORMAT => {}
        serde_json::Value::Null => return Err(wrong("no format".to_owned())),
        format => return Err(wrong(format!("format {format}"))),
    }
    let read = Interaction::deserialize(&json);
    read.map(|_| text).map_err(|error| wrong(format!("other content ({error})")))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use serde_json::{Value, json};

    use super::*;

    fn read_as_file(content: &str) -> Result<String, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("shared.json");
        fs::write(&file, content).unwrap();
        let read = read(&file).map_err(|failure| failure.to_string());
        read.inspect_err(|why| assert!(why.contains("shared.json: expected"), "{why}"))
    }

    #[test]
    fn viewer_takes_interactions_only() {
        let page = include_str!("../../../services/console/page/js/history/model.js");
        assert!(page.contains(&format!("\"{FORMAT}\"")), "the page writes what is read here");
        let whole = json!({ "format": FORMAT, "group": "lab", "version": "0", "interaction": 3,
            "unix_ms": null, "whole": true, "objects": [{ "name": "a", "label": "the cup" }],
            "moments": [{ "after_ms": 0, "event": { "type": "silence" }, "thought": null }],
            "left_out": 0, "end": null });
        assert!(read_as_file(&whole.to_string()).is_ok());
        let with = |key: &str, value: Value| {
            let mut json = whole.clone();
            json[key] = value;
            json.to_string()
        };
        for (content, found) in [
            (String::new(), "no JSON"),
            ("{\"a\": 1}".to_owned(), "no format"),
            ("[1]".to_owned(), "no format"),
            (with("format", json!("whichone.interaction/2")), "interaction/2"),
            (with("moments", json!(7)), "other content"),
        ] {
            let why = read_as_file(&content).unwrap_err();
            assert!(why.contains(found) && why.contains("help:"), "{why}");
        }
    }
}
