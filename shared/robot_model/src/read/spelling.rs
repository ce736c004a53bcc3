//! "Did you mean …?"

use roxmltree::Node;

use super::reader::Reader;

/// What an element may have: its name, its attributes, its children.
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

/// Notes every element and attribute that is a slip of the fingers away from one that is read:
/// passed over in silence, it would leave a robot that is not the one that was meant. Others belong
/// to other programs.
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
                let problem = format!("<{kind}> has {name}");
                reader.fault(node, &element, problem, format!("did you mean {meant}?"));
            }
        }
        for child in node.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            if let Some(meant) = misspelt(name, children) {
                let problem = format!("<{kind}> has <{name}>");
                reader.fault(child, &element, problem, format!("did you mean <{meant}>?"));
            } else if children.contains(&name) {
                let named = child.attribute("name").filter(|_| kind == "robot");
                let own = named.map(|own| format!("{name} {own:?}"));
                waiting.push((child, own.unwrap_or_else(|| element.clone())));
            }
        }
    }
}

fn misspelt(name: &str, known: &[&'static str]) -> Option<&'static str> {
    if known.contains(&name) { None } else { nearest(name, known.iter().copied()) }
}

/// The cure for a name that is not among `known`: the one that was meant, or else what is said.
pub(super) fn cure<'a>(
    wrong: &str,
    known: impl Iterator<Item = &'a str>,
    otherwise: impl Into<String>,
) -> String {
    match nearest(wrong, known) {
        Some(near) => format!("did you mean {near:?}?"),
        None => otherwise.into(),
    }
}

/// The known name that `wrong` is a slip of the fingers away from.
fn nearest<'a>(wrong: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (wrong.chars().count() / 3).min(3);
    let distance = |name: &str| strsim::osa_distance(&wrong.to_lowercase(), &name.to_lowercase());
    known
        .map(|name| (distance(name), name))
        .min()
        .filter(|(distance, _)| *distance <= allowed)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognised_and_strangers_are_not() {
        let known = ["left_hand", "left_wrist", "base"];
        assert_eq!(nearest("lefthand", known.into_iter()), Some("left_hand"));
        assert_eq!(nearest("Base", known.into_iter()), Some("base"));
        assert_eq!(nearest("right_hand", known.into_iter()), None);
        assert_eq!(nearest("", known.into_iter()), None);
        assert_eq!(cure("x", [].into_iter(), "describe it"), "describe it");
    }
}
