//! A description of an interface, against which answers are checked.

use serde_json::{Map, Value as Json};

/// The description that a console serves.
#[derive(Clone, Debug)]
pub struct Description(Json);

impl Description {
    /// Reads it.
    ///
    /// # Panics
    /// If it is not JSON.
    pub fn new(text: &str) -> Self {
        Self(serde_json::from_str(text).expect("JSON"))
    }

    /// Checks an answer: its status, its type and its body are those of the description.
    ///
    /// # Panics
    /// If they are not.
    pub fn check(&self, method: &str, path: &str, status: u16, kind: &str, body: &str) {
        let place = format!("{method} {path} {status}");
        let operation = &self.0["paths"][path][method.to_lowercase()];
        assert!(operation.is_object(), "{place}: not described");
        let response = &operation["responses"][status.to_string()];
        assert!(response.is_object(), "{place}: no such status is described: {body}");
        let content = &self.resolved(response)["content"][kind];
        assert!(content.is_object(), "{place}: type {kind:?} is not described");
        if kind.ends_with("json") {
            let body: Json = serde_json::from_str(body).expect("a body of JSON");
            self.check_schema(&place, &content["schema"], &body);
        }
    }

    /// Checks a value against a named schema.
    ///
    /// # Panics
    /// If it does not match.
    pub fn check_named(&self, name: &str, value: &Json) {
        let schema = &self.0["components"]["schemas"][name];
        assert!(schema.is_object(), "schema {name} not found");
        self.check_schema(name, schema, value);
    }

    fn resolved<'a>(&'a self, value: &'a Json) -> &'a Json {
        let Some(path) = value["$ref"].as_str() else { return value };
        let path = path.strip_prefix('#').expect("a reference within the description");
        self.0.pointer(path).unwrap_or_else(|| panic!("{path} not found"))
    }

    fn check_schema(&self, place: &str, schema: &Json, value: &Json) {
        let schema =
            self.resolved(schema).as_object().unwrap_or_else(|| panic!("{place}: no schema"));
        for (keyword, said) in schema {
            let is_met = match keyword.as_str() {
                "type" => types(said).any(|name| is_of(name, value)),
                "enum" => said.as_array().is_some_and(|all| all.contains(value)),
                "const" => said == value,
                "minimum" => value.as_f64().is_none_or(|number| Some(number) >= said.as_f64()),
                "maximum" => value.as_f64().is_none_or(|number| Some(number) <= said.as_f64()),
                "required" => said.as_array().into_iter().flatten().all(|key| {
                    let key = key.as_str().expect("a key");
                    value.as_object().is_none_or(|value| value.contains_key(key))
                }),
                "items" => {
                    let items = value.as_array().into_iter().flatten();
                    items.for_each(|item| self.check_schema(&format!("{place}[]"), said, item));
                    true
                }
                "properties" | "additionalProperties" | "description" | "default" => true,
                other => panic!("{place}: the keyword {other} is not checked"),
            };
            assert!(is_met, "{place}: expected {keyword} {said}, found {value}");
        }
        if let Some(fields) = value.as_object() {
            self.check_fields(place, schema, fields);
        }
    }

    fn check_fields(&self, place: &str, schema: &Map<String, Json>, fields: &Map<String, Json>) {
        let known = schema.get("properties").and_then(Json::as_object);
        for (key, value) in fields {
            let place = format!("{place}.{key}");
            match known.and_then(|known| known.get(key)).or(schema.get("additionalProperties")) {
                Some(Json::Bool(false)) => panic!("{place}: not described"),
                Some(Json::Bool(true)) | None => {}
                Some(schema) => self.check_schema(&place, schema, value),
            }
        }
    }
}

fn types(said: &Json) -> impl Iterator<Item = &str> {
    let many = said.as_array().into_iter().flatten();
    many.chain(said.is_string().then_some(said)).filter_map(Json::as_str)
}

fn is_of(name: &str, value: &Json) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("unknown type {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_are_checked_against_their_schema() {
        let schema = json!({
            "type": ["object", "null"], "additionalProperties": false, "required": ["a"],
            "properties": { "a": { "type": "integer", "minimum": 1 },
                            "b": { "type": "array", "items": { "enum": ["x"] } } },
        });
        let description = json!({ "components": { "schemas": { "S": schema } } }).to_string();
        let passes = |value: Json| {
            let description = Description::new(&description);
            std::panic::catch_unwind(move || description.check_named("S", &value)).is_ok()
        };
        assert!(passes(json!({ "a": 1, "b": ["x"] })) && passes(Json::Null));
        for wrong in [
            json!({}),
            json!({ "a": 0 }),
            json!({ "a": 1.5 }),
            json!({ "a": 1, "b": ["y"] }),
            json!({ "a": 1, "c": 1 }),
            json!([]),
        ] {
            assert!(!passes(wrong.clone()), "{wrong}");
        }
    }
}
