//! Documentation of types, fields and variants, taken from the sources: schemas do not carry it.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the sources that declare what messages consist of; those first whose types count where two
/// have one name.
const SOURCES: [&str; 4] = ["messages/src", "perception/src", "vocabulary/src", "scene/src"];

/// Documentation by type, and by type and field.
#[derive(Debug, Default)]
pub(crate) struct Docs {
    texts: HashMap<(String, String), String>,
}

impl Docs {
    /// Reads the sources.
    pub(crate) fn read() -> Self {
        let mut docs = Self::default();
        for folder in SOURCES {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
            let mut files = Vec::new();
            collect(&folder, &mut files);
            files.sort();
            for file in files {
                docs.scan(&fs::read_to_string(&file).unwrap());
            }
        }
        docs
    }

    /// The documentation of a type; empty if there is none.
    pub(crate) fn of(&self, name: &str) -> String {
        self.of_field(name, "")
    }

    /// The documentation of a field or variant.
    pub(crate) fn of_field(&self, name: &str, field: &str) -> String {
        let name = ["", "Wire"]
            .iter()
            .find_map(|prefix| self.texts.get(&(format!("{prefix}{name}"), field.to_owned())));
        name.cloned().unwrap_or_default()
    }

    /// Takes in what one source declares: a line of documentation belongs to the item or field after it.
    fn scan(&mut self, source: &str) {
        let (mut text, mut container) = (String::new(), String::new());
        for line in source.lines() {
            if line == "mod tests {" {
                return;
            }
            let code = line.trim();
            if let Some(doc) = code.strip_prefix("///") {
                text = format!("{text} {}", doc.trim());
                continue;
            }
            if code.starts_with("#[") || code.is_empty() {
                continue;
            }
            let doc = plain(std::mem::take(&mut text).trim());
            if let Some(name) = declared(code, container.is_empty()) {
                container = name;
                self.add(&container, "", doc);
            } else if let Some(field) = member(code) {
                self.add(&container, &field, doc);
            } else if code == "}" {
                container.clear();
            }
        }
    }

    fn add(&mut self, container: &str, field: &str, doc: String) {
        if !doc.is_empty() && !container.is_empty() {
            let key = (container.to_owned(), field.to_owned());
            self.texts.entry(key).or_insert(doc);
        }
    }
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for path in entries.map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true => collect(&path, files),
            false if path.extension().is_some_and(|it| it == "rs") => files.push(path),
            false => {}
        }
    }
}

/// The type that a line begins to declare. Inside another one, a name alone is a variant with fields.
fn declared(code: &str, is_outside: bool) -> Option<String> {
    let rest = code.strip_suffix('{')?.trim_end();
    let words: Vec<&str> = rest.split_whitespace().collect();
    match words.as_slice() {
        ["pub", "struct" | "enum", name] => Some((*name).to_owned()),
        // In `wire_struct!`, `wire_enum!` and `wire_codes!`.
        [name, "=", wire] if wire.starts_with('"') => Some((*name).to_owned()),
        [name] if is_outside && is_type(name) => Some((*name).to_owned()),
        _ => None,
    }
}

/// The field or variant in a line.
fn member(code: &str) -> Option<String> {
    let code = code.strip_prefix("pub ").unwrap_or(code);
    let end = code.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(code.len());
    let (name, rest) = code.split_at(end);
    let rest = rest.trim_start();
    let is_member = rest.starts_with([':', '(', ',', '{', '=']) && !rest.starts_with("::");
    (is_member && !name.is_empty()).then(|| name.to_owned())
}

fn is_type(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
}

/// A text without the marks of links to Rust items.
fn plain(doc: &str) -> String {
    let mut text = doc.replace("[`", "`").replace("`]", "`");
    // `](target)` of a link with a text of its own.
    while let Some(start) = text.find("](") {
        let Some(length) = text[start..].find(')') else { break };
        text.replace_range(start..=start + length, "");
        if let Some(open) = text[..start].rfind('[') {
            text.remove(open);
        }
    }
    // `` `x`(y) `` is what is left of a link to `y`.
    while let Some(start) = text.find("`(") {
        let Some(length) = text[start..].find(')') else { break };
        text.replace_range(start + 1..=start + length, "");
    }
    text.replace("crate::", "").replace("scene::", "")
}
