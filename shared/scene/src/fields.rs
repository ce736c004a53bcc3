//! A table read key by key, so that a file's unknown keys, missing keys and wrong types are all
//! found in one pass instead of one per attempt.

use crate::problem::Report;

/// A parsed text, whichever syntax it was written in.
#[derive(Clone, Debug)]
pub(crate) enum Node {
    Text(String),
    Number(f64),
    List(Vec<Node>),
    Table(Vec<(String, Node)>),
    /// Anything that a scene has no use for, by the name of its type.
    Other(&'static str),
}

impl Node {
    fn type_name(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Number(_) => "a number",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
            Self::Other(name) => name,
        }
    }
}

impl From<toml::Value> for Node {
    fn from(value: toml::Value) -> Self {
        match value {
            toml::Value::String(text) => Self::Text(text),
            #[expect(clippy::cast_precision_loss, reason = "lengths and angles are small")]
            toml::Value::Integer(number) => Self::Number(number as f64),
            toml::Value::Float(number) => Self::Number(number),
            toml::Value::Array(items) => Self::List(items.into_iter().map(Self::from).collect()),
            toml::Value::Table(table) => {
                Self::Table(table.into_iter().map(|(key, value)| (key, value.into())).collect())
            }
            toml::Value::Boolean(_) => Self::Other("a boolean"),
            toml::Value::Datetime(_) => Self::Other("a date"),
        }
    }
}

impl From<&serde_json::Value> for Node {
    fn from(value: &serde_json::Value) -> Self {
        use serde_json::Value;
        match value {
            Value::String(text) => Self::Text(text.clone()),
            Value::Number(number) => Self::Number(number.as_f64().unwrap_or(f64::NAN)),
            Value::Array(items) => Self::List(items.iter().map(Self::from).collect()),
            Value::Object(map) => {
                Self::Table(map.iter().map(|(key, value)| (key.clone(), value.into())).collect())
            }
            Value::Bool(_) => Self::Other("a boolean"),
            Value::Null => Self::Other("null"),
        }
    }
}

/// The entries of one table. Every key that is asked for becomes a known key; what nobody asked
/// for is reported by [`Fields::finish`].
pub(crate) struct Fields {
    key: String,
    entries: Vec<(String, Node)>,
    known: Vec<&'static str>,
}

impl Fields {
    /// Opens the table at `key`; anything else there is a problem and reads as an empty table
    /// whose missing keys are not worth a further complaint, hence `None`.
    pub(crate) fn open(key: String, node: Node, report: &mut Report) -> Option<Self> {
        match node {
            Node::Table(entries) => Some(Self { key, entries, known: Vec::new() }),
            other => {
                report.add(key, format!("expected a table, found {}", other.type_name()), "");
                None
            }
        }
    }

    /// The dotted key of this table's entry `name`.
    pub(crate) fn key_of(&self, name: &str) -> String {
        join(&self.key, name)
    }

