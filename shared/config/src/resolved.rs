//! The merged layers behind the settings.

use std::sync::LazyLock;

use diagnostics::{Diagnostic, Node, Report, Source, Table, TextFile};

use crate::files::RobotFiles;

/// The core's sections, each with its shipped file, which holds the defaults.
pub(crate) const CORE: [(&str, &str); 5] = [
    ("group", include_str!("../../../config/group.toml")),
    ("dialogue", include_str!("../../../config/dialogue.toml")),
    ("speech", include_str!("../../../config/speech.toml")),
    ("arm", include_str!("../../../config/arm.toml")),
    ("console", include_str!("../../../config/console.toml")),
];

/// The core's defaults.
pub(crate) static CORE_DEFAULTS: LazyLock<Table> =
    LazyLock::new(|| parsed(CORE.into_iter(), &Source::built_in()));

/// A value and the layer that it comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Dotted key with its section, e.g. `arm.time_scale`.
    pub key: String,
    /// The value as TOML.
    pub value: String,
    /// The file, `--set`, or `built-in defaults`.
    pub from: String,
}

/// The sources of a checked [`Settings`](crate::Settings).
#[derive(Clone, Debug)]
pub(crate) struct Resolved {
    /// One table per section, complete.
    pub(crate) tree: Table,
    pub(crate) scene: TextFile,
    pub(crate) robot: RobotFiles,
    /// The text of the snapshot in force that they were read from; only `load_snapshot` sets it.
    pub(crate) snapshot: Option<String>,
    /// Keys of earlier versions in the layers.
    pub(crate) warnings: Vec<Diagnostic>,
}

impl Resolved {
    pub(crate) fn section_text(&self, section: &str) -> String {
        let mut text = match self.tree.get(section) {
            Some(Node::Table(table)) => to_toml(table),
            _ => String::new(),
        };
        if section == "arm" {
            text.push_str(&self.robot.urdf.text);
            text.push_str(self.robot.srdf.as_ref().map_or("", |file| &file.text));
        }
        text
    }

    /// The section of the dialogue without the language model: it reads utterances and decides
    /// nothing, so that journals stay those of one manager whichever model is used.
    pub(crate) fn decision_text(&self) -> String {
        let dialogue = self.tree.get("dialogue").and_then(Node::as_table).cloned();
        let text = dialogue.map(|mut dialogue| {
            drop(dialogue.take("model"));
            to_toml(&dialogue)
        });
        text.unwrap_or_default()
    }

    /// The value at a dotted key as TOML.
    pub(crate) fn value_text(&self, key: &str) -> String {
        let mut node = None;
        let mut table = Some(&self.tree);
        for part in key.split('.') {
            node = table.and_then(|table| table.get(part));
            table = node.and_then(Node::as_table);
        }
        match node {
            Some(Node::Table(table)) => to_toml(table),
            Some(value) => value.to_string(),
            None => String::new(),
        }
    }

    pub(crate) fn origins(&self) -> Vec<Origin> {
        let mut origins = Vec::new();
        collect(&self.tree, &mut Vec::new(), &mut origins);
        origins
    }
}

/// One table per section, from the text of its file.
///
/// # Panics
/// Never: the shipped files are TOML.
pub(crate) fn parsed<'a>(
    files: impl Iterator<Item = (&'a str, &'a str)>,
    source: &Source,
) -> Table {
    let mut tree = Table::empty(source.clone());
    for (name, text) in files {
        let mut report = Report::default();
        let table = Table::parse(text, source, &mut report);
        let table = report.verdict(table).expect("the shipped files are TOML");
        tree.entries.push((name.to_owned(), Node::Table(table)));
    }
    tree
}

/// # Panics
/// Never: a table that was parsed can be written.
pub(crate) fn to_toml(table: &Table) -> String {
    toml::to_string_pretty(table).expect("what was parsed can be written")
}

fn collect(table: &Table, path: &mut Vec<String>, origins: &mut Vec<Origin>) {
    for (key, node) in &table.entries {
        path.push(key.clone());
        match node {
            Node::Table(table) => collect(table, path, origins),
            value => origins.push(Origin {
                key: path.join("."),
                value: value.to_string(),
                from: value.source().label.to_string(),
            }),
        }
        path.pop();
    }
}
