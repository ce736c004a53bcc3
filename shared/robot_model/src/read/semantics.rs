//! The SRDF: named postures, and links that may touch.

use std::collections::HashMap;

use roxmltree::Node;

use crate::fault::{Document, Faults};
use crate::model::{Posture, Robot};

use super::reader::{self, Reader, children};
use super::spelling;

/// Adds what the text says to the robot.
pub(super) fn read(srdf: &str, robot: &mut Robot) -> Result<(), Faults> {
    let xml = reader::document(srdf, Document::Srdf)?;
    let mut reader = Reader::new(Document::Srdf, &xml);
    let root = reader.root();
    if reader.count() > 0 {
        return Err(reader.into_faults());
    }
    let name = reader.name(root, "robot");
    if !name.is_empty() && name != robot.name {
        let problem = format!("it is about {name:?}, the URDF about {:?}", robot.name);
        reader.fault(root, "robot", problem, "use the files of one robot");
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
            let problem = format!("group {:?} has it twice", one.group);
            reader.fault(node, &element, problem, "rename one of them");
        }
    }
    let may_touch = children(root, "disable_collisions")
        .filter_map(|node| pair(&mut reader, node, robot))
        .collect();
    if reader.count() > 0 {
        return Err(reader.into_faults());
    }
    robot.postures = postures;
    robot.may_touch = may_touch;
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
            let problem = format!("the robot has no joint {joint:?}");
            let known = robot.joints.iter().map(|known| known.name.as_str());
            let cure = spelling::cure(joint, known, "correct the name, or remove it");
            reader.fault(entry, &element, problem, cure);
            continue;
        };
        if positions.iter().any(|(other, _)| *other == index) {
            let problem = format!("it sets joint {joint:?} twice");
            reader.fault(entry, &element, problem, "remove one of them");
        }
        if let Some(limits) = robot.joints[index].limits
            && !(limits.lower..=limits.upper).contains(&position)
        {
            let problem = format!("joint {joint:?} is at {position}, outside its limits");
            let cure = format!("write a value from {} to {}", limits.lower, limits.upper);
            reader.fault(entry, &element, problem, cure);
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
            let problem = format!("the robot has no link {name:?}");
            let known = robot.links.iter().map(|known| known.name.as_str());
            let cure = spelling::cure(name, known, "correct the name, or remove the pair");
            reader.fault(node, element, problem, cure);
        }
        index
    });
    let [Some(a), Some(b)] = ends else { return None };
    Some((a.min(b), a.max(b)))
}
