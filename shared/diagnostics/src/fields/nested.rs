//! Reading of lists and tables.

use serde_json::json;

use super::Fields;
use crate::schema;
use crate::source::quoted;
use crate::{Node, Scalar, Table};

const COMMAND: &str = "write `[\"one\", \"two\"]`";

impl<'a> Fields<'a> {
    /// Reads a list of strings that are not blank; absent is the same as empty.
    pub fn texts(&mut self, key: &'a str) -> Vec<String> {
        self.note(key, || json!({ "type": "array", "items": schema::text() }));
        let mut texts = Vec::new();
        for (n, item) in self.items(key, "a list of strings", COMMAND).iter().enumerate() {
            texts.extend(self.text_of(&format!("{}[{n}]", quoted(key)), item));
        }
        texts
    }

    /// Reads one string or a list of at least one; absent is an empty list.
    pub fn one_or_more_texts(&mut self, key: &'a str) -> Vec<String> {
        let texts = match self.optional(key) {
            None => Vec::new(),
            Some(Node::List(items, _)) => {
                if items.is_empty() {
                    self.problem(key, "an empty list", "write at least one string or remove it");
                }
                self.texts(key)
            }
            Some(node) => self.text_of(key, node).into_iter().collect(),
        };
        let list = || json!({ "type": "array", "items": schema::text(), "minItems": 1 });
        self.note(key, || json!({ "anyOf": [schema::text(), list()] }));
        texts
    }

    /// Reads a program and its arguments, which may be absent; an empty list counts as absent.
    pub fn optional_command(&mut self, key: &'a str) -> Option<Vec<String>> {
        let command = self.texts(key);
        (!command.is_empty()).then_some(command)
    }

    /// Reads three finite numbers.
    pub fn triple(&mut self, key: &'a str) -> [f64; 3] {
        const HELP: &str = "write `[x, y, z]`";
        self.note(key, || {
            let number = json!({ "type": "number" });
            json!({ "type": "array", "items": number, "minItems": 3, "maxItems": 3 })
        });
        let Some(node) = self.required(key) else { return [0.0; 3] };
        let Node::List(items, _) = node else {
            return self.other_type(key, "three finite numbers", node, HELP);
        };
        let numbers: Vec<f64> = items.iter().filter_map(Node::as_number).collect();
        if let Some(n) = items.iter().position(|item| item.as_number().is_none()) {
            let item = format!("{}[{n}]", quoted(key));
            self.other_type(&item, "a finite number", &items[n], HELP)
        } else if let Ok(triple) = numbers.try_into() {
            triple
        } else {
            let what = format!("expected three finite numbers, found {}", items.len());
            self.problem(key, what, HELP);
            [0.0; 3]
        }
    }

