//! JSON Schemas of the sections, made by their readers.

use diagnostics::{Fields, Report, schema_of};
use serde_json::Value as Json;

use crate::part::{defaults, sections};
use crate::{arm, console, dialogue, group, part, services, speech};

/// A section of the configuration with the schema of its values.
#[derive(Clone, Debug)]
pub struct SectionSchema {
    /// Name of the section.
    pub name: &'static str,
    /// Shipped file of the section, whose comments describe the keys.
    pub shipped: &'static str,
    /// Schema of the values that the section's reader accepts.
    pub schema: Json,
}

/// The schema of every section, with those of the registered parts.
pub fn schemas() -> Vec<SectionSchema> {
    let all = sections();
    all.map(|(name, shipped)| SectionSchema { name, shipped, schema: of_section(name) }).collect()
}

fn of_section(name: &str) -> Json {
    let mut tree = defaults();
    if name == "group" {
        // Any service, with the defaults of each.
        let group = tree.table_at("group");
        group.table_at("services").table_at("*");
        services::complete(group, &mut Report::default());
    }
    schema_of(tree.table_at(name), |f| part::with_tables(name, f, |f| read(name, f)))
}

fn read(name: &str, f: &mut Fields<'_>) {
    match name {
        "group" => drop(group::read(f)),
        "dialogue" => drop(dialogue::read(f)),
        "speech" => drop(speech::read(f)),
        "arm" => drop(arm::read(f, false)),
        "console" => drop(console::read(f)),
        _ => part::read_contents(name, f),
    }
}
