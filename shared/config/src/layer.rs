//! A tree of settings in which every value remembers where it was written, so that layers can be
//! laid over each other and a problem still points at the text that a person has to mend.

use std::sync::Arc;

use scene::Problem;
use serde::de::Deserialize;
use serde::ser::{Serialize, SerializeMap, Serializer};
use toml::de::{DeTable, DeValue, ValueDeserializer};
use toml::{Spanned, Value};

use crate::problems::Report;

/// Where something was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// The file, as people know it.
    pub(crate) label: Arc<str>,
    /// How many leading parts of a key the file leaves out: `arm.toml` says `limb` for `arm.limb`.
    pub(crate) omits: usize,
}

impl Source {
    pub(crate) fn new(label: impl Into<Arc<str>>, omits: usize) -> Self {
        Self { label: label.into(), omits }
    }

    /// What holds where nothing is written.
    pub(crate) fn built_in() -> Self {
        Self::new(BUILT_IN, 0)
    }

    pub(crate) fn is_built_in(&self) -> bool {
        &*self.label == BUILT_IN
    }

    /// The key of `path` as this source writes it.
    pub(crate) fn key(&self, path: &[String]) -> String {
        path.get(self.omits..).unwrap_or_default().join(".")
    }

    /// A problem at `path`.
    pub(crate) fn problem(
        &self,
        path: &[String],
        what: impl Into<String>,
        cure: impl Into<String>,
    ) -> Problem {
        Problem::new(&*self.label, self.key(path), what, cure)
    }
}

/// The label of what is not written in any file of the user's.
const BUILT_IN: &str = "built-in defaults";

/// A table in the order of its text.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) entries: Vec<(String, Node)>,
    pub(crate) source: Source,
}

/// What a key stands for.
#[derive(Clone, Debug)]
pub(crate) enum Node {
    Leaf(Value, Source),
    Table(Table),
}

impl Node {
    pub(crate) fn source(&self) -> &Source {
        match self {
            Self::Leaf(_, source) | Self::Table(Table { source, .. }) => source,
        }
    }

    pub(crate) fn as_table(&self) -> Option<&Table> {
        match self {
            Self::Table(table) => Some(table),
            Self::Leaf(..) => None,
        }
    }

    /// The type of the value, with its article.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Self::Table(_) | Self::Leaf(Value::Table(_), _) => "a table",
            Self::Leaf(Value::String(_), _) => "a text",
            Self::Leaf(Value::Integer(_), _) => "a whole number",
            Self::Leaf(Value::Float(_), _) => "a number",
            Self::Leaf(Value::Boolean(_), _) => "true or false",
            Self::Leaf(Value::Datetime(_), _) => "a date",
            Self::Leaf(Value::Array(_), _) => "a list",
        }
    }
}

impl Table {
    pub(crate) fn empty(source: Source) -> Self {
        Self { entries: Vec::new(), source }
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Where the value at a key below this table was written, or the nearest table above it.
    pub(crate) fn source_of(&self, keys: &[&str]) -> &Source {
        let mut source = &self.source;
        let mut table = Some(self);
        for key in keys {
            let node = table.and_then(|table| table.get(key));
            source = node.map_or(source, Node::source);
            table = node.and_then(Node::as_table);
        }
        source
    }

    /// The table at `key`, made where there is none.
    ///
    /// # Panics
    /// Where `key` is a value: only for keys whose shape is known.
    pub(crate) fn table_at(&mut self, key: &str) -> &mut Self {
        let at = self.entries.iter().position(|(name, _)| name == key).unwrap_or_else(|| {
            let empty = Self::empty(self.source.clone());
            self.entries.push((key.to_owned(), Node::Table(empty)));
            self.entries.len() - 1
        });
        match &mut self.entries[at].1 {
            Node::Table(table) => table,
            Node::Leaf(..) => panic!("`{key}` is a table"),
        }
    }

    /// Reads a text; every place where it stops being TOML is a problem.
    pub(crate) fn parse(text: &str, source: &Source, report: &mut Report) -> Option<Self> {
        let (table, errors) = DeTable::parse_recoverable(text);
        if errors.is_empty() {
            return Some(from_toml(table.into_inner(), source, &mut Vec::new(), report));
        }
        for error in errors {
            let (line, column) = place(text, error.span().map_or(0, |span| span.start));
            let key = format!("line {line}, column {column}");
            let message = error.message().to_owned();
            report.add(Problem::new(&*source.label, key, message, "mend the TOML here"));
        }
        None
    }

    /// Lays `over` on top. Values replace values, tables are merged key by key; `path` is the key
    /// of this table.
    pub(crate) fn merge(&mut self, over: Self, path: &mut Vec<String>, report: &mut Report) {
        for (key, node) in over.entries {
            path.push(key);
            match self.entries.iter_mut().find(|(name, _)| Some(name) == path.last()) {
                None => self.entries.push((path[path.len() - 1].clone(), node)),
                Some((_, below)) => merge_node(below, node, path, report),
            }
            path.pop();
        }
    }
}

fn merge_node(below: &mut Node, over: Node, path: &mut Vec<String>, report: &mut Report) {
    match (below, over) {
        (Node::Table(below), Node::Table(over)) => below.merge(over, path, report),
        (below @ Node::Leaf(..), over @ Node::Leaf(..)) => *below = over,
        (below, over) => {
            let what = format!("expected {}, found {}", below.type_name(), over.type_name());
            let cure = match below {
                Node::Table(_) => format!("write a table `[{}]`", over.source().key(path)),
                Node::Leaf(..) => format!("write `{} = …`", path[path.len() - 1]),
            };
            report.add(over.source().problem(path, what, cure));
        }
    }
}

/// Keys in the order of the text: the parser sorts them, but knows where each stood. `path` is the
/// table's key in the text.
fn from_toml(
    table: DeTable<'_>,
    source: &Source,
    path: &mut Vec<String>,
    report: &mut Report,
) -> Table {
    let mut entries: Vec<(Spanned<_>, Spanned<DeValue<'_>>)> = table.into_iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let mut read = Table::empty(source.clone());
    for (key, value) in entries {
        let key = key.into_inner().into_owned();
        path.push(key.clone());
        let span = value.span();
        let node = match value.into_inner() {
            DeValue::Table(table) => Some(Node::Table(from_toml(table, source, path, report))),
            leaf => match Value::deserialize(ValueDeserializer::from(Spanned::new(span, leaf))) {
                Ok(value) => Some(Node::Leaf(value, source.clone())),
                Err(error) => {
                    let (key, cure) = (path.join("."), "write a value that TOML can hold");
                    report.add(Problem::new(&*source.label, key, error.message(), cure));
                    None
                }
            },
        };
        path.pop();
        read.entries.extend(node.map(|node| (key, node)));
    }
    read
}

impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.entries.len()))?;
        for (key, node) in &self.entries {
            match node {
                Node::Leaf(value, _) => map.serialize_entry(key, value)?,
                Node::Table(table) => map.serialize_entry(key, table)?,
            }
        }
        map.end()
    }
}

/// Line and column of a byte offset, both from 1, the column in characters.
fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
