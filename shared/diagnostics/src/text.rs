//! Conversion of TOML and JSON to values with their places, and back to TOML.

use std::fmt;

use serde::de::Deserialize;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value as Json;
use toml::de::{DeTable, DeValue, ValueDeserializer};
use toml::{Spanned, Value};

use crate::{Diagnostic, Node, Report, Scalar, Source, Table};

impl Node {
    /// The value with a source; no tables keep an order of their own.
    pub fn from_toml(value: Value, source: &Source) -> Self {
        let scalar = match value {
            Value::String(text) => Scalar::Text(text),
            Value::Integer(number) => Scalar::Integer(number),
            Value::Float(number) => Scalar::Float(number),
            Value::Boolean(flag) => Scalar::Boolean(flag),
            Value::Datetime(_) => Scalar::Other("a date"),
            Value::Array(items) => {
                let items = items.into_iter().map(|item| Self::from_toml(item, source)).collect();
                return Self::List(items, source.clone());
            }
            Value::Table(table) => {
                let entries = table.into_iter().map(|(k, v)| (k, Self::from_toml(v, source)));
                return Self::Table(Table { entries: entries.collect(), source: source.clone() });
            }
        };
        Self::Scalar(scalar, source.clone())
    }

    /// A JSON value with a source.
    pub fn from_json(json: &Json, source: &Source) -> Self {
        let scalar = match json {
            Json::String(text) => Scalar::Text(text.clone()),
            Json::Number(number) => number.as_i64().map_or_else(
                || Scalar::Float(number.as_f64().unwrap_or(f64::NAN)),
                Scalar::Integer,
            ),
            Json::Bool(flag) => Scalar::Boolean(*flag),
            Json::Null => Scalar::Other("null"),
            Json::Array(items) => {
                let items = items.iter().map(|item| Self::from_json(item, source)).collect();
                return Self::List(items, source.clone());
            }
            Json::Object(map) => {
                let entries = map.iter().map(|(k, v)| (k.clone(), Self::from_json(v, source)));
                return Self::Table(Table { entries: entries.collect(), source: source.clone() });
            }
        };
        Self::Scalar(scalar, source.clone())
    }
}

impl Table {
    /// Parses TOML; every syntax error is reported.
    pub fn parse(text: &str, source: &Source, report: &mut Report) -> Option<Self> {
        let lines = Places::of(text);
        let (table, errors) = DeTable::parse_recoverable(text);
        if errors.is_empty() {
            let mut parser = Parser { lines, source, path: Vec::new(), report };
            return Some(parser.table(table.into_inner(), source.clone()));
        }
        for error in errors {
            let offset = error.span().map_or(0, |span| span.start);
            let (line, column) = lines.of_offset(offset);
            let syntax =
                Diagnostic::new(&*source.label, "", error.message(), "correct the TOML here");
            report.add(syntax.at(Some(line)).at_column(Some(column)));
        }
        None
    }
}

/// Conversion of a parsed text, which keeps the order of keys: the parser sorts them, but knows
/// their positions.
struct Parser<'a> {
    lines: Places<'a>,
    source: &'a Source,
    path: Vec<String>,
    report: &'a mut Report,
}

impl Parser<'_> {
    fn table(&mut self, table: DeTable<'_>, source: Source) -> Table {
        let mut entries: Vec<(Spanned<_>, Spanned<DeValue<'_>>)> = table.into_iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let mut read = Table::empty(source);
        for (key, value) in entries {
            let place = self.lines.of_offset(key.span().start);
            let key = key.into_inner().into_owned();
            self.path.push(key.clone());
            read.entries.extend(self.node(value, place).map(|node| (key, node)));
            self.path.pop();
        }
        read
    }

    fn node(&mut self, value: Spanned<DeValue<'_>>, place: (u32, u32)) -> Option<Node> {
        let source = self.source.at(place);
        let span = value.span();
        match value.into_inner() {
            DeValue::Table(table) => Some(Node::Table(self.table(table, source))),
            DeValue::Array(items) => {
                let item = |item: Spanned<DeValue<'_>>| {
                    let place = self.lines.of_offset(item.span().start);
                    self.node(item, place)
                };
                Some(Node::List(items.into_iter().filter_map(item).collect(), source))
            }
            leaf => match Value::deserialize(ValueDeserializer::from(Spanned::new(span, leaf))) {
                Ok(value) => Some(Node::from_toml(value, &source)),
                Err(error) => {
                    let help = "write a value that TOML can hold";
                    let (label, key) = (&*source.label, self.path.join("."));
                    let found = Diagnostic::new(label, key, error.message(), help);
                    self.report.add(found.at(source.line).at_column(source.column));
                    None
                }
            },
        }
    }
}

/// Longest part of a line of which characters are counted, bytes.
const COUNTED_MAX: usize = 4096;

/// Lines and columns of a text.
struct Places<'a> {
    text: &'a str,
    /// Byte offsets at which the lines begin.
    starts: Vec<usize>,
}

impl<'a> Places<'a> {
    fn of(text: &'a str) -> Self {
        let after = text.match_indices('\n').map(|(at, _)| at + 1);
        Self { text, starts: std::iter::once(0).chain(after).collect() }
    }

    /// Line and column of a byte offset, both from 1; the column in characters, and in bytes if a
    /// line is so long that counting its characters for each value would take too long.
    fn of_offset(&self, offset: usize) -> (u32, u32) {
        let line = self.starts.partition_point(|start| *start <= offset);
        let start = self.starts[line - 1];
        let before = self.text.get(start..offset).filter(|before| before.len() <= COUNTED_MAX);
        let column = before.map_or(offset - start, |before| before.chars().count()) + 1;
        let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        (number(line), number(column))
    }
}

impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.entries.len()))?;
        self.entries.iter().try_for_each(|(key, node)| map.serialize_entry(key, node))?;
        map.end()
    }
}

impl Serialize for Node {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Scalar(Scalar::Text(text), _) => serializer.serialize_str(text),
            Self::Scalar(Scalar::Integer(number), _) => serializer.serialize_i64(*number),
            Self::Scalar(Scalar::Float(number), _) => serializer.serialize_f64(*number),
            Self::Scalar(Scalar::Boolean(flag), _) => serializer.serialize_bool(*flag),
            Self::Scalar(Scalar::Other(name), _) => serializer.serialize_str(name),
            Self::List(items, _) => items.serialize(serializer),
            Self::Table(table) => table.serialize(serializer),
        }
    }
}

/// The value as TOML.
impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Value::try_from(self).map_err(|_| fmt::Error)?.fmt(f)
    }
}
