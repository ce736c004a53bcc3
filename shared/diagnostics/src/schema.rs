//! JSON Schema of the tables that a reader accepts, made by the reader itself: [`Fields`] notes
//! each key that is read, with its type and range, so that a schema always matches the program.

use serde_json::{Map, Value as Json, json};

use crate::{Fields, Node, Report, Scalar, Source, Table};

/// The placeholder for the user's names in a table whose keys are names.
pub(crate) const ANY: &str = "*";

/// The schema of one table, as far as it has been read.
#[derive(Debug, Default)]
pub(crate) struct Schema {
    properties: Map<String, Json>,
    pub(crate) required: Vec<String>,
    dependent: Map<String, Json>,
}

/// Returns the schema of the tables that `read` accepts. Keys of `defaults` may be left out.
///
/// Each list is read as if it had one item and each table as if it were there, so `read` meets
/// empty texts and zeros in those that have no defaults. Its diagnostics are dropped.
pub fn schema_of<T>(defaults: &Table, read: impl FnOnce(&mut Fields<'_>) -> T) -> Json {
    record(Some(defaults), read).1
}

/// Reads a table, or an empty one, and returns the result with the schema.
pub(crate) fn record<T>(
    table: Option<&Table>,
    read: impl FnOnce(&mut Fields<'_>) -> T,
) -> (T, Json) {
    let empty = Table::empty(Source::built_in());
    let mut report = Report::default();
    let mut fields = Fields::new(table.unwrap_or(&empty), Vec::new(), &mut report);
    fields.schema = Some(Schema::default());
    let read = read(&mut fields);
    (read, fields.schema.take().unwrap_or_default().into_json())
}

/// The schema of a text that is not blank.
pub(crate) fn text() -> Json {
    json!({ "type": "string", "pattern": "\\S" })
}

/// Returns whether a table of this schema needs no key but `name`, so that a string can replace it.
pub(crate) fn is_named_alone(item: &Json) -> bool {
    item["required"] == json!(["name"])
}

impl Schema {
    pub(crate) fn set(&mut self, key: &str, schema: Json) {
        self.properties.insert(key.to_owned(), schema);
    }

    /// Adds to the schema of a key.
    fn add(&mut self, key: &str, more: Json) {
        match (self.properties.get_mut(key), more) {
            (Some(Json::Object(known)), Json::Object(more)) if !more.contains_key("anyOf") => {
                known.extend(more);
            }
            (_, more) => self.set(key, more),
        }
    }

    /// Notes the default of a key, unless it is a table or has some.
    pub(crate) fn set_default(&mut self, key: &str, default: &Node) {
        let is_plain = match default {
            Node::Scalar(..) => !is_blank(default),
            Node::List(items, _) => items.iter().all(|item| matches!(item, Node::Scalar(..))),
            Node::Table(_) => false,
        };
        if let Some(default) = is_plain.then(|| serde_json::to_value(default).ok()).flatten() {
            self.add(key, json!({ "default": default }));
        }
    }

    /// Notes that a key is required, unless it has a default that is more than a blank text.
    pub(crate) fn require(&mut self, key: &str, default: Option<&Node>) {
        let is_missing = default.is_none_or(is_blank);
        if is_missing && key != ANY && !self.required.iter().any(|known| known == key) {
            self.required.push(key.to_owned());
        }
    }

    /// Makes the keys that were required since `before` required only with one of `keys`.
    pub(crate) fn bind(&mut self, keys: &[&str], before: Vec<String>) {
        let all = std::mem::replace(&mut self.required, before);
        let bound: Vec<String> =
            all.into_iter().filter(|key| !self.required.contains(key)).collect();
        for key in keys {
            let others: Vec<&String> = bound.iter().filter(|other| other != key).collect();
            self.dependent.insert((*key).to_owned(), json!(others));
        }
    }

    fn into_json(mut self) -> Json {
        let others = self.properties.remove(ANY).unwrap_or(Json::Bool(false));
        let mut json = json!({ "type": "object" });
        if !self.properties.is_empty() {
            json["properties"] = Json::Object(self.properties);
        }
        if !self.required.is_empty() {
            json["required"] = json!(self.required);
        }
        if !self.dependent.is_empty() {
            json["dependencies"] = Json::Object(self.dependent);
        }
        json["additionalProperties"] = others;
        json
    }
}

fn is_blank(node: &Node) -> bool {
    matches!(node, Node::Scalar(Scalar::Text(text), _) if text.trim().is_empty())
}

impl<'a> Fields<'a> {
    /// Adds to the schema of `key`, if one is being made: a rule that the reader enforces by other
    /// means than a method of this type.
    pub fn note(&mut self, key: &'a str, rule: impl FnOnce() -> Json) {
        if let Some(schema) = &mut self.schema {
            schema.add(key, rule());
        }
    }

    /// Notes that the list at `key` is required and has an item.
    pub fn at_least_one(&mut self, key: &'a str) {
        self.note(key, || json!({ "minItems": 1 }));
        if let Some(schema) = &mut self.schema {
            schema.require(key, None);
        }
    }

    /// Notes that `key` is one of the names.
    pub fn note_choices<'n>(&mut self, key: &'a str, names: impl Iterator<Item = &'n str>) {
        if let Some(schema) = &mut self.schema {
            let names: Vec<&str> = names.collect();
            let default =
                schema.properties.get(key).and_then(|known| known.get("default")).cloned();
            schema.set(key, json!({ "enum": names }));
            if let Some(default) = default {
                schema.add(key, json!({ "default": default }));
            }
        }
    }
}
