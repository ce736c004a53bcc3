//! The messages as Python types: enums, `ctypes` structures, and dataclasses with their encodings.

use std::collections::BTreeMap;
use std::fmt::Write;

use messages::Service;
use messages::topics::Topic;
use serde_reflection::{ContainerFormat, Format, Named, VariantFormat};

use crate::docs::Docs;
use crate::model::{self, Model, Struct, Type, upper, wrapped};

const HEAD: &str = r#""""Messages of the topics. Generated from the wire layout; do not edit.

Numbers are in SI units. Times end in `_ns`: nanoseconds of the monotonic clock (`time.monotonic_ns()`).
Messages of fixed layout are `ctypes` structures, which lie in shared memory as they are; the others are
dataclasses with an encoding.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum

from . import _postcard as encoding
from ._fixed import Array, InvalidMessage, Message, Text, Topic, fixed_text

"#;

/// Width of lines.
const WIDTH: usize = 110;

/// The module's text.
pub(crate) fn text(model: &Model, docs: &Docs) -> String {
    let mut out = HEAD.to_owned();
    for (name, count) in model::BOUNDS {
        let _ = writeln!(out, "{name} = {count}");
    }
    let _ = writeln!(out, "NO_QUESTION = {}", messages::NO_QUESTION);
    for (name, variants) in &model.enums {
        put_enum(&mut out, name, variants, docs);
    }
    for message in &model.structs {
        put_struct(&mut out, message, docs);
    }
    let keys: BTreeMap<_, _> = model.payloads.iter().cloned().collect();
    for (name, format) in &model.types {
        put_type(&mut out, name, format, keys.get(name), (model, docs));
    }
    put_topics(&mut out, model);
    out
}

/// A documentation string with this indentation; nothing for an empty one.
fn put_doc(out: &mut String, indent: &str, doc: &str) {
    if doc.is_empty() {
        return;
    }
    let doc = doc.replace('\\', "\\\\").replace('"', "'");
    let lines = wrapped(&format!("\"\"\"{doc}\"\"\""), WIDTH - indent.len());
    for line in lines {
        let _ = writeln!(out, "{indent}{line}");
    }
}

fn put_enum(out: &mut String, name: &str, variants: &[(String, u32)], docs: &Docs) {
    let _ = writeln!(out, "\n\nclass {name}(IntEnum):");
    put_doc(out, "    ", &or(docs.of(name), &format!("Codes of `{name}`.")));
    out.push('\n');
    for (variant, code) in variants {
        let _ = writeln!(out, "    {} = {code}", upper(variant));
        put_doc(out, "    ", &docs.of_field(name, &model::camel(variant)));
    }
}

fn put_struct(out: &mut String, message: &Struct, docs: &Docs) {
    let Struct { name, rust, size, key, fields } = message;
    let _ = writeln!(out, "\n\nclass {rust}(Message):");
    put_doc(out, "    ", &docs.of(rust));
    out.push('\n');
    let _ = writeln!(
        out,
        "    wire_name = \"{name}\"\n    wire_size = {size}\n    schema_key = \"{key}\""
    );
    for (field, _, ty) in fields {
        let _ = writeln!(out, "    {}: {}", name_of(field), annotation(ty));
        put_doc(out, "    ", &docs.of_field(rust, field));
    }
    let codes = fields.iter().filter_map(|(field, _, ty)| match ty {
        Type::Code(name) => Some(format!("\"{}\": {name}", name_of(field))),
        _ => None,
    });
    let _ = writeln!(out, "    codes = {{{}}}", codes.collect::<Vec<_>>().join(", "));
    out.push_str("    _fields_ = [\n");
    for (field, offset, ty) in fields {
        let field = name_of(field);
        let _ = writeln!(out, "        (\"{field}\", {}),  # {offset}", ctype(ty));
    }
    out.push_str("    ]\n");
}

/// The name of a field: one that is a keyword of Python ends with an underscore.
fn name_of(field: &str) -> &str {
    if field == "from" { "from_" } else { field }
}

fn annotation(ty: &Type) -> String {
    match ty {
        Type::Number(name) if name.starts_with('f') => "float".to_owned(),
        Type::Number(_) | Type::Code(_) => "int".to_owned(),
        Type::Text(_) => "Text".to_owned(),
        Type::Struct(name) => name.clone(),
        Type::Array(element, ..) => format!("Array[{}]", annotation(element)),
    }
}

