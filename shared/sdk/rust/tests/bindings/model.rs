//! Types of the wire as data: fixed layouts and payloads, read from their schemas.

use std::collections::BTreeMap;

use messages::robot::{JOINTS_MAX, LIMB_JOINTS};
use messages::topics::{self, Topic};
use messages::*;
use serde_reflection::{ContainerFormat, Format, FormatHolder, VariantFormat};

use crate::layouts::{self, Layout};

/// Bounds that the types of fields name.
pub(crate) const BOUNDS: [(&str, usize); 14] = [
    ("ASKED_MAX", ASKED_MAX),
    ("BASE_WORDS_MAX", BASE_WORDS_MAX),
    ("CHUNK_SAMPLES_MAX", CHUNK_SAMPLES_MAX),
    ("CONFIDENCES_MAX", CONFIDENCES_MAX),
    ("EXCLUDED_GROUPS_MAX", EXCLUDED_GROUPS_MAX),
    ("EXCLUDED_WORDS_MAX", EXCLUDED_WORDS_MAX),
    ("FURTHER_MAX", FURTHER_MAX),
    ("HYPOTHESES_MAX", HYPOTHESES_MAX),
    ("JOINTS_MAX", JOINTS_MAX),
    ("JOINT_STATE_LEN", JOINT_STATE_LEN),
    ("LIMB_JOINTS", LIMB_JOINTS),
    ("PERSON_BYTES_MAX", vocabulary::PERSON_BYTES_MAX),
    ("READINGS_MAX", READINGS_MAX),
    ("UTTERANCE_BYTES_MAX", UTTERANCE_BYTES_MAX),
];

/// Type of a field of a fixed layout.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Type {
    /// A number, by its name in Rust.
    Number(String),
    /// One byte that holds a code of this enum.
    Code(String),
    /// Text of at most so many bytes, after its length.
    Text(usize),
    /// Another fixed layout, by its name in Rust.
    Struct(String),
    /// Several of one type: their number and, where it has one, the bound's name.
    Array(Box<Self>, usize, String),
}

impl Type {
    /// Reads a type as Rust writes it.
    fn parse(text: &str) -> Self {
        if let Some(inner) = text.strip_prefix('[').and_then(|it| it.strip_suffix(']')) {
            let (element, count) = inner.rsplit_once(';').unwrap();
            let (count, name) = bound(count.trim());
            return Self::Array(Box::new(Self::parse(element.trim())), count, name);
        }
        let Some((outer, argument)) = text.strip_suffix('>').and_then(|it| it.split_once('<'))
        else {
            let is_struct = text.starts_with(|c: char| c.is_ascii_uppercase());
            return if is_struct { Self::Struct(text.into()) } else { Self::Number(text.into()) };
        };
        match outer {
            "Code" => Self::Code(argument.to_owned()),
            "FixedText" => Self::Text(bound(argument).0),
            "Pcm" => {
                let (count, name) = bound(argument);
                Self::Array(Box::new(Self::Number("i16".into())), count, name)
            }
            _ => panic!("no other language has {text}; help: add it to {}", file!()),
        }
    }
}

fn bound(text: &str) -> (usize, String) {
    if let Ok(count) = text.parse() {
        return (count, String::new());
    }
    let found = BOUNDS.iter().find(|(name, _)| *name == text);
    let (name, count) = found.unwrap_or_else(|| panic!("{text} is not among BOUNDS"));
    (*count, (*name).to_owned())
}

/// A message of fixed layout.
#[derive(Clone, Debug)]
pub(crate) struct Struct {
    /// Name on the wire.
    pub(crate) name: String,
    /// Name in Rust.
    pub(crate) rust: String,
    /// Bytes.
    pub(crate) size: usize,
    /// Structural key.
    pub(crate) key: String,
    /// Name, offset and type of each field.
    pub(crate) fields: Vec<(String, usize, Type)>,
}

/// Everything that travels.
#[derive(Debug)]
pub(crate) struct Model {
    /// Enums without data by name: their variants with codes, in order.
    pub(crate) enums: BTreeMap<String, Vec<(String, u32)>>,
    /// Fixed layouts, those first that others contain.
    pub(crate) structs: Vec<Struct>,
    /// Types inside payloads, those first that others contain.
    pub(crate) types: Vec<(String, ContainerFormat)>,
    /// Payloads with their keys.
    pub(crate) payloads: Vec<(String, String)>,
    /// Topics.
    pub(crate) topics: Vec<Topic>,
}

