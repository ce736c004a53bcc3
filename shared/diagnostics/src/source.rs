//! Values with the place that they were read from, so that layers of settings can be merged and a
//! diagnostic still points at the text that has to change.

use std::sync::Arc;

use crate::{Diagnostic, Report};

/// A text file and its name in diagnostics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Path, or a description of a built-in file.
    pub label: String,
    /// Text of the source.
    pub text: String,
}

impl TextFile {
    /// A text with a name.
    pub fn new(label: impl Into<String>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into() }
    }
}

/// The place of a value in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Path of the file, or another name.
    pub label: Arc<str>,
    /// Line, from 1, if there is a file.
    pub line: Option<u32>,
    /// Column, from 1, in characters, if there is a line.
    pub column: Option<u32>,
    /// Leading parts of a key that the file leaves out: `arm.toml` says `limb` for `arm.limb`.
    omits: usize,
}

/// The label of values that no file contains.
const BUILT_IN: &str = "built-in defaults";

impl Source {
    /// A source whose keys leave out the first `omits` parts.
    pub fn new(label: impl Into<Arc<str>>, omits: usize) -> Self {
        Self { label: label.into(), line: None, column: None, omits }
    }

    /// The source of defaults.
    pub fn built_in() -> Self {
        Self::new(BUILT_IN, 0)
    }

    /// Returns true for defaults.
    pub fn is_built_in(&self) -> bool {
        &*self.label == BUILT_IN
    }

    /// The key of `path` as this source writes it.
    pub fn key(&self, path: &[String]) -> String {
        path.get(self.omits..).unwrap_or_default().join(".")
    }

    /// A diagnostic at `path`.
    pub fn diagnostic(
        &self,
        path: &[String],
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        self.locate(Diagnostic::new(&*self.label, self.key(path), what, help))
    }

    /// Returns the diagnostic with the source's location.
    fn locate(&self, diagnostic: Diagnostic) -> Diagnostic {
        diagnostic.at(self.line).at_column(self.column)
    }

    /// Returns the same file at a line and a column; defaults have neither.
    pub(crate) fn at(&self, (line, column): (u32, u32)) -> Self {
        let is_file = !self.is_built_in();
        let (line, column) = (is_file.then_some(line), is_file.then_some(column));
        Self { line, column, ..self.clone() }
    }
}

/// A scalar value.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A string.
    Text(String),
    /// An integer.
    Integer(i64),
    /// Any other number.
    Float(f64),
    /// A boolean.
    Boolean(bool),
    /// A value of a type that no reader takes, by the name of its type.
    Other(&'static str),
}

/// A value of a document with its source.
#[derive(Clone, Debug)]
pub enum Node {
    /// A scalar.
    Scalar(Scalar, Source),
    /// A list.
    List(Vec<Node>, Source),
    /// A table.
    Table(Table),
}

/// A table in the order of its text.
#[derive(Clone, Debug)]
pub struct Table {
    /// Keys and values.
    pub entries: Vec<(String, Node)>,
    /// Location of the table.
    pub source: Source,
}

impl Node {
    /// A string.
    pub fn text(text: impl Into<String>, source: &Source) -> Self {
        Self::Scalar(Scalar::Text(text.into()), source.clone())
    }

    /// The place of the value.
    pub fn source(&self) -> &Source {
        match self {
            Self::Scalar(_, source) | Self::List(_, source) | Self::Table(Table { source, .. }) => {
                source
            }
        }
    }

    /// Returns the table, if the value is one.
    pub fn as_table(&self) -> Option<&Table> {
        if let Self::Table(table) = self { Some(table) } else { None }
    }

    /// Returns the string, if the value is one.
    pub fn as_text(&self) -> Option<&str> {
        if let Self::Scalar(Scalar::Text(text), _) = self { Some(text) } else { None }
    }

