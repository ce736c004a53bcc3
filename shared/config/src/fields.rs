//! A table read key by key, each with its type and range. Problems are collected, never thrown:
//! where a value is wrong its reader returns a placeholder, and the load as a whole fails later.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

use toml::Value;

use crate::layer::{Node, Table};
use crate::nearest;
use crate::problems::Report;

/// One table while it is read. The layers below it hold a default for every key except those that
/// are read with an `optional_…`.
pub(crate) struct Fields<'a> {
    table: &'a Table,
    path: Vec<String>,
    known: Vec<&'static str>,
    wrong: Vec<&'static str>,
    report: &'a mut Report,
}

impl<'a> Fields<'a> {
    pub(crate) fn new(table: &'a Table, path: Vec<String>, report: &'a mut Report) -> Self {
        Self { table, path, known: Vec::new(), wrong: Vec::new(), report }
    }

    /// A number within the range.
    pub(crate) fn number(&mut self, key: &'static str, range: RangeInclusive<f64>) -> f64 {
        let number = self.any_number(key);
        if !self.is_wrong(key) && !range.contains(&number) {
            self.out_of_range(key, number, range.start(), range.end());
        }
        number
    }

    /// A finite number.
    pub(crate) fn any_number(&mut self, key: &'static str) -> f64 {
        match number_in(self.value(key)) {
            Some(number) => number,
            None => self.other_type(key, "a finite number", "write digits, e.g. `1.5`"),
        }
    }

    /// A length of time in seconds within the range.
    pub(crate) fn seconds(&mut self, key: &'static str, range: RangeInclusive<f64>) -> Duration {
        let seconds = self.number(key, range);
        Duration::try_from_secs_f64(seconds).unwrap_or_default()
    }

