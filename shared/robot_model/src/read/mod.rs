//! Reading of URDF and SRDF.

mod joint;
mod link;
mod reader;
mod semantics;
mod spelling;
mod tree;

use std::collections::HashMap;

use diagnostics::{Diagnostics, TextFile};
use roxmltree::Node;

use crate::model::Robot;

use reader::{Reader, children};

impl Robot {
    /// Reads texts that have no files: [`Robot::read`] with the names `URDF` and `SRDF`.
    ///
    /// # Errors
    /// Every problem of the texts.
    pub fn parse(urdf: &str, srdf: Option<&str>) -> Result<Self, Diagnostics> {
        let srdf = srdf.map(|text| TextFile::new("SRDF", text));
        Self::read(&TextFile::new("URDF", urdf), srdf.as_ref())
    }

    /// The robot that a URDF describes, with the named postures and permitted contacts of an SRDF.
    ///
    /// Of a URDF are read: links with inertial, visual and collision elements (box, cylinder,
    /// capsule, sphere, mesh), materials, and joints (fixed, revolute, continuous, prismatic) with
    /// origin, axis, limit (with the newer `acceleration` and `jerk`) and mimic. Of an SRDF:
    /// `group_state` and `disable_collisions`. Everything else is ignored.
    ///
    /// # Errors
    /// Every problem of the texts, except those that depend on a part with a problem itself: the
    /// tree of links is checked once all names exist, the SRDF once the URDF is valid.
    pub fn read(urdf: &TextFile, srdf: Option<&TextFile>) -> Result<Self, Diagnostics> {
        let mut robot = described(urdf)?;
        if let Some(srdf) = srdf {
            semantics::read(srdf, &mut robot)?;
        }
        Ok(robot)
    }
}

fn described(urdf: &TextFile) -> Result<Robot, Diagnostics> {
    let xml = reader::document(urdf)?;
    let mut reader = Reader::new(urdf, &xml);
    let root = reader.root();
    if reader.count() > 0 {
        return reader.verdict(None);
    }
    if let Some(macro_node) = root.descendants().find(is_xacro) {
        let what = "it still contains xacro macros";
        let help = "expand them first: xacro FILE.urdf.xacro > FILE.urdf";
        reader.problem(macro_node, "robot", what, help);
        return reader.verdict(None);
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
        reader.problem(root, "robot", "it has no <link>", "describe its links and joints");
    }
    let robot = tree::build(&mut reader, name, links, joints);
    reader.verdict(robot)
}

fn is_xacro(node: &Node<'_, '_>) -> bool {
    node.tag_name().namespace().is_some_and(|name| name.contains("xacro"))
}