impl Model {
    /// Reads the schemas of every message.
    pub(crate) fn read() -> Self {
        let mut enums = BTreeMap::new();
        let structs = layouts::structs().iter().map(|it| fixed(it, &mut enums)).collect();
        let mut layouts = layouts::payloads();
        layouts.extend(layouts::payloads_of_perception());
        let mut formats = BTreeMap::new();
        for field in layouts.iter().flat_map(|layout| &layout.fields) {
            let format =
                serde_json::from_str(&field.ty).unwrap_or_else(|e| panic!("{e}: {field:?}"));
            formats.insert(field.name.to_string(), format);
        }
        let mut types = Vec::new();
        for name in formats.keys() {
            place(name, &formats, &mut types);
        }
        types.retain(|(name, format)| !is_plain_enum(name, format, &mut enums));
        let topics = topics::ALL.iter().chain(&topics::robot::ALL).copied().collect();
        let payloads = layouts.into_iter().map(|it| (it.name.to_owned(), it.key)).collect();
        Self { enums, structs, types, payloads, topics }
    }
}

fn fixed(layout: &Layout, enums: &mut BTreeMap<String, Vec<(String, u32)>>) -> Struct {
    let mut fields = Vec::new();
    for field in &layout.fields {
        let ty = Type::parse(&field.ty);
        if let Type::Code(name) = &ty {
            let code = |it: &str| {
                let (code, variant) = it.split_once('=').unwrap();
                (variant.to_owned(), code.parse().unwrap())
            };
            enums.insert(name.clone(), field.detail.split_whitespace().map(code).collect());
        }
        fields.push((field.name.to_string(), field.offset, ty));
    }
    Struct {
        name: layout.name.to_owned(),
        rust: layout.rust.to_owned(),
        size: layout.size,
        key: layout.key.clone(),
        fields,
    }
}

/// Adds a type after those that it contains.
fn place(
    name: &str,
    formats: &BTreeMap<String, ContainerFormat>,
    placed: &mut Vec<(String, ContainerFormat)>,
) {
    if placed.iter().any(|(done, _)| done == name) {
        return;
    }
    let format = &formats[name];
    let mut inner = Vec::new();
    format
        .visit(&mut |part| {
            if let Format::TypeName(name) = part {
                inner.push(name.clone());
            }
            Ok(())
        })
        .unwrap();
    inner.iter().for_each(|name| place(name, formats, placed));
    placed.push((name.to_owned(), format.clone()));
}

/// Whether no variant of an enum has data; then it joins the other enums, whose codes it must share.
fn is_plain_enum(
    name: &str,
    format: &ContainerFormat,
    enums: &mut BTreeMap<String, Vec<(String, u32)>>,
) -> bool {
    let ContainerFormat::Enum(variants) = format else { return false };
    if !variants.values().all(|it| it.value == VariantFormat::Unit) {
        return false;
    }
    let codes: Vec<_> = variants.iter().map(|(code, it)| (it.name.clone(), *code)).collect();
    if let Some(known) = enums.get(name) {
        let upper = |codes: &[(String, u32)]| -> Vec<(String, u32)> {
            codes.iter().map(|(name, code)| (upper(name), *code)).collect()
        };
        assert_eq!(upper(known), upper(&codes), "{name} has other codes in payloads");
        return true;
    }
    enums.insert(name.to_owned(), codes);
    true
}

/// `PutBack` and `put_back` as constants: `PUT_BACK`.
pub(crate) fn upper(name: &str) -> String {
    snake(name).to_ascii_uppercase()
}

/// `PutBack` as a variable: `put_back`.
pub(crate) fn snake(name: &str) -> String {
    let mut text = String::new();
    for (i, letter) in name.char_indices() {
        if i > 0 && letter.is_ascii_uppercase() && !text.ends_with('_') {
            text.push('_');
        }
        text.push(letter.to_ascii_lowercase());
    }
    text
}

/// `put_back` as a type: `PutBack`.
pub(crate) fn camel(name: &str) -> String {
    let mut text = String::new();
    for part in name.split('_') {
        let mut letters = part.chars();
        text.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        text.push_str(letters.as_str());
    }
    text
}

/// Breaks a text into lines of at most `width` characters.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
