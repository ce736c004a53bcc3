//! Misspelt elements and attributes.

use roxmltree::Node;

use super::reader::Reader;

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
pub(super) fn check<'a>(reader: &mut Reader<'a>, root: Node<'a, 'a>) {
    let mut waiting = vec![(root, "robot".to_owned())];
    while let Some((node, element)) = waiting.pop() {
        let kind = node.tag_name().name();
        let Some((_, attributes, children)) = KNOWN.iter().find(|(name, ..)| *name == kind) else {
            continue;
        };
        for attribute in node.attributes().filter(|attribute| attribute.namespace().is_none()) {
            let name = attribute.name();
            if let Some(meant) = misspelt(name, attributes) {
                let what = format!("<{kind}> has {name}");
                reader.problem(node, &element, what, format!("did you mean {meant}?"));
            }
        }
        for child in node.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            if let Some(meant) = misspelt(name, children) {
                let what = format!("<{kind}> has <{name}>");
                reader.problem(child, &element, what, format!("did you mean <{meant}>?"));
            } else if children.contains(&name) {
                let named = child.attribute("name").filter(|_| kind == "robot");
                let own = named.map(|own| format!("{name} {own:?}"));
                waiting.push((child, own.unwrap_or_else(|| element.clone())));
            }
        }
    }
}

fn misspelt(name: &str, known: &[&'static str]) -> Option<&'static str> {
    if known.contains(&name) { None } else { diagnostics::nearest(name, known.iter().copied()) }
}
