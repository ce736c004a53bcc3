//! JSON Schemas of payloads, as viewers take them.

use serde_json::{Map, Value, json};
use serde_reflection::{ContainerFormat, Format, Named, Registry, VariantFormat};

/// The JSON Schema of type `name` in `types`.
///
/// `properties` at its top hold only keys that the viewers understand: they refuse a schema with
/// references, alternatives or lists of lists there. All is under `allOf`, which they skip.
pub(crate) fn json_schema(name: &str, types: &Registry) -> Value {
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
const BASE64: &str = "Base64";

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
    use messages::PolicyView;
    use messages::definition::Definition;
    use messages::schema::Schema;

    use super::*;

    #[test]
    fn schemas_hold_every_field_and_only_plain_ones_at_their_top() {
        let Definition::Payload(types) = PolicyView::definition() else { panic!() };
        let schema = json_schema(PolicyView::NAME, &types);
        assert_eq!(schema["type"], json!("object"));
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