    /// Reads a table with fixed keys, which may be absent.
    pub fn optional_table<T>(
        &mut self,
        key: &'a str,
        read: impl FnOnce(&mut Fields<'_>) -> T,
    ) -> Option<T> {
        let node = self.optional(key);
        if let Some(parent) = &mut self.schema {
            let (read, made) = schema::record(node.and_then(Node::as_table), read);
            parent.set(key, made);
            return Some(read);
        }
        let node = node?;
        let Node::Table(table) = node else {
            let help = format!("write a table `[{}]`", self.key_of(key));
            self.other_type::<()>(key, "a table", node, &help);
            return None;
        };
        let mut fields = Fields::new(table, self.path_of(&quoted(key)), self.report);
        let read = read(&mut fields);
        fields.finish();
        Some(read)
    }

    /// Reads a key that may be absent.
    pub fn optionally<T>(
        &mut self,
        key: &'a str,
        read: impl FnOnce(&mut Self, &'a str) -> T,
    ) -> Option<T> {
        if !self.has(key) {
            self.allow(&[key]);
            return None;
        }
        let read = read(self, key);
        if let Some(schema) = &mut self.schema {
            schema.required.retain(|required| required != key);
        }
        Some(read)
    }

    /// Reads keys that belong together, if one of `keys` is there: those that `read` requires are
    /// all present or all absent.
    pub fn together<T>(
        &mut self,
        keys: &[&'a str],
        read: impl FnOnce(&mut Self) -> T,
    ) -> Option<T> {
        if !keys.iter().any(|key| self.has(key)) {
            self.allow(keys);
            return None;
        }
        let required = self.schema.as_ref().map(|schema| schema.required.clone());
        let read = read(self);
        if let (Some(schema), Some(before)) = (&mut self.schema, required) {
            schema.bind(keys, before);
        }
        self.allow(keys);
        Some(read)
    }

    /// Reads a table with fixed keys.
    ///
    /// # Panics
    /// If it is missing: for tables that have defaults.
    pub fn table<T>(&mut self, key: &'a str, read: impl FnOnce(&mut Fields<'_>) -> T) -> T {
        let read = self.optional_table(key, read);
        read.unwrap_or_else(|| panic!("{} has defaults", self.path_of(key).join(".")))
    }

    /// Reads a table whose keys are the user's names, each with a table.
    pub fn each<T>(
        &mut self,
        key: &'a str,
        mut read: impl FnMut(&str, &mut Fields<'_>) -> T,
    ) -> Vec<T> {
        let all = self.optional_table(key, |f| {
            let names = f.names();
            names.into_iter().filter_map(|name| f.optional_table(name, |f| read(name, f))).collect()
        });
        all.unwrap_or_default()
    }

    /// Reads a list of tables, each over `defaults`, TOML; absent is the same as empty. An item
    /// that is a string is short for a table with that `name`.
    pub fn list<T>(
        &mut self,
        key: &'a str,
        defaults: &str,
        mut read: impl FnMut(&mut Fields<'_>) -> T,
    ) -> Vec<T> {
        if self.schema.is_some() {
            return vec![self.list_schema(key, defaults, read)];
        }
        let help = format!("write a table `[[{key}]]` for each");
        let mut all = Vec::new();
        for (n, item) in self.items(key, "a list of tables", &help).iter().enumerate() {
            let item_key = format!("{}[{n}]", quoted(key));
            let over = match item {
                Node::Table(over) => over.clone(),
                Node::Scalar(Scalar::Text(_), source) if defaults.is_empty() => Table {
                    entries: vec![("name".to_owned(), item.clone())],
                    source: source.clone(),
                },
                _ => {
                    let expected =
                        if defaults.is_empty() { "a string or a table" } else { "a table" };
                    self.other_type::<()>(&item_key, expected, item, &help);
                    continue;
                }
            };
            let mut table = Table::parse(defaults, &item.source().clone(), self.report)
                .unwrap_or_else(|| panic!("the defaults of {key} are TOML"));
            table.source = over.source.clone();
            let mut path = self.path_of(&item_key);
            table.merge(over, &mut path, self.report);
            let mut fields = Fields::new(&table, path, self.report);
            all.push(read(&mut fields));
            fields.finish();
        }
        all
    }

    /// Notes the schema of a list's items, and returns one of them.
    fn list_schema<T>(
        &mut self,
        key: &'a str,
        defaults: &str,
        read: impl FnOnce(&mut Fields<'_>) -> T,
    ) -> T {
        self.known.push(key);
        let source = self.table.source.clone();
        let table = Table::parse(defaults, &source, self.report);
        let (read, item) = schema::record(table.as_ref(), read);
        let is_short = defaults.is_empty() && schema::is_named_alone(&item);
        let item = if is_short { json!({ "anyOf": [schema::text(), item] }) } else { item };
        self.note(key, || json!({ "type": "array", "items": item }));
        read
    }

    /// The items of a list, empty if it is absent.
    fn items(&mut self, key: &'a str, expected: &str, help: &str) -> &'a [Node] {
        match self.optional(key) {
            None => &[],
            Some(Node::List(items, _)) => items,
            Some(node) => {
                self.other_type::<()>(key, expected, node, help);
                &[]
            }
        }
    }
}
