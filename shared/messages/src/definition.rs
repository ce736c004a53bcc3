//! Descriptions of message types for programs that do not share this code: ROS 2 message
//! definitions of fixed layouts, whose bytes are CDR as they lie, and JSON Schemas of payloads.
//!
//! A fixed layout has no implicit padding and its fields are aligned to their size, as CDR
//! prescribes. So a message is CDR once four bytes for "plain, little-endian" precede it.

use serde_json::{Map, Value, json};
use serde_reflection::{ContainerFormat, Format, Named, Registry, VariantFormat};

/// Package of the message types in ROS 2 message definitions.
const PACKAGE: &str = "whichone";
/// Line between a definition and those of the types in it.
const SEPARATOR: &str =
    "================================================================================";

/// Description of a message type.
#[derive(Clone, Debug, PartialEq)]
pub enum Definition {
    /// A fixed layout: a ROS 2 message definition, with those of the types in it.
    Ros2Msg(String),
    /// A payload in postcard: the JSON Schema of the same value in JSON.
    JsonSchema(Value),
}

/// Type of a field as a ROS 2 message definition has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldType {
    /// A primitive type, or a message type with its package.
    pub name: String,
    /// Number of elements of an array field.
    pub count: Option<usize>,
    /// The codes of an enum, with their names.
    pub constants: Vec<(&'static str, u8)>,
    /// Message types that the definition needs, with their own definitions.
    pub nested: Vec<(String, String)>,
}

impl FieldType {
    /// A primitive type.
    pub fn primitive(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// A message type of this package with these fields.
    pub fn message(name: &str, fields: &[(&str, Self)]) -> Self {
        let mut text = String::new();
        let mut nested: Vec<(String, String)> = Vec::new();
        for (field, ty) in fields {
            for (constant, code) in &ty.constants {
                let (field, constant) = (upper(field), upper(constant));
                text += &format!("{} {field}_{constant}={code}\n", ty.name);
            }
            let count = ty.count.map(|count| format!("[{count}]")).unwrap_or_default();
            text += &format!("{}{count} {field}\n", ty.name);
            for one in &ty.nested {
                if !nested.contains(one) {
                    nested.push(one.clone());
                }
            }
        }
        let name = format!("{PACKAGE}/{name}");
        nested.insert(0, (name.clone(), text));
        Self { name, nested, ..Self::default() }
    }

    /// An array of `count` of these; arrays of arrays are one, element after element.
    #[must_use]
    pub fn array(mut self, count: usize) -> Self {
        self.count = Some(count * self.count.unwrap_or(1));
        self
    }

    /// The definition of a message type, with those of the types in it.
    pub fn definition(&self) -> Definition {
        let mut parts = self.nested.iter();
        let mut text = parts.next().map(|(_, own)| own.clone()).unwrap_or_default();
        for (name, own) in parts {
            text += &format!("{SEPARATOR}\nMSG: {name}\n{own}");
        }
        Definition::Ros2Msg(text)
    }
}

/// `MotionInhibit` and `hindrance` as constants have them: `MOTION_INHIBIT`, `HINDRANCE`.
fn upper(name: &str) -> String {
    let mut text = String::new();
    for (i, letter) in name.char_indices() {
        if i > 0 && letter.is_ascii_uppercase() {
            text.push('_');
        }
        text.push(letter.to_ascii_uppercase());
    }
    text
}

/// The JSON Schema of type `name` in `types`.
///
/// `properties` at its top hold only keys that the viewers understand: they refuse a schema with
/// references, alternatives or lists of lists there. All is under `allOf`, which they skip.
pub fn json_schema(name: &str, types: &Registry) -> Value {
    let defs: Map<String, Value> =
        types.iter().map(|(name, format)| (name.clone(), container(format))).collect();
    let fields = match types.get(name) {
        Some(ContainerFormat::Struct(fields)) => fields.as_slice(),
        _ => &[],
    };
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": name,
        "type": "object",
        "properties": plain_fields(fields, types),
        "allOf": [reference(name)],
        "$defs": defs,
    })
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// Name of the type of bytes that JSON holds as text.
pub const BASE64: &str = "Base64";

fn container(format: &ContainerFormat) -> Value {
    match format {
        ContainerFormat::UnitStruct => json!({ "type": "null" }),
        ContainerFormat::NewTypeStruct(inner) => value(inner),
        ContainerFormat::TupleStruct(parts) => tuple(parts),
        ContainerFormat::Struct(fields) => object(fields),
        ContainerFormat::Enum(variants) => {
            let variants: Vec<Value> = variants.values().map(variant).collect();
            json!({ "oneOf": variants })
        }
    }
}

fn variant(Named { name, value: format }: &Named<VariantFormat>) -> Value {
    let content = match format {
        VariantFormat::Unit | VariantFormat::Variable(_) => return json!({ "const": name }),
        VariantFormat::NewType(inner) => value(inner),
        VariantFormat::Tuple(parts) => tuple(parts),
        VariantFormat::Struct(fields) => object(fields),
    };
    json!({
        "type": "object",
        "properties": { name: content },
        "required": [name],
        "additionalProperties": false,
    })
}

fn object(fields: &[Named<Format>]) -> Value {
    let properties: Map<String, Value> =
        fields.iter().map(|field| (field.name.clone(), value(&field.value))).collect();
    let required: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
    json!({ "type": "object", "properties": properties, "required": required })
}

fn tuple(parts: &[Format]) -> Value {
    let (items, count): (Vec<Value>, _) = (parts.iter().map(value).collect(), parts.len());
    json!({ "type": "array", "prefixItems": items, "minItems": count, "maxItems": count })
}

