//! Objects from detectors of ROS: names of topics, and what identifiers stand for.

use config::{Check, one_of};
use diagnostics::{Fields, suggestion};
use serde_json::json;

use crate::detector::Label;
use crate::is_name;

/// What identifiers of detectors stand for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// Classes of detections.
    pub classes: Vec<Label>,
    /// Markers, by number or by the name of their frame.
    pub markers: Vec<Label>,
}

/// The pose of an object in its marker's frame, if it is not written.
const LABEL: &str = "xyz = [0.0, 0.0, 0.0]\nrpy = [0.0, 0.0, 0.0]";

/// Reads the name of a topic that may be absent.
pub fn topic(f: &mut Fields<'_>, key: &'static str) -> Option<String> {
    let name = f.optional_text(key);
    f.note(key, || json!({ "pattern": "^$|^(/[A-Za-z_][A-Za-z0-9_]*)+$" }));
    let name = name?;
    let is_topic = name.strip_prefix('/').is_some_and(|parts| parts.split('/').all(is_name));
    if !is_topic {
        let what = format!("`{name}` is not a topic of ROS");
        f.problem(key, what, "write it in full, e.g. \"/detections\": letters, digits and _");
    }
    is_topic.then_some(name)
}

fn list(f: &mut Fields<'_>, key: &'static str) -> Vec<Label> {
    let labels = f.list(key, LABEL, |f| Label {
        id: f.text("id"),
        object: f.text("object"),
        xyz: f.triple("xyz"),
        rpy: f.triple("rpy"),
    });
    for (n, label) in labels.iter().enumerate() {
        if labels[..n].iter().any(|other| other.id == label.id && !label.id.is_empty()) {
            let what = format!("`{}` is there twice", label.id);
            f.problem(&format!("{key}[{n}]"), what, "remove one of them");
        }
    }
    labels
}

impl Labels {
    /// Reads both lists.
    pub fn read(f: &mut Fields<'_>) -> Self {
        Self { classes: list(f, "classes"), markers: list(f, "markers") }
    }

    /// Both lists with their keys.
    pub fn lists(&self) -> [(&'static str, &[Label]); 2] {
        [("classes", &self.classes), ("markers", &self.markers)]
    }
}

/// Checks a section of detectors against the others: nobody looks at topics of objects that are those of the scene
/// file, and labels stand for objects of the scene.
pub fn check(
    section: &[&str],
    topics: [(&str, &Option<String>); 3],
    labels: &Labels,
    others: &mut Check<'_>,
) {
    let is_unused = !others.group.perception.enabled;
    for (key, _) in topics.iter().filter(|(_, topic)| is_unused && topic.is_some()) {
        let what = "a topic of objects, but the objects are those of the scene file";
        let help = "set group.perception.enabled = true, or remove the topic";
        others.problem(&[section, &[key]].concat(), what, help);
    }
    let Some(scene) = others.scene else { return };
    for (key, labels) in labels.lists() {
        for (n, Label { object, .. }) in labels.iter().enumerate() {
            if object.is_empty() || scene.object_named(object).is_some() {
                continue;
            }
            let known = scene.objects().iter().map(|object| object.name.as_str());
            let what = format!("no object `{object}` in the scene");
            let help = suggestion(object, known.clone(), || one_of(known));
            others.problem_in(&[section, &[key]].concat(), (n, "object"), &what, &help);
        }
    }
}
