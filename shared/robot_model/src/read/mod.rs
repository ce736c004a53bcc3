//! From the two texts to a robot.

mod joint;
mod link;
mod reader;
mod semantics;
mod spelling;
mod tree;

use std::collections::HashMap;

use roxmltree::Node;

use crate::fault::{Document, Faults};
use crate::model::Robot;

use reader::{Reader, children};

impl Robot {
    /// The robot that a URDF describes, with the named postures and permitted contacts of an SRDF.
    ///
    /// Of a URDF are read: links with inertial, visual and collision elements (box, cylinder,
    /// capsule, sphere, mesh), materials, and joints (fixed, revolute, continuous, prismatic) with
    /// origin, axis, limit (with the newer `acceleration` and `jerk`) and mimic. Of an SRDF:
    /// `group_state` and `disable_collisions`. All else is passed over.
    ///
    /// # Errors
    /// Everything that is wrong with the texts. What depends on a part that is wrong itself is
    /// left unchecked: how the links hang together on names that exist, the SRDF on a good URDF.
    pub fn parse(urdf: &str, srdf: Option<&str>) -> Result<Self, Faults> {
        let mut robot = described(urdf)?;
        if let Some(srdf) = srdf {
            semantics::read(srdf, &mut robot)?;
        }
        Ok(robot)
    }
}

fn described(urdf: &str) -> Result<Robot, Faults> {
    let xml = reader::document(urdf, Document::Urdf)?;
    let mut reader = Reader::new(Document::Urdf, &xml);
    let root = reader.root();
    if reader.count() > 0 {
        return Err(reader.into_faults());
    }
    if let Some(macro_node) = root.descendants().find(is_xacro) {
        let problem = "it still contains xacro macros";
        let cure = "expand them first: xacro FILE.urdf.xacro > FILE.urdf";
        reader.fault(macro_node, "robot", problem, cure);
        return Err(reader.into_faults());
    }
    spelling::check(&mut reader, root);
    let name = reader.name(root, "robot").to_owned();
    let mut materials = HashMap::new();
    for node in children(root, "material") {
        link::material(&mut reader, node, &mut materials);
    }
    let links: Vec<_> = children(root, "link")
        .map(|node| (link::read(&mut reader, node, &mut materials), node))
        .collect();
    let joints: Vec<_> =
        children(root, "joint").map(|node| (joint::read(&mut reader, node), node)).collect();
    if links.is_empty() {
        reader.fault(root, "robot", "it has no <link>", "describe its links and joints");
    }
    match tree::build(&mut reader, name, links, joints) {
        Some(robot) if reader.count() == 0 => Ok(robot),
        _ => Err(reader.into_faults()),
    }
}

fn is_xacro(node: &Node<'_, '_>) -> bool {
    node.tag_name().namespace().is_some_and(|name| name.contains("xacro"))
}