    /// The finite number, if it is one.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Self::Scalar(Scalar::Float(number), _) => number.is_finite().then_some(*number),
            #[expect(
                clippy::cast_precision_loss,
                reason = "lengths, angles and settings are small"
            )]
            Self::Scalar(Scalar::Integer(number), _) => Some(*number as f64),
            _ => None,
        }
    }

    /// The type of the value, with its article.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Scalar(Scalar::Text(_), _) => "a string",
            Self::Scalar(Scalar::Integer(_), _) => "an integer",
            Self::Scalar(Scalar::Float(number), _) if number.is_finite() => "a number",
            Self::Scalar(Scalar::Float(_), _) => "a number that is not finite",
            Self::Scalar(Scalar::Boolean(_), _) => "a boolean",
            Self::Scalar(Scalar::Other(name), _) => name,
            Self::List(..) => "a list",
            Self::Table(_) => "a table",
        }
    }

    fn merge(&mut self, over: Self, path: &mut Vec<String>, report: &mut Report) {
        match (self, over) {
            (Self::Table(below), Self::Table(over)) => below.merge(over, path, report),
            (below, over) if below.as_table().is_none() && over.as_table().is_none() => {
                *below = over;
            }
            (below, over) => {
                let what = format!("expected {}, found {}", below.type_name(), over.type_name());
                let help = match below {
                    Self::Table(_) => format!("write a table `[{}]`", over.source().key(path)),
                    _ => format!("write `{} = …`", path[path.len() - 1]),
                };
                report.add(over.source().diagnostic(path, what, help));
            }
        }
    }

    /// Returns the location of `rest` of a dotted key in this value; `None` if `rest` does not
    /// continue a key here.
    fn place_within(&self, rest: &str) -> Option<&Source> {
        match self {
            Self::Table(table) => Some(table.place_of(rest.strip_prefix('.')?)),
            Self::List(items, source) => {
                let (n, rest) = rest.strip_prefix('[')?.split_once(']')?;
                let item = n.parse::<usize>().ok().and_then(|n| items.get(n));
                let place = |item| Self::place_within(item, rest).unwrap_or(item.source());
                Some(item.map_or(source, place))
            }
            Self::Scalar(_, source) => rest.starts_with(['.', '[']).then_some(source),
        }
    }
}

impl Table {
    /// A table without entries.
    pub fn empty(source: Source) -> Self {
        Self { entries: Vec::new(), source }
    }

    /// The value at a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Removes and returns the value at a key.
    pub fn take(&mut self, key: &str) -> Option<Node> {
        let at = self.entries.iter().position(|(name, _)| name == key)?;
        Some(self.entries.remove(at).1)
    }

    /// The source of the value at a path below this table, or of the nearest table above it.
    pub fn source_of(&self, path: &[&str]) -> &Source {
        let mut source = &self.source;
        let mut table = Some(self);
        for key in path {
            let node = table.and_then(|table| table.get(key));
            source = node.map_or(source, Node::source);
            table = node.and_then(Node::as_table);
        }
        source
    }

    /// The table at `key`, added if it is missing.
    ///
    /// # Panics
    /// If the value at `key` is not a table.
    pub fn table_at(&mut self, key: &str) -> &mut Self {
        let at = self.entries.iter().position(|(name, _)| name == key).unwrap_or_else(|| {
            let empty = Self::empty(self.source.clone());
            self.entries.push((key.to_owned(), Node::Table(empty)));
            self.entries.len() - 1
        });
        match &mut self.entries[at].1 {
            Node::Table(table) => table,
            _ => panic!("`{key}` is not a table"),
        }
    }

    /// Merges `over` into this table: values replace values, tables are merged key by key. `path`
    /// is the key of this table.
    pub fn merge(&mut self, over: Self, path: &mut Vec<String>, report: &mut Report) {
        for (key, node) in over.entries {
            path.push(key);
            match self.entries.iter_mut().find(|(name, _)| Some(name) == path.last()) {
                None => self.entries.push((path[path.len() - 1].clone(), node)),
                Some((_, below)) => below.merge(node, path, report),
            }
            path.pop();
        }
    }

    /// A diagnostic at a dotted key of this table, with the place of the value that it names, or of
    /// the nearest value that contains it.
    pub fn diagnostic(
        &self,
        key: impl Into<String>,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let key = key.into();
        let place = self.place_of(&key).clone();
        place.locate(Diagnostic::new(&*self.source.label, key, what, help))
    }

    fn place_of(&self, key: &str) -> &Source {
        self.entries
            .iter()
            .find_map(|(name, node)| {
                let rest = key.strip_prefix(quoted(name).as_str())?;
                if rest.is_empty() { Some(node.source()) } else { node.place_within(rest) }
            })
            .unwrap_or(&self.source)
    }
}

/// Returns a key as TOML writes it, in quotes if they are needed.
pub(crate) fn quoted(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { format!("{name:?}") }
}
