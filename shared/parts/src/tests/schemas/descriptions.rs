//! Descriptions of keys, from the comments of the shipped files and from the tables of `docs/scenes.md`.

use std::collections::HashMap;

use serde_json::{Value as Json, json};

/// Descriptions by the path of the key, `.` between its parts; `*` stands for any name.
#[derive(Default)]
pub(super) struct Descriptions {
    /// Of the file as a whole.
    whole: String,
    by_path: HashMap<String, String>,
}

impl Descriptions {
    /// Puts them into a schema.
    pub(super) fn put(&self, schema: &mut Json) {
        schema["description"] = json!(self.whole);
        self.put_below(schema, "");
    }

    fn put_below(&self, schema: &mut Json, path: &str) {
        if let Some(item) = schema.get_mut("items") {
            return self.put_below(item, path);
        }
        for choice in schema.get_mut("anyOf").and_then(Json::as_array_mut).into_iter().flatten() {
            self.put_below(choice, path);
        }
        let below =
            |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let properties = schema.get_mut("properties").and_then(Json::as_object_mut);
        for (key, child) in properties.into_iter().flatten() {
            if let Some(text) = self.by_path.get(&below(key)) {
                child["description"] = json!(text);
            }
            self.put_below(child, &below(key));
        }
        if let Some(others) = schema.get_mut("additionalProperties").filter(|it| it.is_object()) {
            self.put_below(others, &below("*"));
        }
    }

    fn add(&mut self, path: String, text: String) {
        if !text.is_empty() {
            self.by_path.insert(path, text);
        }
    }
}

/// The descriptions of a file of the configuration: the comment beside or above each key.
pub(super) fn of_file(text: &str) -> Descriptions {
    let mut found = Descriptions::default();
    let mut table = String::new();
    let (mut block, mut last) = (String::new(), None::<String>);
    // The comment above a group of keys describes each of them that has none of its own.
    let mut group = String::new();
    for line in text.lines().filter(|line| !line.starts_with("#:")) {
        let comment = line.strip_prefix('#');
        let more = line.trim_start().strip_prefix('#').map(str::trim).filter(|_| {
            line.starts_with(' ') || comment.is_some_and(|it| it.starts_with("          "))
        });
        if let (Some(more), Some(path)) = (more, &last) {
            let known = found.by_path.entry(path.clone()).or_default();
            *known = format!("{known} {more}").trim().to_owned();
        } else if let Some(header) = line.strip_prefix('[') {
            table = header.trim_matches(['[', ']']).to_owned();
            let text = std::mem::take(&mut block);
            found.add(table.clone(), text);
            last = None;
        } else if let Some((key, rest)) = key_of(comment.unwrap_or(line).trim_start()) {
            // The keys of a service are listed in a comment, indented.
            let is_service = comment.is_some_and(|it| it.starts_with("   "));
            if !block.is_empty() {
                group = std::mem::take(&mut block);
            }
            let beside = beside(rest, is_service);
            if is_service && beside.is_empty() {
                continue;
            }
            let parent = if is_service { "services.*" } else { &table };
            let path = if parent.is_empty() { key.to_owned() } else { format!("{parent}.{key}") };
            found.add(path.clone(), if beside.is_empty() { group.clone() } else { beside });
            last = Some(path);
        } else if let Some(comment) = comment {
            if found.whole.is_empty() {
                found.whole = comment.trim().to_owned();
            } else {
                block = format!("{block} {}", comment.trim()).trim().to_owned();
            }
            last = None;
        } else {
            (block, group, last) = (String::new(), String::new(), None);
        }
    }
    for (key, text) in [("services", "The services by name."), ("services.*", "A service.")] {
        found.add(key.to_owned(), text.to_owned());
    }
    found
}

/// Key and rest of a line `KEY = …`.
fn key_of(line: &str) -> Option<(&str, &str)> {
    let (key, rest) = line.split_once(" = ")?;
    let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    is_key.then_some((key, rest))
}

/// The comment beside a value; in the list of a service's keys it follows two spaces.
fn beside(rest: &str, is_service: bool) -> String {
    let at = if is_service { rest.find("  ") } else { rest.rfind(" # ").map(|at| at + 2) };
    at.map_or_else(String::new, |at| rest[at..].trim().to_owned())
}

/// The descriptions of scene files: the tables of the page about them.
pub(super) fn of_scenes(page: &str) -> Descriptions {
    let mut found =
        Descriptions { whole: "A scene: objects and words.".to_owned(), ..Default::default() };
    let mut parent = None;
    for line in page.lines() {
        let heads = [
            ("## Keys of the scene", ""),
            ("## Keys of an attribute", "attributes."),
            ("A value is a string", "attributes.values."),
            ("## Keys of an object", "objects."),
        ];
        if let Some((_, path)) = heads.iter().find(|(head, _)| line.starts_with(head)) {
            parent = Some(*path);
        } else if line.starts_with('#') {
            parent = None;
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        if let (Some(parent), ["", key, .., meaning, ""]) = (parent, &cells[..])
            && let Some(key) = key.strip_prefix('`').and_then(|key| key.strip_suffix('`'))
        {
            // Six columns: the unit is one of them.
            let unit = if cells.len() == 7 { cells[4] } else { "" };
            let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
            let plain = |text: &str| text.replace(['`'], "").replace(", see below", "");
            let meaning = match plain(meaning).as_str() {
                "see below" => format!("The {key}, each a table [[{key}]]."),
                meaning => meaning.to_owned(),
            };
            found.add(format!("{parent}{key}"), format!("{meaning}{}", plain(&unit)));
        }
    }
    found
}
