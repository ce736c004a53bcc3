//! The SRDF: named postures, and links that may touch.

use std::collections::HashMap;

use diagnostics::{Diagnostics, TextFile, suggestion};

use crate::model::{Posture, Robot};

use super::element::{self, Element, Log};

/// Adds what the text says to the robot.
pub(super) fn read(srdf: &TextFile, robot: &mut Robot) -> Result<(), Diagnostics> {
    let xml = element::document(srdf)?;
    let log = Log::new(srdf, &xml);
    let Some(root) = log.root() else { return log.verdict(None) };
    let name = root.name();
    if !name.is_empty() && name != robot.name {
        let what = format!("it describes {name:?}, the URDF describes {:?}", robot.name);
        root.problem(what, "use the files of one robot");
    }
    let names = robot.joints.iter().enumerate().map(|(i, joint)| (joint.name.as_str(), i));
    let indices: HashMap<&str, usize> = names.collect();
    let mut postures: Vec<Posture> = Vec::new();
    let mut twice = Vec::new();
    for group_state in root.children("group_state") {
        let (posture, element) = posture(group_state, robot, &indices);
        if postures.iter().any(|own| (&own.name, &own.group) == (&posture.name, &posture.group)) {
            twice.push((format!("group {:?} has it twice", posture.group), element));
        }
        postures.push(posture);
    }
    twice.into_iter().for_each(|(what, element)| element.problem(what, "rename one of them"));
    let pairs = root.children("disable_collisions");
    let may_touch = pairs.filter_map(|own| pair(&own.labelled("disable_collisions"), robot));
    (robot.postures, robot.may_touch) = log.verdict(Some((postures, may_touch.collect())))?;
    Ok(())
}

fn posture<'a>(
    group_state: Element<'a>,
    robot: &Robot,
    indices: &HashMap<&str, usize>,
) -> (Posture, Element<'a>) {
    let (name, element) = group_state.named();
    let group = element.text("group");
    let mut positions: Vec<(usize, f64)> = Vec::new();
    for entry in element.children("joint") {
        let joint = entry.name();
        let position = entry.number("value");
        if joint.is_empty() {
            continue;
        }
        let Some(&index) = indices.get(joint) else {
            let known = robot.joints.iter().map(|known| known.name.as_str());
            let help = suggestion(joint, known, || "correct the name, or remove it".to_owned());
            entry.problem(format!("the robot has no joint {joint:?}"), help);
            continue;
        };
        if positions.iter().any(|(other, _)| *other == index) {
            entry.problem(format!("it sets joint {joint:?} twice"), "remove one of them");
        }
        if let Some(limits) = robot.joints[index].limits
            && !(limits.lower..=limits.upper).contains(&position)
        {
            let what = format!("joint {joint:?} is at {position}, outside its limits");
            entry.problem(what, format!("write a value from {} to {}", limits.lower, limits.upper));
        }
        positions.push((index, position));
    }
    (Posture { name: name.to_owned(), group: group.to_owned(), positions }, element)
}

fn pair(own: &Element<'_>, robot: &Robot) -> Option<(usize, usize)> {
    let ends = ["link1", "link2"].map(|key| {
        let name = own.text(key);
        let index = robot.link_index(name);
        if index.is_none() && !name.is_empty() {
            let known = robot.links.iter().map(|known| known.name.as_str());
            let otherwise = "correct the name, or remove the pair";
            let help = suggestion(name, known, || otherwise.to_owned());
            own.problem(format!("the robot has no link {name:?}"), help);
        }
        index
    });
    let [Some(a), Some(b)] = ends else { return None };
    Some((a.min(b), a.max(b)))
}
