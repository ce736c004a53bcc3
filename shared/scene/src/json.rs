//! The scene as JSON, for batch tools and tests:
//! `{"objects":[{"name":ID,"attributes":{K:V,…}},…],"values":{K:[V,…],…}}`.
//!
//! Optional beside these: `name`, `noun`, `synonyms` (`{K:{V:[…],…},…}`), and an object's
//! `xyz`, `yaw`, `size` and `grasp_width` as in the scene file. Without `values`, every value is
//! listed in the order in which the objects bring it up.

use serde_json::{Map, Value as Json, json};

use crate::check::{Draft, DraftAttribute, DraftObject, DraftValue};
use crate::fields::{Fields, Node, text};
use crate::problem::Report;
use crate::toml_form::{object_attributes, placement};
use crate::{Object, Problem, Scene};

impl Scene {
    /// Reads the JSON form; `file` only names it in problems.
    ///
    /// # Errors
    /// Every problem at once.
    pub fn from_json(file: &str, json: &Json) -> Result<Self, Vec<Problem>> {
        let mut report = Report::new(file);
        let draft = draft(json.into(), &mut report);
        let scene = draft.and_then(|draft| draft.check(&mut report));
        report.verdict(scene)
    }

    /// The JSON form, which [`Scene::from_json`] reads back to a scene of the same key. Wording is
    /// left out.
    pub fn to_json(&self) -> Json {
        let mut values = Map::new();
        let mut synonyms = Map::new();
        for attribute in self.attributes() {
            let names: Vec<&str> = attribute.values.iter().map(|value| &*value.name).collect();
            let known: Map<String, Json> = (attribute.values.iter())
                .filter(|value| !value.synonyms.is_empty())
                .map(|value| (value.name.clone(), json!(value.synonyms)))
                .collect();
            values.insert(attribute.name.clone(), json!(names));
            if !known.is_empty() {
                synonyms.insert(attribute.name.clone(), Json::Object(known));
            }
        }
        let objects: Vec<Json> = self.objects().iter().map(|o| self.object_to_json(o)).collect();
        let mut scene = json!({
            "name": self.name(), "noun": self.noun(), "objects": objects, "values": values,
        });
        if !synonyms.is_empty() {
            scene["synonyms"] = Json::Object(synonyms);
        }
        scene
    }

    fn object_to_json(&self, object: &Object) -> Json {
        let attributes: Map<String, Json> = (self.attributes().iter().zip(&object.values))
            .filter_map(|(attribute, value)| {
                let value = &attribute.values[(*value)?.index()];
                Some((attribute.name.clone(), json!(value.name)))
            })
            .collect();
        let mut json = json!({ "name": object.name, "attributes": attributes });
        if let Some(placement) = &object.placement {
            json["xyz"] = json!(placement.xyz);
            json["yaw"] = json!(placement.yaw);
            json["size"] = json!(placement.size);
            json["grasp_width"] = json!(placement.grasp_width);
        }
        json
    }
}

fn draft(root: Node, report: &mut Report) -> Option<Draft> {
    let mut fields = Fields::open(String::new(), root, report)?;
    let name = fields.optional_text("name", report);
    let noun = fields.optional_text("noun", report);
    let objects = fields.list("objects", report);
    let values = fields.take("values");
    let synonyms = fields.take("synonyms");
    fields.finish(report);
    let objects: Vec<DraftObject> = (objects.into_iter().enumerate())
        .filter_map(|(n, node)| object(format!("objects[{n}]"), node, report))
        .collect();
    let mut attributes = match values {
        Some(node) => listed(node, report),
        None => derived(&objects),
    };
    if let Some(node) = synonyms {
        add_synonyms(&mut attributes, node, report);
    }
    Some(Draft {
        name: name.unwrap_or_else(|| "scene".to_owned()),
        noun: noun.unwrap_or_else(|| "object".to_owned()),
        ask_wanted: Vec::new(),
        ask_point: Vec::new(),
        attributes,
        objects,
    })
}

fn object(key: String, node: Node, report: &mut Report) -> Option<DraftObject> {
    let mut fields = Fields::open(key.clone(), node, report)?;
    let name = fields.text("name", report).unwrap_or_default();
    let attributes = object_attributes(&mut fields, report);
    let placement = placement(&mut fields, report);
    fields.finish(report);
    Some(DraftObject { key, name, attributes, placement })
}

fn attribute(key: String, name: String, values: Vec<DraftValue>) -> DraftAttribute {
    let (synonyms, ask_yes_no, ask_which) = (Vec::new(), Vec::new(), Vec::new());
    DraftAttribute { key, name, synonyms, ask_yes_no, ask_which, values }
}

/// The attributes as `values` lists them.
fn listed(node: Node, report: &mut Report) -> Vec<DraftAttribute> {
    let Some(table) = Fields::open("values".to_owned(), node, report) else { return Vec::new() };
    (table.into_entries().into_iter())
        .map(|(key, name, node)| {
            let values = texts(&key, node, report);
            let values = values.into_iter().map(|(key, name)| DraftValue::plain(key, name));
            attribute(key, name, values.collect())
        })
        .collect()
}

/// The attributes that the objects bring up.
fn derived(objects: &[DraftObject]) -> Vec<DraftAttribute> {
    let mut attributes: Vec<DraftAttribute> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for object in objects {
        for (name, value) in &object.attributes {
            if !seen.insert((name, value)) {
                continue;
            }
            let key = format!("{}.attributes.{name}", object.key);
            let k = attributes.iter().position(|a| a.name == *name).unwrap_or_else(|| {
                attributes.push(attribute(key.clone(), name.clone(), Vec::new()));
                attributes.len() - 1
            });
            attributes[k].values.push(DraftValue::plain(key, value.clone()));
        }
    }
    attributes
}

fn add_synonyms(attributes: &mut [DraftAttribute], node: Node, report: &mut Report) {
    let Some(table) = Fields::open("synonyms".to_owned(), node, report) else { return };
    for (key, name, node) in table.into_entries() {
        let Some(attribute) = attributes.iter_mut().find(|a| a.name == name) else {
            report.add(key, format!("unknown attribute `{name}`"), "use one of `values`");
            continue;
        };
        let Some(values) = Fields::open(key, node, report) else { continue };
        for (key, name, node) in values.into_entries() {
            let synonyms = texts(&key, node, report).into_iter().map(|(_, synonym)| synonym);
            match attribute.values.iter_mut().find(|value| value.name == name) {
                Some(value) => value.synonyms.extend(synonyms),
                None => report.add(key, format!("unknown value `{name}`"), "list it in `values`"),
            }
        }
    }
}

/// The strings of a list, each with its dotted key.
fn texts(key: &str, node: Node, report: &mut Report) -> Vec<(String, String)> {
    let Node::List(items) = node else {
        report.add(key, "expected a list of strings", "write `[\"…\"]`");
        return Vec::new();
    };
    (items.into_iter().enumerate())
        .filter_map(|(n, item)| {
            let key = format!("{key}[{n}]");
            text(&key, item, report).map(|text| (key, text))
        })
        .collect()
}