    /// Whether there is an entry of that name still unread.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.entries.iter().any(|(key, _)| key == name)
    }

    /// Takes the entry `name` out, whatever it is.
    pub(crate) fn take(&mut self, name: &'static str) -> Option<Node> {
        self.known.push(name);
        let at = self.entries.iter().position(|(key, _)| key == name)?;
        Some(self.entries.remove(at).1)
    }

    /// A string that must be there and say something.
    pub(crate) fn text(&mut self, name: &'static str, report: &mut Report) -> Option<String> {
        let node = self.take(name);
        match node {
            Some(node) => text(&self.key_of(name), node, report),
            None => {
                report.add(self.key_of(name), "missing", format!("add `{name} = \"…\"`"));
                None
            }
        }
    }

    /// A string that may be absent.
    pub(crate) fn optional_text(
        &mut self,
        name: &'static str,
        report: &mut Report,
    ) -> Option<String> {
        let node = self.take(name)?;
        text(&self.key_of(name), node, report)
    }

    /// One string or a list of them; absent is an empty list, an empty list is a problem.
    pub(crate) fn one_or_more_texts(
        &mut self,
        name: &'static str,
        report: &mut Report,
    ) -> Vec<String> {
        let key = self.key_of(name);
        match self.take(name) {
            None => Vec::new(),
            Some(Node::List(items)) => {
                if items.is_empty() {
                    report.add(&key, "says nothing", "write at least one text or leave it out");
                }
                let items = items.into_iter().enumerate();
                items.filter_map(|(n, item)| text(&format!("{key}[{n}]"), item, report)).collect()
            }
            Some(node) => text(&key, node, report).into_iter().collect(),
        }
    }

    /// A list of strings that may be absent.
    pub(crate) fn texts(&mut self, name: &'static str, report: &mut Report) -> Vec<String> {
        let key = self.key_of(name);
        let items = self.list(name, report);
        let texts = items.into_iter().enumerate();
        texts.filter_map(|(n, item)| text(&format!("{key}[{n}]"), item, report)).collect()
    }

    /// A list that may be absent, which is the same as empty.
    pub(crate) fn list(&mut self, name: &'static str, report: &mut Report) -> Vec<Node> {
        match self.take(name) {
            None => Vec::new(),
            Some(Node::List(items)) => items,
            Some(other) => {
                let what = format!("expected a list, found {}", other.type_name());
                report.add(self.key_of(name), what, "write `[…]`");
                Vec::new()
            }
        }
    }

    /// A finite number; `None` and a problem if it is absent or anything else.
    pub(crate) fn number(&mut self, name: &'static str, report: &mut Report) -> Option<f64> {
        let key = self.key_of(name);
        match self.take(name) {
            Some(node) => number(&key, &node, report),
            None => {
                report.add(key, "missing", format!("add `{name} = …`"));
                None
            }
        }
    }

    /// Three finite numbers; `None` and a problem if they are absent or anything else.
    pub(crate) fn triple(&mut self, name: &'static str, report: &mut Report) -> Option<[f64; 3]> {
        let key = self.key_of(name);
        let Some(node) = self.take(name) else {
            report.add(key, "missing", format!("add `{name} = [x, y, z]`"));
            return None;
        };
        let Node::List(items) = node else {
            let what = format!("expected three numbers, found {}", node.type_name());
            report.add(key, what, "write `[x, y, z]`");
            return None;
        };
        if items.len() != 3 {
            report.add(key, format!("expected three numbers, found {}", items.len()), "");
            return None;
        }
        let numbers: Vec<Option<f64>> = (items.iter().enumerate())
            .map(|(n, item)| number(&format!("{key}[{n}]"), item, report))
            .collect();
        Some([numbers[0]?, numbers[1]?, numbers[2]?])
    }

    /// Every entry with its dotted key, for tables whose keys are names of the scene's own.
    pub(crate) fn into_entries(self) -> Vec<(String, String, Node)> {
        let Self { key, entries, .. } = self;
        entries.into_iter().map(|(name, node)| (join(&key, &name), name, node)).collect()
    }

    /// Reports the keys that nobody asked for.
    pub(crate) fn finish(self, report: &mut Report) {
        let cure = format!("remove it; the keys here are {}", self.known.join(", "));
        for (name, _) in &self.entries {
            report.add(self.key_of(name), "unknown key", cure.clone());
        }
    }
}

/// The string at `key`; a problem unless it says something.
pub(crate) fn text(key: &str, node: Node, report: &mut Report) -> Option<String> {
    match node {
        Node::Text(text) if !text.trim().is_empty() => Some(text),
        Node::Text(_) => {
            report.add(key, "is empty", "write at least one letter");
            None
        }
        other => {
            let what = format!("expected a string, found {}", other.type_name());
            report.add(key, what, "write it in double quotes");
            None
        }
    }
}

fn number(key: &str, node: &Node, report: &mut Report) -> Option<f64> {
    match node {
        Node::Number(number) if number.is_finite() => Some(*number),
        Node::Number(_) => {
            report.add(key, "is not a finite number", "write a plain number");
            None
        }
        other => {
            report.add(key, format!("expected a number, found {}", other.type_name()), "");
            None
        }
    }
}

/// `parent.name`, the name quoted where TOML would ask for quotes.
fn join(parent: &str, name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let name = match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => format!("{name:?}"),
    };
    match parent.is_empty() {
        true => name,
        false => format!("{parent}.{name}"),
    }
}