fn ctype(ty: &Type) -> String {
    match ty {
        Type::Number(name) => {
            let ctype = match name.split_at(1) {
                ("f", "32") => "float".to_owned(),
                ("f", _) => "double".to_owned(),
                ("u", bits) => format!("uint{bits}"),
                (_, bits) => format!("int{bits}"),
            };
            format!("ctypes.c_{ctype}")
        }
        Type::Code(_) => "ctypes.c_uint8".to_owned(),
        Type::Text(bytes) => format!("fixed_text({bytes})"),
        Type::Struct(name) => name.clone(),
        Type::Array(element, count, name) => {
            let count = if name.is_empty() { count.to_string() } else { name.clone() };
            match element.as_ref() {
                Type::Array(..) => format!("({}) * {count}", ctype(element)),
                element => format!("{} * {count}", ctype(element)),
            }
        }
    }
}

fn put_type(
    out: &mut String,
    name: &str,
    format: &ContainerFormat,
    key: Option<&String>,
    (model, docs): (&Model, &Docs),
) {
    match format {
        ContainerFormat::NewTypeStruct(inner) => {
            let _ = writeln!(out, "\n\n{name} = {}", hint(inner));
            let _ = writeln!(out, "{name}_ENCODING = {}", codec(inner, model));
        }
        ContainerFormat::Struct(fields) => {
            let codecs = fields
                .iter()
                .map(|it| format!("    {}={},\n", name_of(&it.name), codec(&it.value, model)));
            let codecs: String = codecs.collect();
            let _ = write!(
                out,
                "\n\n@encoding.struct(\n{codecs})\n@dataclass(kw_only=True)\nclass {name}:\n"
            );
            put_doc(out, "    ", &docs.of(name));
            out.push('\n');
            for field in fields {
                let _ = writeln!(out, "    {}: {}", name_of(&field.name), hint(&field.value));
                put_doc(out, "    ", &docs.of_field(name, &field.name));
            }
            if let Some(key) = key {
                let _ = writeln!(
                    out,
                    "\n\n{name}.wire_name, {name}.schema_key = \"{name}\", \"{key}\""
                );
            }
        }
        ContainerFormat::Enum(variants) => {
            let _ = writeln!(out, "\n\nclass {name}:");
            put_doc(out, "    ", &or(docs.of(name), &format!("One of several forms of `{name}`.")));
            for variant in variants.values() {
                put_variant(out, name, variant, (model, docs));
            }
            let parts = variants
                .iter()
                .map(|(code, it)| format!("{code}: {name}{}", model::camel(&it.name)));
            let parts: Vec<_> = parts.collect();
            let _ =
                writeln!(out, "\n\n{name}_ENCODING = encoding.Variants({{{}}})", parts.join(", "));
        }
        ContainerFormat::UnitStruct | ContainerFormat::TupleStruct(_) => {
            panic!("{name}: no message has such a type yet; help: add it to {}", file!())
        }
    }
}

fn put_variant(
    out: &mut String,
    of: &str,
    Named { name, value }: &Named<VariantFormat>,
    (model, docs): (&Model, &Docs),
) {
    let fields = variant_fields(value);
    let codecs: String = fields
        .iter()
        .map(|(field, format)| format!("    {field}={},\n", codec(format, model)))
        .collect();
    let codecs = if codecs.is_empty() { String::new() } else { format!("\n{codecs}") };
    let class = format!("{of}{}", model::camel(name));
    let _ = write!(
        out,
        "\n\n@encoding.struct({codecs})\n@dataclass(frozen=True)\nclass {class}({of}):\n"
    );
    put_doc(out, "    ", &or(docs.of_field(of, &model::camel(name)), &format!("`{name}`.")));
    if !fields.is_empty() {
        out.push('\n');
    }
    for (field, format) in &fields {
        let _ = writeln!(out, "    {field}: {}", hint(format));
        put_doc(out, "    ", &docs.of_field(of, field));
    }
}

