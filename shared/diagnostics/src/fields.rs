//! Reading of a table key by key, each with its type and range. A wrong value is reported and read
//! as a placeholder, so that one pass finds every problem.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

use serde_json::json;

use crate::schema::{ANY, Schema};
use crate::source::quoted;
use crate::{Node, Report, Scalar, Table, nearest, suggestion};

mod nested;

/// A table being read. [`Fields::finish`] reports keys that no reader asks for.
#[derive(Debug)]
pub struct Fields<'a> {
    table: &'a Table,
    path: Vec<String>,
    known: Vec<&'a str>,
    wrong: Vec<String>,
    report: &'a mut Report,
    /// Schema of the keys read, if one is being made.
    pub(crate) schema: Option<Schema>,
}

const QUOTES: &str = "write it in double quotes";

impl<'a> Fields<'a> {
    /// Reads a table whose key is `path`.
    pub fn new(table: &'a Table, path: Vec<String>, report: &'a mut Report) -> Self {
        Self { table, path, known: Vec::new(), wrong: Vec::new(), report, schema: None }
    }

    /// Reads a number within the range.
    pub fn number(&mut self, key: &'a str, range: RangeInclusive<f64>) -> f64 {
        let number = self.any_number(key);
        self.note(key, || json!({ "minimum": range.start(), "maximum": range.end() }));
        if !self.is_wrong(key) && !range.contains(&number) {
            self.out_of_range(key, number, range.start(), range.end());
        }
        number
    }

    /// Reads a finite number.
    pub fn any_number(&mut self, key: &'a str) -> f64 {
        self.note(key, || json!({ "type": "number" }));
        let number = self.required(key).map(Node::as_number);
        self.typed(key, number, "a finite number", "write digits, e.g. `1.5`")
    }

    /// Reads a number within the range that earlier versions had; schemas do not know its key.
    pub fn former_number(&mut self, key: &'a str, range: RangeInclusive<f64>) -> Option<f64> {
        self.table.get(key)?;
        Some(self.number(key, range))
    }

    /// Reads a length of time in seconds within the range.
    pub fn seconds(&mut self, key: &'a str, range: RangeInclusive<f64>) -> Duration {
        Duration::try_from_secs_f64(self.number(key, range)).unwrap_or_default()
    }

    /// Reads an integer within the range.
    pub fn whole<T>(&mut self, key: &'a str, range: RangeInclusive<T>) -> T
    where
        T: TryFrom<i64> + PartialOrd + Copy + Display + Default,
    {
        self.note(key, || {
            let bound = |bound: &T| bound.to_string().parse::<i64>().ok();
            json!({ "type": "integer", "minimum": bound(range.start()), "maximum": bound(range.end()) })
        });
        let integer = self.required(key).map(|node| match node {
            Node::Scalar(Scalar::Integer(number), _) => Some(*number),
            _ => None,
        });
        let number = self.typed(key, integer, "an integer", "write digits alone, e.g. `5`");
        match T::try_from(number) {
            _ if self.is_wrong(key) => T::default(),
            Ok(number) if range.contains(&number) => number,
            _ => {
                self.out_of_range(key, number, range.start(), range.end());
                T::default()
            }
        }
    }

    /// Reads a boolean.
    pub fn flag(&mut self, key: &'a str) -> bool {
        self.note(key, || json!({ "type": "boolean" }));
        let flag = self.required(key).map(|node| match node {
            Node::Scalar(Scalar::Boolean(flag), _) => Some(*flag),
            _ => None,
        });
        self.typed(key, flag, "a boolean", "write `true` or `false`")
    }

    /// Reads a string that is not blank.
    pub fn text(&mut self, key: &'a str) -> String {
        self.note(key, || json!({ "type": "string", "pattern": "\\S" }));
        let node = self.required(key);
        node.and_then(|node| self.text_of(key, node)).unwrap_or_default()
    }

    /// Reads a string that may be absent. An empty one counts as absent, so that a layer can take
    /// back the string of another.
    pub fn optional_text(&mut self, key: &'a str) -> Option<String> {
        self.note(key, || json!({ "type": "string" }));
        let node = self.optional(key)?;
        let text = self.typed(key, Some(node.as_text().map(str::to_owned)), "a string", QUOTES);
        (!text.is_empty()).then_some(text)
    }

    /// Reads a path that may be absent. It must be absolute: services run in folders other than the
    /// author's.
    pub fn absolute(&mut self, key: &'a str) -> Option<PathBuf> {
        let text = self.optional_text(key);
        self.note(key, || json!({ "pattern": "^(/|$)" }));
        let path = PathBuf::from(text?);
        if !path.is_absolute() {
            self.problem(key, "not an absolute path", "begin it with `/`");
        }
        Some(path)
    }

    /// Reads one of the named choices.
    pub fn choice<T: Copy>(&mut self, key: &'a str, choices: &[(&str, T)]) -> T {
        let text = self.text(key);
        self.note_choices(key, choices.iter().map(|(name, _)| *name));
        match choices.iter().find(|(name, _)| *name == text) {
            Some((_, choice)) => return *choice,
            None if self.is_wrong(key) => {}
            None => self.not_one_of(key, &text, &choices.iter().map(|c| c.0).collect::<Vec<_>>()),
        }
        choices[0].1
    }

    /// The names of all keys.
    pub fn names(&self) -> Vec<&'a str> {
        match self.schema {
            Some(_) => vec![ANY],
            None => self.table.entries.iter().map(|(name, _)| name.as_str()).collect(),
        }
    }

