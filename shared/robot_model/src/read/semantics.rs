//! The SRDF: named postures, and links that may touch.

use std::collections::HashMap;

use diagnostics::{Diagnostics, TextFile, suggestion};
use roxmltree::Node;

use crate::model::{Posture, Robot};

use super::reader::{self, Reader, children};

/// Adds what the text says to the robot.
pub(super) fn read(srdf: &TextFile, robot: &mut Robot) -> Result<(), Diagnostics> {
    let xml = reader::document(srdf)?;
    let mut reader = Reader::new(srdf, &xml);
    let root = reader.root();
    if reader.count() > 0 {
        return reader.verdict(None);
    }
    let name = reader.name(root, "robot");
    if !name.is_empty() && name != robot.name {
        let what = format!("it describes {name:?}, the URDF describes {:?}", robot.name);
        reader.problem(root, "robot", what, "use the files of one robot");
    }
    let indices: HashMap<&str, usize> = robot
        .joints
        .iter()
        .enumerate()
        .map(|(index, joint)| (joint.name.as_str(), index))
        .collect();
    let postures: Vec<Posture> = children(root, "group_state")
        .map(|node| posture(&mut reader, node, robot, &indices))
        .collect();
    for (i, (one, node)) in postures.iter().zip(children(root, "group_state")).enumerate() {
        if postures[..i].iter().any(|other| (&other.name, &other.group) == (&one.name, &one.group))
        {
            let element = format!("group_state {:?}", one.name);
            let what = format!("group {:?} has it twice", one.group);
            reader.problem(node, &element, what, "rename one of them");
        }
    }
    let may_touch = children(root, "disable_collisions")
        .filter_map(|node| pair(&mut reader, node, robot))
        .collect();
    (robot.postures, robot.may_touch) = reader.verdict(Some((postures, may_touch)))?;
    Ok(())
}

fn posture<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    robot: &Robot,
    indices: &HashMap<&str, usize>,
) -> Posture {
    let (name, element) = reader.named(node);
    let group = reader.text(node, &element, "group");
    let mut positions: Vec<(usize, f64)> = Vec::new();
    for entry in children(node, "joint") {
        let joint = reader.name(entry, &element);
        let position = reader.number(entry, &element, "value");
        if joint.is_empty() {
            continue;
        }
        let Some(&index) = indices.get(joint) else {
            let what = format!("the robot has no joint {joint:?}");
            let known = robot.joints.iter().map(|known| known.name.as_str());
            let help = suggestion(joint, known, || "correct the name, or remove it".to_owned());
            reader.problem(entry, &element, what, help);
            continue;
        };
        if positions.iter().any(|(other, _)| *other == index) {
            let what = format!("it sets joint {joint:?} twice");
            reader.problem(entry, &element, what, "remove one of them");
        }
        if let Some(limits) = robot.joints[index].limits
            && !(limits.lower..=limits.upper).contains(&position)
        {
            let what = format!("joint {joint:?} is at {position}, outside its limits");
            let help = format!("write a value from {} to {}", limits.lower, limits.upper);
            reader.problem(entry, &element, what, help);
        }
        positions.push((index, position));
    }
    Posture { name: name.to_owned(), group: group.to_owned(), positions }
}

fn pair<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, robot: &Robot) -> Option<(usize, usize)> {
    let element = "disable_collisions";
    let ends = ["link1", "link2"].map(|key| {
        let name = reader.text(node, element, key);
        let index = robot.link_index(name);
        if index.is_none() && !name.is_empty() {
            let what = format!("the robot has no link {name:?}");
            let known = robot.links.iter().map(|known| known.name.as_str());
            let help =
                suggestion(name, known, || "correct the name, or remove the pair".to_owned());
            reader.problem(node, element, what, help);
        }
        index
    });
    let [Some(a), Some(b)] = ends else { return None };
    Some((a.min(b), a.max(b)))
}