/// Fields of a variant; those without a name are called after their types.
fn variant_fields(format: &VariantFormat) -> Vec<(String, Format)> {
    let named = |format: &Format| match format {
        Format::TypeName(name) if name.ends_with("Id") => {
            (model::snake(name.trim_end_matches("Id")), format.clone())
        }
        Format::TypeName(name) => (model::snake(name), format.clone()),
        _ => ("value".to_owned(), format.clone()),
    };
    match format {
        VariantFormat::Unit | VariantFormat::Variable(_) => Vec::new(),
        VariantFormat::NewType(inner) => vec![named(inner)],
        VariantFormat::Tuple(parts) => parts.iter().map(named).collect(),
        VariantFormat::Struct(fields) => {
            fields.iter().map(|it| (it.name.clone(), it.value.clone())).collect()
        }
    }
}

/// The type of a value as an annotation.
fn hint(format: &Format) -> String {
    match format {
        Format::TypeName(name) => name.clone(),
        Format::Bool => "bool".to_owned(),
        Format::F32 | Format::F64 => "float".to_owned(),
        Format::Str | Format::Char => "str".to_owned(),
        Format::Option(inner) => format!("{} | None", hint(inner)),
        Format::TupleArray { content, .. } if **content == Format::U8 => "bytes".to_owned(),
        Format::Seq(inner) | Format::TupleArray { content: inner, .. } => {
            format!("list[{}]", hint(inner))
        }
        Format::Tuple(parts) => {
            let parts: Vec<_> = parts.iter().map(hint).collect();
            format!("tuple[{}]", parts.join(", "))
        }
        _ => "int".to_owned(),
    }
}

/// The encoding of a value.
fn codec(format: &Format, model: &Model) -> String {
    let simple = |name: &str| format!("encoding.{name}");
    match format {
        Format::TypeName(name) if model.enums.contains_key(name) => {
            format!("encoding.Codes({name})")
        }
        Format::TypeName(name) => match model.types.iter().find(|(of, _)| of == name) {
            Some((_, ContainerFormat::Struct(_))) => format!("encoding.Nested({name})"),
            _ => format!("{name}_ENCODING"),
        },
        Format::Bool => simple("BOOL"),
        Format::U8 => simple("U8"),
        Format::U16 | Format::U32 | Format::U64 => simple("UNSIGNED"),
        Format::I16 | Format::I32 | Format::I64 => simple("SIGNED"),
        Format::F32 => simple("F32"),
        Format::F64 => simple("F64"),
        Format::Str => simple("STR"),
        Format::Option(inner) => format!("encoding.Optional({})", codec(inner, model)),
        Format::Seq(inner) => format!("encoding.Sequence({})", codec(inner, model)),
        Format::Tuple(parts) => {
            let parts: Vec<_> = parts.iter().map(|it| codec(it, model)).collect();
            format!("encoding.Tuple({})", parts.join(", "))
        }
        Format::TupleArray { content, size } if **content == Format::U8 => {
            format!("encoding.Bytes({size})")
        }
        Format::TupleArray { content, size } => {
            format!("encoding.Fixed({}, {size})", codec(content, model))
        }
        _ => panic!("no encoding of {format:?}; help: add it to {}", file!()),
    }
}

fn put_topics(out: &mut String, model: &Model) {
    out.push_str("\n\nTOPICS: dict[str, Topic] = {\n");
    for topic in &model.topics {
        let Topic { name, payload, writer, readers, buffer, history, .. } = topic;
        let rust = model.structs.iter().find(|it| it.name == *payload);
        let message = rust.map_or(*payload, |it| it.rust.as_str());
        let writer = writer.map_or("None".to_owned(), |it| format!("\"{}\"", it.name()));
        let wakes: Vec<_> = readers.iter().copied().map(Service::name).collect();
        let wakes: String = wakes.iter().map(|name| format!("\"{name}\", ")).collect();
        let _ = writeln!(
            out,
            "    \"{name}\": Topic(\"{name}\", {message}, writer={writer}, wakes=({}), buffer={buffer}, history={history}),",
            wakes.trim_end()
        );
    }
    out.push_str("}\n\"\"\"Every topic by name.\"\"\"\n\n");
    out.push_str("for _message in Message.__subclasses__():\n    _message.check_layout()\n");
}

fn or(doc: String, other: &str) -> String {
    if doc.is_empty() { other.to_owned() } else { doc }
}
