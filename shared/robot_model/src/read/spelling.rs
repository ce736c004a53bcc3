//! Misspelt elements and attributes.

use super::element::Element;

/// Known attributes and children of an element.
type Known = (&'static str, &'static [&'static str], &'static [&'static str]);

const KNOWN: [Known; 20] = [
    ("robot", &["name", "version"], &["link", "joint", "material", "transmission", "gazebo"]),
    ("link", &["name", "type"], &["inertial", "visual", "collision"]),
    ("inertial", &[], &["origin", "mass", "inertia"]),
    ("mass", &["value"], &[]),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], &[]),
    ("visual", &["name"], &["origin", "geometry", "material"]),
    ("collision", &["name"], &["origin", "geometry", "material"]),
    ("origin", &["xyz", "rpy", "quat_xyzw"], &[]),
    ("geometry", &[], &["box", "cylinder", "capsule", "sphere", "mesh"]),
    ("box", &["size"], &[]),
    ("cylinder", &["radius", "length"], &[]),
    ("capsule", &["radius", "length"], &[]),
    ("sphere", &["radius"], &[]),
    ("material", &["name"], &["color", "texture"]),
    ("color", &["rgba"], &[]),
    (
        "joint",
        &["name", "type"],
        &[
            "origin",
            "parent",
            "child",
            "axis",
            "limit",
            "mimic",
            "dynamics",
            "calibration",
            "safety_controller",
        ],
    ),
    ("parent", &["link"], &[]),
    ("axis", &["xyz"], &[]),
    (
        "limit",
        &["lower", "upper", "velocity", "effort", "acceleration", "deceleration", "jerk"],
        &[],
    ),
    ("mimic", &["joint", "multiplier", "offset"], &[]),
];

/// Reports every element and attribute whose name is almost one that is read: ignored, it would
/// give another robot than the one intended. All others belong to other programs.
pub(super) fn check(root: &Element<'_>) {
    let mut waiting = vec![root.clone()];
    while let Some(element) = waiting.pop() {
        let kind = element.tag();
        let Some((_, attributes, children)) = KNOWN.iter().find(|(name, ..)| *name == kind) else {
            continue;
        };
        let own = element.node.attributes().filter(|attribute| attribute.namespace().is_none());
        for name in own.map(|attribute| attribute.name()) {
            if let Some(meant) = misspelt(name, attributes) {
                element.problem(format!("<{kind}> has {name}"), format!("did you mean {meant}?"));
            }
        }
        for child in element.all_children() {
            let name = child.tag();
            if let Some(meant) = misspelt(name, children) {
                child.problem(format!("<{kind}> has <{name}>"), format!("did you mean <{meant}>?"));
            } else if children.contains(&name) {
                waiting.push(match child.attribute("name").filter(|_| kind == "robot") {
                    Some(own) => child.labelled(format!("{name} {own:?}")),
                    None => child,
                });
            }
        }
    }
}

fn misspelt(name: &str, known: &[&'static str]) -> Option<&'static str> {
    if known.contains(&name) { None } else { diagnostics::nearest(name, known.iter().copied()) }
}
