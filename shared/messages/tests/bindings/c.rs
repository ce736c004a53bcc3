//! The messages as a C header: structures with their sizes and offsets asserted, codes, and topics.

use std::fmt::Write;

use messages::topics::Topic;

use crate::docs::Docs;
use crate::model::{self, Model, Struct, Type, snake, upper, wrapped};

const HEAD: &str = r#"/* Messages of the topics. Generated from the wire layout; do not edit.
 *
 * Numbers are in SI units. Names that end in _ns are times: nanoseconds of CLOCK_MONOTONIC. Structures lie in
 * shared memory as they are here. Topics whose payload has no structure carry postcard in a slice of bytes.
 */
#ifndef WHICHONE_H
#define WHICHONE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define WHICHONE_ASSERT(condition, text) static_assert(condition, text)
#else
#define WHICHONE_ASSERT(condition, text) _Static_assert(condition, text)
#endif

/* Bounds. */
"#;

const WIDTH: usize = 106;

/// The header's text.
pub fn text(model: &Model, docs: &Docs) -> String {
    let mut out = HEAD.to_owned();
    for (name, count) in model::BOUNDS {
        let _ = writeln!(out, "#define WHICHONE_{name} {count}u");
    }
    let _ = writeln!(out, "#define WHICHONE_NO_QUESTION {}u", messages::NO_QUESTION);
    for (name, variants) in &model.enums {
        put_enum(&mut out, name, variants, docs);
    }
    put_texts(&mut out, model);
    for message in &model.structs {
        put_struct(&mut out, message, (model, docs));
    }
    out.push_str("\n/* Payloads without a structure: postcard in a slice of bytes. */\n");
    for (name, key) in &model.payloads {
        let _ = writeln!(out, "#define WHICHONE_{}_SCHEMA \"{key}\"", upper(name));
    }
    put_topics(&mut out, model);
    out.push_str("\n#endif\n");
    out
}

fn put_doc(out: &mut String, indent: &str, doc: &str) {
    if doc.is_empty() {
        return;
    }
    let lines = wrapped(&format!("/** {} */", doc.replace("*/", "* /")), WIDTH - indent.len());
    for line in lines {
        let _ = writeln!(out, "{indent}{line}");
    }
}

fn put_enum(out: &mut String, name: &str, variants: &[(String, u32)], docs: &Docs) {
    out.push('\n');
    put_doc(out, "", &docs.of(name));
    let _ = writeln!(out, "enum whichone_{} {{", snake(name));
    for (variant, code) in variants {
        put_doc(out, "    ", &docs.of_field(name, &model::camel(variant)));
        let _ = writeln!(out, "    WHICHONE_{}_{} = {code},", upper(name), upper(variant));
    }
    out.push_str("};\n");
}

/// The structures of texts, one for each length.
fn put_texts(out: &mut String, model: &Model) {
    let mut lengths: Vec<usize> = Vec::new();
    let types = model.structs.iter().flat_map(|it| &it.fields).map(|(.., ty)| ty);
    for ty in types {
        let inner = if let Type::Array(element, ..) = ty { element } else { ty };
        if let Type::Text(bytes) = inner {
            lengths.push(*bytes);
        }
    }
    lengths.sort_unstable();
    lengths.dedup();
    for bytes in lengths {
        let _ = writeln!(
            out,
            "\n/** UTF-8 text of at most {bytes} bytes, without a zero at its end. */\n\
             typedef struct whichone_text_{bytes} {{\n    uint32_t len;\n    char bytes[{bytes}];\n}} whichone_text_{bytes}_t;"
        );
    }
}

fn put_struct(out: &mut String, message: &Struct, (model, docs): (&Model, &Docs)) {
    let Struct { name, rust, size, key, fields } = message;
    let c = snake(name);
    out.push('\n');
    put_doc(out, "", &docs.of(rust));
    let _ = writeln!(out, "typedef struct whichone_{c} {{");
    for (field, _, ty) in fields {
        put_doc(out, "    ", &docs.of_field(rust, field));
        let _ = writeln!(out, "    {};", declaration(ty, field, model));
    }
    let _ = writeln!(out, "}} whichone_{c}_t;");
    let _ = writeln!(
        out,
        "WHICHONE_ASSERT(sizeof(whichone_{c}_t) == {size}, \"size of {name}\");"
    );
    for (field, offset, _) in fields {
        let _ = writeln!(
            out,
            "WHICHONE_ASSERT(offsetof(whichone_{c}_t, {field}) == {offset}, \"offset of {name}.{field}\");"
        );
    }
    let _ = writeln!(out, "#define WHICHONE_{}_TYPE \"{name}\"", upper(name));
    let _ = writeln!(out, "#define WHICHONE_{}_SCHEMA \"{key}\"", upper(name));
}

/// A field's declaration.
fn declaration(ty: &Type, field: &str, model: &Model) -> String {
    let (mut ty, mut dimensions) = (ty, String::new());
    while let Type::Array(element, count, name) = ty {
        let count = if name.is_empty() { count.to_string() } else { format!("WHICHONE_{name}") };
        dimensions += &format!("[{count}]");
        ty = element;
    }
    let name = match ty {
        Type::Number(name) => match name.split_at(1) {
            ("f", "32") => "float".to_owned(),
            ("f", _) => "double".to_owned(),
            ("u", bits) => format!("uint{bits}_t"),
            (_, bits) => format!("int{bits}_t"),
        },
        Type::Code(name) => return format!("uint8_t {field}{dimensions} /* enum whichone_{} */", snake(name)),
        Type::Text(bytes) => format!("whichone_text_{bytes}_t"),
        Type::Struct(rust) => {
            let of = model.structs.iter().find(|it| it.rust == *rust);
            format!("whichone_{}_t", snake(&of.unwrap_or_else(|| panic!("no {rust}")).name))
        }
        Type::Array(..) => unreachable!("the loop ends at other types"),
    };
    format!("{name} {field}{dimensions}")
}

fn put_topics(out: &mut String, model: &Model) {
    out.push_str("\n/* Topics. */\n");
    for Topic { name, payload, writer, readers, .. } in &model.topics {
        let constant = name.replace(['/', '-'], "_").to_ascii_uppercase();
        let writer = writer.map_or("clients", |it| it.name());
        let wakes: Vec<_> = readers.iter().map(|it| it.name()).collect();
        let wakes = if wakes.is_empty() { String::new() } else { format!(", wakes {}", wakes.join(" ")) };
        let _ = writeln!(out, "/** {payload}, written by {writer}{wakes}. */");
        let _ = writeln!(out, "#define WHICHONE_TOPIC_{constant} \"{name}\"");
    }
}
