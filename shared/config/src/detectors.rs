//! Objects from detectors of ROS: the topics of both ROS, and what identifiers stand for.

use ::scene::Scene;
use diagnostics::{Fields, Report, Table, suggestion};
use perception::Label;
use serde_json::json;

use crate::files::one_of;

/// Detectors of ROS 1. A topic that is absent is not subscribed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ros1Objects {
    /// Topic of `vision_msgs/Detection3DArray`.
    pub detections: Option<String>,
    /// Topic of `apriltag_ros/AprilTagDetectionArray`.
    pub apriltags: Option<String>,
    /// Topic of `ar_track_alvar_msgs/AlvarMarkers`.
    pub ar_markers: Option<String>,
    /// Identifiers, all of them numbers.
    pub labels: Labels,
}

/// Detectors of ROS 2. A topic that is absent is not subscribed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ros2Objects {
    /// Topic of `vision_msgs/Detection3DArray`.
    pub detections: Option<String>,
    /// Topic of `ar_track_alvar_msgs/AlvarMarkers`.
    pub ar_markers: Option<String>,
    /// Topic of `tf2_msgs/TFMessage` with a frame for each marker, as apriltag_ros publishes them.
    pub tf: Option<String>,
    /// Identifiers.
    pub labels: Labels,
}

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

pub(crate) fn ros1(f: &mut Fields<'_>) -> Ros1Objects {
    let objects = Ros1Objects {
        detections: topic(f, "detections"),
        apriltags: topic(f, "apriltags"),
        ar_markers: topic(f, "ar_markers"),
        labels: labels(f),
    };
    for (key, labels) in objects.labels.lists() {
        let is_number = |id: &str| {
            id.is_empty() || id.parse::<i64>().is_ok_and(|number| number.to_string() == id)
        };
        for (n, label) in labels.iter().enumerate().filter(|(_, label)| !is_number(&label.id)) {
            let what = format!("`{}` is not a number", label.id);
            f.problem(&format!("{key}[{n}]"), what, "ROS 1 has numbers, e.g. id = \"3\"");
        }
    }
    objects
}

pub(crate) fn ros2(f: &mut Fields<'_>) -> Ros2Objects {
    Ros2Objects {
        detections: topic(f, "detections"),
        ar_markers: topic(f, "ar_markers"),
        tf: topic(f, "tf"),
        labels: labels(f),
    }
}

/// Reads the name of a topic that may be absent.
fn topic(f: &mut Fields<'_>, key: &'static str) -> Option<String> {
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

/// Returns whether a text is a name of ROS without slashes. Two underscores side by side are reserved.
pub(crate) fn is_name(text: &str) -> bool {
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let is_plain = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    begins && is_plain && !text.contains("__") && text.len() <= 64
}

fn labels(f: &mut Fields<'_>) -> Labels {
    Labels { classes: list(f, "classes"), markers: list(f, "markers") }
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
    /// Both lists with their keys.
    fn lists(&self) -> [(&'static str, &[Label]); 2] {
        [("classes", &self.classes), ("markers", &self.markers)]
    }
}

/// Checks of the sections against the others.
pub(crate) struct Check<'a> {
    pub(crate) scene: &'a Scene,
    /// Whether the objects come from perception.
    pub(crate) perceives: bool,
    pub(crate) tree: &'a Table,
    pub(crate) report: &'a mut Report,
}

impl Check<'_> {
    pub(crate) fn ros1(&mut self, objects: &Ros1Objects) {
        let Ros1Objects { detections, apriltags, ar_markers, labels } = objects;
        let topics =
            [("detections", detections), ("apriltags", apriltags), ("ar_markers", ar_markers)];
        self.section(&["arm", "ros1", "objects"], topics, labels);
    }

    pub(crate) fn ros2(&mut self, objects: &Ros2Objects) {
        let Ros2Objects { detections, ar_markers, tf, labels } = objects;
        let topics = [("detections", detections), ("ar_markers", ar_markers), ("tf", tf)];
        self.section(&["ros2", "objects"], topics, labels);
    }

    fn section(&mut self, path: &[&str], topics: [(&str, &Option<String>); 3], labels: &Labels) {
        let is_unused = !self.perceives;
        for (key, _) in topics.iter().filter(|(_, topic)| is_unused && topic.is_some()) {
            let what = "a topic of objects, but the objects are those of the scene file";
            let help = "set group.perception.enabled = true, or remove the topic";
            self.problem(&[path, &[key]].concat(), None, what, help);
        }
        for (key, labels) in labels.lists() {
            for (n, label) in labels.iter().enumerate() {
                self.object(&[path, &[key]].concat(), n, &label.object);
            }
        }
    }

    /// Reports an object that the scene does not have.
    fn object(&mut self, path: &[&str], n: usize, object: &str) {
        let scene = self.scene;
        if object.is_empty() || scene.object_named(object).is_some() {
            return;
        }
        let known = scene.objects().iter().map(|object| object.name.as_str());
        let what = format!("no object `{object}` in the scene");
        let help = suggestion(object, known.clone(), || one_of(known));
        self.problem(path, Some(n), &what, &help);
    }

    /// Reports a problem at a key, or in an item of the list there.
    fn problem(&mut self, path: &[&str], item: Option<usize>, what: &str, help: &str) {
        let mut keys: Vec<String> = path.iter().map(|key| (*key).to_owned()).collect();
        if let (Some(n), Some(list)) = (item, keys.last_mut()) {
            list.push_str(&format!("[{n}]"));
            keys.push("object".to_owned());
        }
        self.report.add(self.tree.source_of(path).diagnostic(&keys, what, help));
    }
}
