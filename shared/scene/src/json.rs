//! The scene as JSON, for batch tools and tests:
//! `{"objects":[{"name":ID,"attributes":{K:V,…}},…],"values":{K:[V,…],…}}`.
//!
//! Further optional keys: `name`, `noun`, `synonyms` (`{K:{V:[…],…},…}`), and an object's `xyz`,
//! `yaw`, `size`, `grasp_width`, `mass_kg`, `wall_deg` and `form` as in the scene file. Without
//! `values`, every value is listed in the order in which the objects bring it up.

use diagnostics::{Diagnostics, Fields, Node, Report, Source, Table};
use serde_json::{Map, Value as Json, json};

use crate::check::{Checks, Draft, DraftAttribute, DraftObject, DraftValue};
use crate::toml_form::object;
use crate::{Object, Scene};

impl Scene {
    /// Reads the JSON form; `file` is its name in diagnostics.
    ///
    /// # Errors
    /// Every problem at once.
    pub fn from_json(file: &str, json: &Json) -> Result<Self, Diagnostics> {
        let mut report = Report::default();
        let source = Source::new(file, 0);
        let table = match Node::from_json(json, &source) {
            Node::Table(table) => table,
            other => {
                let what = format!("expected a table, found {}", other.type_name());
                return Err(source.diagnostic(&[], what, "").into());
            }
        };
        let draft = draft(&table, &mut report);
        let scene = draft.check(&mut Checks { table: &table, report: &mut report });
        report.verdict(scene)
    }

    /// The JSON form, which [`Scene::from_json`] reads back to a scene of the same key. Wordings
    /// are omitted.
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
            json["wall_deg"] = json!(placement.wall_deg);
            json["form"] = json!(placement.form.name());
            if let Some(mass_kg) = placement.mass_kg {
                json["mass_kg"] = json!(mass_kg);
            }
        }
        json
    }
}

fn draft(table: &Table, report: &mut Report) -> Draft {
    let mut f = Fields::new(table, Vec::new(), report);
    let name = f.optional_text("name").unwrap_or_else(|| "scene".to_owned());
    let noun = f.optional_text("noun").unwrap_or_else(|| "object".to_owned());
    let objects = f.list("objects", "", object);
    let listed = f.optional_table("values", listed);
    let mut attributes = listed.unwrap_or_else(|| derived(&objects));
    f.optional_table("synonyms", |f| add_synonyms(&mut attributes, f));
    f.finish();
    Draft { name, noun, ask_wanted: Vec::new(), ask_point: Vec::new(), attributes, objects }
}

fn plain(key: String, name: String, values: Vec<DraftValue>) -> DraftAttribute {
    let (synonyms, ask_yes_no, ask_which) = (Vec::new(), Vec::new(), Vec::new());
    DraftAttribute { key, name, synonyms, role: None, ask_yes_no, ask_which, values }
}

/// The attributes of `values`.
fn listed(f: &mut Fields<'_>) -> Vec<DraftAttribute> {
    let mut attributes = Vec::new();
    for name in f.names() {
        let key = f.key_of(name);
        let values = f.texts(name).into_iter().enumerate();
        let value = |(n, text)| DraftValue::plain(format!("{key}[{n}]"), text);
        attributes.push(plain(key.clone(), name.to_owned(), values.map(value).collect()));
    }
    attributes
}

/// The attributes and values in the order in which the objects mention them.
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
                attributes.push(plain(key.clone(), name.clone(), Vec::new()));
                attributes.len() - 1
            });
            attributes[k].values.push(DraftValue::plain(key, value.clone()));
        }
    }
    attributes
}

/// Adds `synonyms` to the values that they belong to.
fn add_synonyms(attributes: &mut [DraftAttribute], f: &mut Fields<'_>) {
    for name in f.names() {
        let Some(attribute) = attributes.iter_mut().find(|attribute| attribute.name == name) else {
            f.allow(&[name]);
            f.problem(name, "unknown attribute", "use one of `values`");
            continue;
        };
        f.optional_table(name, |f| {
            for value_name in f.names() {
                let synonyms = f.texts(value_name);
                match attribute.values.iter_mut().find(|value| value.name == value_name) {
                    Some(value) => value.synonyms.extend(synonyms),
                    None => f.problem(value_name, "unknown value", "list it in `values`"),
                }
            }
        });
    }
}