fn value(format: &Format) -> Value {
    match format {
        Format::TypeName(name) => reference(name),
        Format::Option(inner) => json!({ "anyOf": [value(inner), { "type": "null" }] }),
        Format::Seq(inner) => json!({ "type": "array", "items": value(inner) }),
        Format::Map { value: inner, .. } => {
            json!({ "type": "object", "additionalProperties": value(inner) })
        }
        Format::Tuple(parts) => tuple(parts),
        Format::TupleArray { content, size } => {
            json!({ "type": "array", "items": value(content), "minItems": size, "maxItems": size })
        }
        Format::Variable(_) => json!({}),
        Format::Unit => json!({ "type": "null" }),
        Format::Bytes => json!({ "type": "array", "items": { "type": "integer" } }),
        primitive => json!({ "type": primitive_name(primitive) }),
    }
}

fn primitive_name(format: &Format) -> &'static str {
    match format {
        Format::Bool => "boolean",
        Format::F32 | Format::F64 => "number",
        Format::Char | Format::Str => "string",
        _ => "integer",
    }
}

/// The fields that viewers understand, with references followed.
fn plain_fields(fields: &[Named<Format>], types: &Registry) -> Map<String, Value> {
    let plain = |field: &Named<Format>| Some((field.name.clone(), plain(&field.value, types)?));
    fields.iter().filter_map(plain).collect()
}

fn plain(format: &Format, types: &Registry) -> Option<Value> {
    match format {
        Format::TypeName(name) if name == BASE64 => {
            Some(json!({ "type": "string", "contentEncoding": "base64" }))
        }
        Format::TypeName(name) => match types.get(name)? {
            ContainerFormat::NewTypeStruct(inner) => plain(inner, types),
            ContainerFormat::Struct(fields) => {
                Some(json!({ "type": "object", "properties": plain_fields(fields, types) }))
            }
            ContainerFormat::Enum(variants) => {
                let is_unit = |it: &Named<VariantFormat>| matches!(it.value, VariantFormat::Unit);
                variants.values().all(is_unit).then(|| json!({ "type": "string" }))
            }
            ContainerFormat::UnitStruct | ContainerFormat::TupleStruct(_) => None,
        },
        Format::Seq(content) | Format::TupleArray { content, .. } => {
            let items = plain(content, types).filter(|items| items["type"] != "array")?;
            Some(json!({ "type": "array", "items": items }))
        }
        Format::Variable(_)
        | Format::Unit
        | Format::Bytes
        | Format::Option(_)
        | Format::Map { .. }
        | Format::Tuple(_) => None,
        primitive => Some(json!({ "type": primitive_name(primitive) })),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::Schema;
    use crate::topics::{self, Topic};
    use crate::{ArmStatus, AudioChunk, PolicyView, RobotAct};

    fn ros2<T: Schema>() -> String {
        match T::definition() {
            Definition::Ros2Msg(text) => text,
            Definition::JsonSchema(schema) => panic!("{schema}"),
        }
    }

    #[test]
    fn layouts_become_ros2_definitions_with_nested_types_and_constants() {
        let text = ros2::<RobotAct>();
        let (own, nested) = text.split_once(SEPARATOR).unwrap();
        assert!(own.contains("uint8 KIND_PUT_BACK=5\n"), "{own}");
        assert!(own.contains(
            "\nuint8 kind\nuint8 in_words\nuint8[2] reserved\nwhichone/Question question\n"
        ));
        assert!(own.ends_with("whichone/Text244 text\n"), "{own}");
        assert!(nested.contains("MSG: whichone/Question\nuint16 kind\n"), "{nested}");
        assert!(nested.contains("MSG: whichone/Text244\nuint32 len\nuint8[244] bytes\n"));
        assert!(ros2::<AudioChunk>().ends_with("int16[1600] samples\n"));
        assert!(ros2::<ArmStatus>().contains("uint8 HINDRANCE_CALIBRATING=7\nuint8 hindrance\n"));
    }

    #[test]
    fn every_topic_has_a_definition_of_its_encoding() {
        for Topic { name, layout, definition, .. } in topics::ALL.iter().chain(&topics::robot::ALL)
        {
            match definition() {
                Definition::Ros2Msg(text) => {
                    assert!(layout().is_some() && !text.is_empty(), "{name}")
                }
                Definition::JsonSchema(schema) => {
                    assert!(layout().is_none(), "{name}");
                    assert_eq!(schema["type"], json!("object"), "{name}");
                    assert!(schema["$defs"].as_object().is_some_and(|defs| !defs.is_empty()));
                }
            }
        }
    }

    #[test]
    fn schemas_hold_every_field_and_only_plain_ones_at_their_top() {
        let Definition::JsonSchema(schema) = PolicyView::definition() else { panic!() };
        let top = schema["properties"].as_object().unwrap();
        assert_eq!(top["belief"], json!({ "type": "array", "items": { "type": "number" } }));
        assert_eq!(top["decision"], json!({ "type": "string" }));
        for absent in ["question", "person", "alternatives", "last"] {
            assert!(!top.contains_key(absent), "{absent}: {top:?}");
        }
        let whole = &schema["$defs"]["PolicyView"]["properties"];
        assert_eq!(whole["question"], json!({ "$ref": "#/$defs/Question" }));
        let person = &whole["person"]["anyOf"];
        assert_eq!((&person[0]["maxItems"], &person[1]["type"]), (&json!(2), &json!("null")));
    }
}
