//! The scene file that people write (`config/scenes/*.toml`).
//!
//! ```toml
//! name = "markers"
//! noun = "marker"
//! ask_wanted = "Which {noun} would you like?"   # optional, as are all wordings
//! ask_point = ["This one?", "Is it this one?"]  # several are taken in turn
//!
//! [[attributes]]
//! name = "color"
//! synonyms = ["colour"]              # other words for the attribute, optional
//! ask_yes_no = ["Is it {value}?", "Is the {noun} {value}?"]
//! ask_which = "What colour is it?"
//! values = ["red", { name = "blue", synonyms = ["navy"], spoken = "dark blue" }]
//!
//! [[objects]]
//! name = "left_one"
//! attributes = { color = "red" }     # an object may lack an attribute
//! xyz = [0.7, 0.1, -0.15]            # metres, frame `base`; a scene may do without places
//! yaw = 0.5                          # radians, optional
//! size = [0.14, 0.014, 0.014]        # metres
//! grasp_width = 0.014                # metres
//! ```
//!
//! In a wording `{value}` is the value as `spoken` has it (in yes or no questions alone),
//! `{attribute}` the attribute's name and `{noun}` the scene's noun.
//!
//! Attributes, values and objects are lists because their order counts: it breaks ties between
//! questions and names the entries of a belief.

use crate::check::{Draft, DraftAttribute, DraftObject, DraftValue};
use crate::fields::{Fields, Node, text};
use crate::problem::Report;
use crate::{Placement, Problem, Scene};

impl Scene {
    /// Reads a scene file's text; `file` only names it in problems.
    ///
    /// # Errors
    /// Every problem of the text at once. A text that is not TOML has one: the place where it
    /// stops being TOML.
    pub fn from_toml(file: &str, text: &str) -> Result<Self, Vec<Problem>> {
        let table: toml::Table = match toml::from_str(text) {
            Ok(table) => table,
            Err(error) => {
                let (line, column) = place(text, error.span().map_or(0, |span| span.start));
                let key = format!("line {line}, column {column}");
                return Err(vec![Problem::new(file, key, error.message(), "mend the TOML here")]);
            }
        };
        let mut report = Report::new(file);
        let draft = draft(toml::Value::Table(table).into(), &mut report);
        let scene = draft.and_then(|draft| draft.check(&mut report));
        report.verdict(scene)
    }
}

/// Line and column of a byte offset, both from 1, the column in characters.
fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

fn draft(root: Node, report: &mut Report) -> Option<Draft> {
    let mut fields = Fields::open(String::new(), root, report)?;
    let name = fields.text("name", report);
    let noun = fields.text("noun", report);
    let ask_wanted = fields.one_or_more_texts("ask_wanted", report);
    let ask_point = fields.one_or_more_texts("ask_point", report);
    let attributes = fields.list("attributes", report);
    let objects = fields.list("objects", report);
    fields.finish(report);
    Some(Draft {
        name: name.unwrap_or_default(),
        noun: noun.unwrap_or_default(),
        ask_wanted,
        ask_point,
        attributes: (attributes.into_iter().enumerate())
            .filter_map(|(n, node)| attribute(format!("attributes[{n}]"), node, report))
            .collect(),
        objects: (objects.into_iter().enumerate())
            .filter_map(|(n, node)| object(format!("objects[{n}]"), node, report))
            .collect(),
    })
}

fn attribute(key: String, node: Node, report: &mut Report) -> Option<DraftAttribute> {
    let mut fields = Fields::open(key.clone(), node, report)?;
    let name = fields.text("name", report);
    let synonyms = fields.texts("synonyms", report);
    let ask_yes_no = fields.one_or_more_texts("ask_yes_no", report);
    let ask_which = fields.one_or_more_texts("ask_which", report);
    let values = fields.list("values", report);
    fields.finish(report);
    let values = (values.into_iter().enumerate())
        .filter_map(|(n, node)| value(format!("{key}.values[{n}]"), node, report))
        .collect();
    let name = name.unwrap_or_default();
    Some(DraftAttribute { key, name, synonyms, ask_yes_no, ask_which, values })
}

/// A value is its name, or a table if there is more to say about it.
fn value(key: String, node: Node, report: &mut Report) -> Option<DraftValue> {
    if !matches!(node, Node::Table(_)) {
        return Some(DraftValue::plain(key.clone(), text(&key, node, report)?));
    }
    let mut fields = Fields::open(key.clone(), node, report)?;
    let name = fields.text("name", report).unwrap_or_default();
    let synonyms = fields.texts("synonyms", report);
    let spoken = fields.optional_text("spoken", report);
    fields.finish(report);
    Some(DraftValue { key, name, synonyms, spoken })
}

fn object(key: String, node: Node, report: &mut Report) -> Option<DraftObject> {
    let mut fields = Fields::open(key.clone(), node, report)?;
    let name = fields.text("name", report).unwrap_or_default();
    let attributes = object_attributes(&mut fields, report);
    let placement = placement(&mut fields, report);
    fields.finish(report);
    Some(DraftObject { key, name, attributes, placement })
}

/// The `attributes` table of an object: attribute name to value name.
pub(crate) fn object_attributes(fields: &mut Fields, report: &mut Report) -> Vec<(String, String)> {
    let Some(node) = fields.take("attributes") else { return Vec::new() };
    let Some(table) = Fields::open(fields.key_of("attributes"), node, report) else {
        return Vec::new();
    };
    (table.into_entries().into_iter())
        .filter_map(|(key, name, node)| Some((name, text(&key, node, report)?)))
        .collect()
}

/// Where an object stands: all of it or nothing.
pub(crate) fn placement(fields: &mut Fields, report: &mut Report) -> Option<Placement> {
    let keys = ["xyz", "yaw", "size", "grasp_width"];
    if !keys.into_iter().any(|key| fields.has(key)) {
        for key in keys {
            fields.take(key);
        }
        return None;
    }
    let xyz = fields.triple("xyz", report);
    let yaw = if fields.has("yaw") { fields.number("yaw", report) } else { Some(0.0) };
    let size = fields.triple("size", report);
    let grasp_width = fields.number("grasp_width", report);
    for (n, extent) in size.iter().flatten().enumerate() {
        positive(format!("{}[{n}]", fields.key_of("size")), *extent, report);
    }
    if let Some(width) = grasp_width {
        positive(fields.key_of("grasp_width"), width, report);
    }
    Some(Placement { xyz: xyz?, yaw: yaw?, size: size?, grasp_width: grasp_width? })
}

fn positive(key: String, length_m: f64, report: &mut Report) {
    if length_m <= 0.0 {
        report.add(key, format!("{length_m} is not a length"), "write metres above 0");
    }
}
