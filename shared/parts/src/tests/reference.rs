//! The reference of the configuration (`docs/configuration.md`), made of the schemas, so of the readers and
//! of the comments in the shipped files. `UPDATE_EXPECT=1 cargo test -p parts schemas` writes it.

use std::fmt::Write;
use std::path::Path;

use expect_test::expect_file;
use serde_json::Value as Json;

use super::schemas::schemas;
use super::sections;

const HEAD: &str = "\
# Configuration

<!-- Written by `UPDATE_EXPECT=1 cargo test -p parts schemas`; change the comments in `config` instead. -->

Every key with its values, its default and its meaning. Keys that a file leaves out have the default.

| layer | counts | example |
|---|---|---|
| files of the configuration's folder | least | `config/dialogue.toml`: `planner = \"entropy\"` |
| a profile, `config/profiles/NAME.toml` | more | `whichone up --profile lab` |
| `--set` | most | `whichone up --set dialogue.planner=entropy` |

In a profile and with `--set` a key begins with its file's name: `dialogue.planner`. `whichone check` lists every problem of a
configuration, `whichone check --values` every value with the file and line it comes from; `whichone reload` puts changed files in
force. Editors that know JSON Schema complete and check the files: each names its schema, in `config/schemas`, in its first line.
Scenes have a page of their own: [scenes.md](scenes.md).
";

/// The names of keys that are any name.
const ANY: &str = "NAME";

fn page() -> String {
    let mut text = HEAD.to_owned();
    let schemas = schemas();
    for section in sections() {
        let name = section.name;
        let _ = write!(text, "\n## {name}\n\n`config/{name}.toml`. ");
        table(name, &schemas[name], 3, &mut text);
    }
    text
}

/// Writes a table of the configuration and those inside it.
fn table(path: &str, schema: &Json, depth: usize, text: &mut String) {
    let _ = writeln!(text, "{}", cell(schema["description"].as_str().unwrap_or_default()));
    let (mut keys, mut inner) = (String::new(), Vec::new());
    for (key, child) in schema["properties"].as_object().into_iter().flatten() {
        if child["type"] == "object" {
            inner.push((format!("{path}.{key}"), child));
            continue;
        }
        let default = child.get("default").map(|default| format!("`{default}`"));
        let _ = writeln!(
            keys,
            "| `{key}` | {} | {} | {} |",
            cell(&values(child)),
            cell(&default.unwrap_or_default()),
            cell(child["description"].as_str().unwrap_or_default()),
        );
    }
    if !keys.is_empty() {
        let _ = write!(text, "\n| key | values | default | meaning |\n|---|---|---|---|\n{keys}");
    }
    if let any @ Json::Object(_) = &schema["additionalProperties"] {
        inner.push((format!("{path}.{ANY}"), any));
    }
    for (path, child) in inner {
        let _ = write!(text, "\n{} {path}\n\n", "#".repeat(depth));
        table(&path, child, depth, text);
    }
}

/// What a value may be.
fn values(schema: &Json) -> String {
    if let Some(names) = schema["enum"].as_array() {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        return names.join(", ");
    }
    if let Some(forms) = schema["anyOf"].as_array() {
        return forms.iter().map(values).collect::<Vec<_>>().join(" or ");
    }
    match schema["type"].as_str() {
        Some("boolean") => "`true`, `false`".to_owned(),
        Some("number") => bounded("number", schema),
        Some("integer") => bounded("whole number", schema),
        Some("array") => {
            let (least, most) = (&schema["minItems"], &schema["maxItems"]);
            let count =
                if least == most && !least.is_null() { format!(" {least}") } else { String::new() };
            let items = match schema["items"]["properties"].as_object() {
                Some(keys) => {
                    let keys: Vec<String> = keys.keys().map(|key| format!("`{key}`")).collect();
                    format!("tables with {}", keys.join(", "))
                }
                None => format!("{}s", values(&schema["items"])),
            };
            format!("list of{count} {items}")
        }
        _ => "text".to_owned(),
    }
}

fn bounded(kind: &str, schema: &Json) -> String {
    let bound = |key: &str| {
        schema.get(key).map(|bound| match bound.as_f64() {
            Some(bound) => bound.to_string(),
            None => bound.to_string(),
        })
    };
    let least = bound("minimum").map(|least| format!("at least {least}"));
    let least = least.or(bound("exclusiveMinimum").map(|least| format!("above {least}")));
    let most = bound("maximum").map(|most| format!("at most {most}"));
    let most = most.or(bound("exclusiveMaximum").map(|most| format!("below {most}")));
    [Some(kind.to_owned()), least, most].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// A text as a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}

#[test]
fn reference_is_made_of_the_schemas() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/configuration.md");
    expect_file![path].assert_eq(&page());
}
