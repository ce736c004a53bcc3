//! The merged layers behind the settings.

use diagnostics::{Node, Report, Source, Table, TextFile};

use crate::files::RobotFiles;

/// A part of the settings with a file of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    /// `group.toml`
    Group,
    /// `dialogue.toml`
    Dialogue,
    /// `speech.toml`
    Speech,
    /// `arm.toml`
    Arm,
    /// `study.toml`
    Study,
    /// `console.toml`
    Console,
    /// `ros2.toml`
    Ros2,
    /// `link.toml`
    Link,
}

impl Section {
    /// Every section.
    pub const ALL: [Self; 8] = [
        Self::Group,
        Self::Dialogue,
        Self::Speech,
        Self::Arm,
        Self::Console,
        Self::Study,
        Self::Ros2,
        Self::Link,
    ];

    /// Its name: the first part of its keys.
    pub fn name(self) -> &'static str {
        match self {
            Self::Group => "group",
            Self::Dialogue => "dialogue",
            Self::Speech => "speech",
            Self::Arm => "arm",
            Self::Study => "study",
            Self::Console => "console",
            Self::Ros2 => "ros2",
            Self::Link => "link",
        }
    }

    /// Its file in the configuration folder.
    pub fn file(self) -> String {
        format!("{}.toml", self.name())
    }

    /// The shipped file, which holds the defaults.
    fn shipped(self) -> &'static str {
        match self {
            Self::Group => include_str!("../../../config/group.toml"),
            Self::Dialogue => include_str!("../../../config/dialogue.toml"),
            Self::Speech => include_str!("../../../config/speech.toml"),
            Self::Arm => include_str!("../../../config/arm.toml"),
            Self::Study => include_str!("../../../config/study.toml"),
            Self::Console => include_str!("../../../config/console.toml"),
            Self::Ros2 => include_str!("../../../config/ros2.toml"),
            Self::Link => include_str!("../../../config/link.toml"),
        }
    }
}

/// One value and where it came from.
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
}

impl Resolved {
    pub(crate) fn section_text(&self, section: Section) -> String {
        let mut text = match self.tree.get(section.name()) {
            Some(Node::Table(table)) => to_toml(table),
            _ => String::new(),
        };
        if section == Section::Arm {
            text.push_str(&self.robot.urdf.text);
            text.push_str(self.robot.srdf.as_ref().map_or("", |file| &file.text));
        }
        text
    }

    /// The section of the dialogue without the language model: it reads utterances and decides nothing, so that
    /// journals stay those of one manager whichever model is used.
    pub(crate) fn decision_text(&self) -> String {
        let dialogue = self.tree.get(Section::Dialogue.name()).and_then(Node::as_table).cloned();
        let text = dialogue.map(|mut dialogue| {
            drop(dialogue.take("model"));
            to_toml(&dialogue)
        });
        text.unwrap_or_default()
    }

    pub(crate) fn perception_text(&self) -> String {
        let group = self.tree.get(Section::Group.name()).and_then(Node::as_table);
        let perception = group.and_then(|group| group.get("perception")).and_then(Node::as_table);
        perception.map(to_toml).unwrap_or_default()
    }

    pub(crate) fn origins(&self) -> Vec<Origin> {
        let mut origins = Vec::new();
        collect(&self.tree, &mut Vec::new(), &mut origins);
        origins
    }
}

/// The defaults of every section: the bottom layer.
pub(crate) fn defaults() -> Table {
    let source = Source::built_in();
    let mut tree = Table::empty(source.clone());
    for section in Section::ALL {
        let mut report = Report::default();
        let table = Table::parse(section.shipped(), &source, &mut report);
        let table = report.verdict(table).expect("the shipped files are TOML");
        tree.entries.push((section.name().to_owned(), Node::Table(table)));
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
