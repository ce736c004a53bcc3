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
#define _Alignof alignof
#else
#define WHICHONE_ASSERT(condition, text) _Static_assert(condition, text)
#endif

/* Bounds. */
"#;

const WIDTH: usize = 106;

/// The header's text.
pub(crate) fn text(model: &Model, docs: &Docs) -> String {
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
    let _ = writeln!(out, "WHICHONE_ASSERT(sizeof(whichone_{c}_t) == {size}, \"size of {name}\");");
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
        Type::Code(name) => {
            return format!("uint8_t {field}{dimensions} /* enum whichone_{} */", snake(name));
        }
        Type::Text(bytes) => format!("whichone_text_{bytes}_t"),
        Type::Struct(rust) => {
            let of = model.structs.iter().find(|it| it.rust == *rust);
            format!("whichone_{}_t", snake(&of.unwrap_or_else(|| panic!("no {rust}")).name))
        }
        Type::Array(..) => unreachable!("the loop ends at other types"),
    };
    format!("{name} {field}{dimensions}")
}

const TOPIC: &str = r#"
/** A topic. */
typedef struct whichone_topic {
    const char *name;
    /** Name of the type for iceoryx2; "u8" where the payload is postcard in a slice of bytes. */
    const char *type;
    /** Key of the layout, an attribute of the topic that both sides must agree on. */
    const char *schema;
    /** Bytes of a message and their alignment; size 0 for a slice of bytes. */
    size_t size, alignment;
    /** The service that writes it; NULL where clients do. */
    const char *writer;
    /** Services that are woken after a message, up to a NULL. */
    const char *wakes[4];
    /** Unread messages that a reader holds, and messages that a late reader still gets. */
    size_t buffer, history;
} whichone_topic_t;

"#;

fn put_topics(out: &mut String, model: &Model) {
    out.push_str(TOPIC);
    let text = |text: &str| format!("\"{text}\"");
    for Topic { name, payload, writer, readers, buffer, history, .. } in &model.topics {
        let constant = name.replace(['/', '-'], "_");
        let of = model.structs.iter().find(|it| it.name == *payload);
        let (ty, size) = match of {
            Some(it) => {
                let ty = format!("whichone_{}_t", snake(&it.name));
                (it.name.as_str(), format!("sizeof({ty}), _Alignof({ty})"))
            }
            None => ("u8", "0, 1".to_owned()),
        };
        let writer = writer.map_or("NULL".to_owned(), |it| text(it.name()));
        assert!(readers.len() < 4, "{name}: more readers are woken than the C header has room for");
        let wakes: Vec<_> =
            readers.iter().map(|it| text(it.name())).chain(["NULL".into()]).collect();
        let (wakes, schema) = (wakes.join(", "), format!("WHICHONE_{}_SCHEMA", upper(payload)));
        let _ = writeln!(out, "/** Carries {payload}. */");
        let _ = writeln!(
            out,
            "static const whichone_topic_t whichone_{constant} = {{\n    \"{name}\", \"{ty}\", {schema}, {size}, {writer}, {{{wakes}}}, {buffer}, {history}}};"
        );
    }
}
