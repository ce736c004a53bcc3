//! The text of a new scene file.

use std::path::Path;

/// The new scene; `@NAME@` and `@SCHEMA@` are filled in, and places are added.
const TEMPLATE: &str = include_str!("template.toml");

/// The schema of scene files, in a configuration folder.
const SCHEMA: &str = "schemas/scene.json";

/// Returns the text of a new scene: two attributes and four objects without places, with a comment
/// on every key. `schema` is the line with the schema for editors ([`schema_line`]), or empty.
pub fn new_scene(name: &str, schema: &str) -> String {
    let name = toml_edit::Value::from(name).to_string();
    TEMPLATE.replace("@NAME@", &name).replace("@SCHEMA@", schema)
}

/// Returns the line by which editors find the schema of the scene file at `path`: next to its
/// folder, else in the configuration folder `config`; empty if neither has it.
pub fn schema_line(path: &Path, config: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    if folder.join("..").join(SCHEMA).is_file() {
        return format!("#:schema ../{SCHEMA}\n");
    }
    let schema = config.join(SCHEMA);
    let line = || format!("#:schema file://{}\n", schema.display());
    if schema.is_file() { line() } else { String::new() }
}