    /// Returns true if the table has the key.
    pub fn has(&self, key: &str) -> bool {
        self.schema.is_some() || self.table.get(key).is_some()
    }

    /// Returns the dotted key of the table.
    pub fn key(&self) -> String {
        self.table.source.key(&self.path)
    }

    /// The dotted key of an entry of this table.
    pub fn key_of(&self, name: &str) -> String {
        self.table.source.key(&self.path_of(&quoted(name)))
    }

    /// Accepts the given keys without reading them.
    pub fn allow(&mut self, keys: &[&'a str]) {
        self.known.extend(keys);
    }

    /// Reports the keys that no reader asked for.
    pub fn finish(self) {
        for (key, node) in &self.table.entries {
            if !self.known.contains(&key.as_str()) {
                let help = suggestion(key, self.known.iter().copied(), || {
                    format!("remove it; the keys here are {}", self.known.join(", "))
                });
                let path = self.path_of(&quoted(key));
                self.report.add(node.source().diagnostic(&path, "unknown key", help));
            }
        }
    }

    /// Returns true if `key` had a problem; further checks would only repeat it.
    pub fn is_wrong(&self, key: &str) -> bool {
        self.wrong.iter().any(|wrong| {
            wrong.strip_prefix(key).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
        })
    }

    /// Returns true if no key of this table had a problem, those of nested tables aside.
    pub fn is_right(&self) -> bool {
        self.wrong.is_empty()
    }

    /// Reports a problem with the value at `key`, or at an item `key[n]` of it.
    pub fn problem(&mut self, key: &str, what: impl Into<String>, help: impl Into<String>) {
        self.wrong.push(key.to_owned());
        let list = key.split('[').next().unwrap_or(key);
        let source = self.table.source_of(&[list]);
        self.report.add(source.diagnostic(&self.path_of(key), what, help));
    }

    /// Reports a problem with the value at `keys` below this table; with the table itself for no
    /// keys.
    pub fn problem_at(&mut self, keys: &[&str], what: impl Into<String>, help: impl Into<String>) {
        let keys_owned = keys.iter().map(|key| (*key).to_owned());
        let path: Vec<String> = self.path.iter().cloned().chain(keys_owned).collect();
        self.report.add(self.table.source_of(keys).diagnostic(&path, what, help));
    }

    /// Returns true for a default. Of two values that contradict each other, the one that the user
    /// wrote is reported.
    pub fn is_built_in(&self, keys: &[&str]) -> bool {
        self.table.source_of(keys).is_built_in()
    }

    /// Reports that `found` at `key` is not among `known`.
    pub fn not_one_of(&mut self, key: &str, found: &str, known: &[&str]) {
        let what = format!("expected one of {}, found `{found}`", known.join(", "));
        let help = nearest(found, known.iter().copied())
            .map_or_else(String::new, |near| format!("did you mean `{near}`?"));
        self.problem(key, what, help);
    }

    fn optional(&mut self, key: &'a str) -> Option<&'a Node> {
        self.known.push(key);
        let node = self.table.get(key);
        if let (Some(schema), Some(node)) = (&mut self.schema, node) {
            schema.set_default(key, node);
        }
        node
    }

    fn required(&mut self, key: &'a str) -> Option<&'a Node> {
        let node = self.optional(key);
        if let Some(schema) = &mut self.schema {
            schema.require(key, node);
        }
        if node.is_none() {
            self.problem(key, "missing", format!("add `{key} = …`"));
        }
        node
    }

    fn text_of(&mut self, key: &str, node: &Node) -> Option<String> {
        let text = match node.as_text() {
            Some(text) => text,
            None => return self.other_type(key, "a string", node, QUOTES),
        };
        if text.trim().is_empty() {
            self.problem(key, "expected text, found an empty string", "write at least one letter");
            return None;
        }
        Some(text.to_owned())
    }

    /// A value that was converted from the node at `key`: missing, or of another type, or right.
    fn typed<T: Default>(
        &mut self,
        key: &'a str,
        value: Option<Option<T>>,
        expected: &str,
        help: &str,
    ) -> T {
        match (value, self.table.get(key)) {
            (Some(Some(value)), _) => value,
            (Some(None), Some(node)) => self.other_type(key, expected, node, help),
            _ => T::default(),
        }
    }

    fn other_type<T: Default>(&mut self, key: &str, expected: &str, node: &Node, help: &str) -> T {
        self.problem(key, format!("expected {expected}, found {}", node.type_name()), help);
        T::default()
    }

    fn out_of_range(
        &mut self,
        key: &str,
        found: impl Display,
        least: impl Display,
        most: impl Display,
    ) {
        self.problem(key, format!("expected a value from {least} to {most}, found {found}"), "");
    }

    fn path_of(&self, key: &str) -> Vec<String> {
        self.path.iter().cloned().chain([key.to_owned()]).collect()
    }
}