    /// A whole number within the range.
    pub(crate) fn whole<T>(&mut self, key: &'static str, range: RangeInclusive<T>) -> T
    where
        T: TryFrom<i64> + PartialOrd + Copy + Display + Default,
    {
        let Value::Integer(number) = *self.value(key) else {
            return self.other_type(key, "a whole number", "write digits alone, e.g. `5`");
        };
        match T::try_from(number) {
            Ok(number) if range.contains(&number) => number,
            _ => {
                self.out_of_range(key, number, range.start(), range.end());
                T::default()
            }
        }
    }

    /// Yes or no.
    pub(crate) fn flag(&mut self, key: &'static str) -> bool {
        match self.value(key) {
            Value::Boolean(flag) => *flag,
            _ => self.other_type(key, "true or false", "write `true` or `false`"),
        }
    }

    /// A text that says something.
    pub(crate) fn text(&mut self, key: &'static str) -> String {
        match self.value(key) {
            Value::String(text) if !text.trim().is_empty() => text.clone(),
            Value::String(_) => {
                self.problem(key, "is empty", "write a text");
                String::new()
            }
            _ => self.other_type(key, "a text", "write it in double quotes"),
        }
    }

    /// A text that may be absent; an empty one is absent too, so that a layer can take it back.
    pub(crate) fn optional_text(&mut self, key: &'static str) -> Option<String> {
        self.known.push(key);
        match self.table.get(key)? {
            Node::Leaf(Value::String(text), _) => (!text.is_empty()).then(|| text.clone()),
            _ => self.other_type(key, "a text", "write it in double quotes"),
        }
    }

    /// A path that may be absent. The services run in other folders than the one where it was
    /// written, so it must be absolute.
    pub(crate) fn absolute(&mut self, key: &'static str) -> Option<PathBuf> {
        let path = PathBuf::from(self.optional_text(key)?);
        if !path.is_absolute() {
            self.problem(key, "is not an absolute path", "write it from `/` on");
        }
        Some(path)
    }

    /// A list of texts that say something.
    pub(crate) fn texts(&mut self, key: &'static str) -> Vec<String> {
        let value = self.value(key);
        self.texts_in(key, value)
    }

    /// A program and its arguments, which may be absent; an empty list is absent too.
    pub(crate) fn optional_command(&mut self, key: &'static str) -> Option<Vec<String>> {
        self.known.push(key);
        let command = match self.table.get(key)? {
            Node::Leaf(value, _) => self.texts_in(key, value),
            Node::Table(_) => self.other_type(key, "a list of texts", COMMAND),
        };
        (!command.is_empty()).then_some(command)
    }

    /// Three finite numbers.
    pub(crate) fn triple(&mut self, key: &'static str) -> [f64; 3] {
        let items = self.value(key).as_array();
        let numbers: Option<Vec<f64>> =
            items.and_then(|items| items.iter().map(number_in).collect());
        numbers.and_then(|numbers| numbers.try_into().ok()).unwrap_or_else(|| {
            self.problem(key, "expected three finite numbers", "write `[x, y, z]`");
            [0.0; 3]
        })
    }

    /// One of the named choices.
    pub(crate) fn choice<T: Copy>(&mut self, key: &'static str, choices: &[(&str, T)]) -> T {
        let text = self.text(key);
        match choices.iter().find(|(name, _)| *name == text) {
            Some((_, choice)) => return *choice,
            None if self.is_wrong(key) => {}
            None => self.not_one_of(key, &text, &choices.iter().map(|c| c.0).collect::<Vec<_>>()),
        }
        choices[0].1
    }

    /// A table with fixed keys.
    pub(crate) fn table<T>(
        &mut self,
        key: &'static str,
        read: impl FnOnce(&mut Fields<'_>) -> T,
    ) -> T {
        self.known.push(key);
        let Some(Node::Table(table)) = self.table.get(key) else {
            panic!("{} has defaults", self.path_of(key).join("."));
        };
        let mut fields = Fields::new(table, self.path_of(key), self.report);
        let read = read(&mut fields);
        fields.finish();
        read
    }

    /// A table whose keys are names of the user's, each with a table.
    pub(crate) fn each<T>(
        &mut self,
        key: &'static str,
        mut read: impl FnMut(&str, &mut Fields<'_>) -> T,
    ) -> Vec<T> {
        self.known.push(key);
        let Some(Node::Table(names)) = self.table.get(key) else { return Vec::new() };
        let mut all = Vec::new();
        for (name, node) in &names.entries {
            let mut path = self.path_of(key);
            path.push(name.clone());
            match node {
                Node::Table(table) => {
                    let mut fields = Fields::new(table, path, self.report);
                    all.push(read(name, &mut fields));
                    fields.finish();
                }
                Node::Leaf(_, source) => {
                    let what = format!("expected a table, found {}", node.type_name());
                    let cure = format!("write a table `[{key}.{name}]`");
                    self.report.add(source.problem(&path, what, cure));
                }
            }
        }
        all
    }

    /// A list of tables, each read like a table of the settings over `defaults`, TOML. The list is
    /// one value: a layer that has it replaces it whole.
    pub(crate) fn list<T>(
        &mut self,
        key: &'static str,
        defaults: &str,
        mut read: impl FnMut(&mut Fields<'_>) -> T,
    ) -> Vec<T> {
        let cure = format!("write a table `[[{key}]]` for each");
        let Value::Array(items) = self.value(key) else {
            return self.other_type(key, "a list of tables", &cure);
        };
        let source = self.table.source_of(&[key]).clone();
        let mut all = Vec::new();
        for (n, item) in items.iter().enumerate() {
            let Value::Table(values) = item else {
                return self.other_type(key, "a list of tables alone", &cure);
            };
            let mut table = Table::parse(defaults, &source, self.report)
                .unwrap_or_else(|| panic!("the defaults of {key} are TOML"));
            let leaf = |(name, value): (&String, &Value)| {
                (name.clone(), Node::Leaf(value.clone(), source.clone()))
            };
            let over = Table { entries: values.iter().map(leaf).collect(), source: source.clone() };
            let mut path = self.path_of(&format!("{key}[{}]", n + 1));
            table.merge(over, &mut path, self.report);
            let mut fields = Fields::new(&table, path, self.report);
            all.push(read(&mut fields));
            fields.finish();
        }
        all
    }

    /// Reports the keys that nobody asked for.
    pub(crate) fn finish(self) {
        for (key, node) in &self.table.entries {
            if !self.known.contains(&key.as_str()) {
                let cure = match nearest::nearest(key, &self.known) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("remove it; the keys here are {}", self.known.join(", ")),
                };
                self.report.add(node.source().problem(&self.path_of(key), "unknown key", cure));
            }
        }
    }

    /// Whether `key` had a problem: what else is checked about it would be a follow-on.
    pub(crate) fn is_wrong(&self, key: &str) -> bool {
        self.wrong.contains(&key)
    }

    /// A problem with the value at `key`, told where that value was written.
    pub(crate) fn problem(
        &mut self,
        key: &'static str,
        what: impl Into<String>,
        cure: impl Into<String>,
    ) {
        self.wrong.push(key);
        self.problem_at(&[key], what, cure);
    }

    /// A problem with the value at a key below this table; with the table itself if `keys` is
    /// empty.
    pub(crate) fn problem_at(
        &mut self,
        keys: &[&str],
        what: impl Into<String>,
        cure: impl Into<String>,
    ) {
        let path: Vec<String> =
            self.path.iter().cloned().chain(keys.iter().map(|key| (*key).to_owned())).collect();
        let problem = self.table.source_of(keys).problem(&path, what, cure);
        self.report.add(problem);
    }

    /// Whether nobody wrote the value at a key below this table: of two values that contradict each
    /// other the one that somebody wrote is to be told.
    pub(crate) fn is_built_in(&self, keys: &[&str]) -> bool {
        self.table.source_of(keys).is_built_in()
    }

    /// `found` at `key` is not among `known`.
    pub(crate) fn not_one_of(&mut self, key: &'static str, found: &str, known: &[&str]) {
        let what = format!("`{found}` is not one of {}", known.join(", "));
        let cure = nearest::nearest(found, known).map_or_else(
            || "use one of these".to_owned(),
            |near| format!("did you mean `{near}`?"),
        );
        self.problem(key, what, cure);
    }

    /// The value at a key that has a default.
    fn value(&mut self, key: &'static str) -> &'a Value {
        self.known.push(key);
        match self.table.get(key) {
            Some(Node::Leaf(value, _)) => value,
            _ => panic!("{} has a default", self.path_of(key).join(".")),
        }
    }

    fn texts_in(&mut self, key: &'static str, value: &Value) -> Vec<String> {
        let Value::Array(items) = value else {
            return self.other_type(key, "a list of texts", COMMAND);
        };
        let texts = items.iter().map(|item| match item {
            Value::String(text) if !text.trim().is_empty() => Some(text.clone()),
            _ => None,
        });
        texts.collect::<Option<_>>().unwrap_or_else(|| {
            self.problem(key, "holds something that is no text, or an empty one", COMMAND);
            Vec::new()
        })
    }

    fn other_type<T: Default>(&mut self, key: &'static str, expected: &str, cure: &str) -> T {
        let found = self.table.get(key).map_or("nothing", Node::type_name);
        self.problem(key, format!("expected {expected}, found {found}"), cure);
        T::default()
    }

    fn out_of_range(
        &mut self,
        key: &'static str,
        found: impl Display,
        least: impl Display,
        most: impl Display,
    ) {
        let what = format!("{found} is out of range");
        self.problem(key, what, format!("use a number from {least} to {most}"));
    }

    fn path_of(&self, key: &str) -> Vec<String> {
        let mut path = self.path.clone();
        path.push(key.to_owned());
        path
    }
}

const COMMAND: &str = "write `[\"one\", \"two\"]`";

fn number_in(value: &Value) -> Option<f64> {
    match *value {
        Value::Float(number) => number.is_finite().then_some(number),
        #[expect(clippy::cast_precision_loss, reason = "settings are small")]
        Value::Integer(number) => Some(number as f64),
        _ => None,
    }
}
