//! Reading of lists and tables.

use super::Fields;
use crate::source::quoted;
use crate::{Node, Scalar, Table};

const COMMAND: &str = "write `[\"one\", \"two\"]`";

impl<'a> Fields<'a> {
    /// Reads a list of strings that are not blank; absent is the same as empty.
    pub fn texts(&mut self, key: &'a str) -> Vec<String> {
        let mut texts = Vec::new();
        for (n, item) in self.items(key, "a list of strings", COMMAND).iter().enumerate() {
            texts.extend(self.text_of(&format!("{}[{n}]", quoted(key)), item));
        }
        texts
    }

    /// Reads one string or a list of at least one; absent is an empty list.
    pub fn one_or_more_texts(&mut self, key: &'a str) -> Vec<String> {
        match self.optional(key) {
            None => Vec::new(),
            Some(Node::List(items, _)) => {
                if items.is_empty() {
                    self.problem(key, "an empty list", "write at least one string or remove it");
                }
                self.texts(key)
            }
            Some(node) => self.text_of(key, node).into_iter().collect(),
        }
    }

    /// Reads a program and its arguments, which may be absent; an empty list counts as absent.
    pub fn optional_command(&mut self, key: &'a str) -> Option<Vec<String>> {
        let command = self.texts(key);
        (!command.is_empty()).then_some(command)
    }

    /// Reads three finite numbers.
    pub fn triple(&mut self, key: &'a str) -> [f64; 3] {
        const HELP: &str = "write `[x, y, z]`";
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
        let node = self.optional(key)?;
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

    /// Reads a list of tables, each over `defaults`, TOML; absent is the same as empty. An item that
    /// is a string is short for a table with that `name`.
    pub fn list<T>(
        &mut self,
        key: &'a str,
        defaults: &str,
        mut read: impl FnMut(&mut Fields<'_>) -> T,
    ) -> Vec<T> {
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
