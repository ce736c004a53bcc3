//! Reading of URDF and SRDF.

mod element;
mod joint;
mod link;
mod semantics;
mod spelling;
mod tree;

use std::collections::HashMap;

use diagnostics::{Diagnostics, TextFile};
use roxmltree::Node;

use crate::model::Robot;

use element::{Element, Log};

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
    let xml = element::document(urdf)?;
    let log = Log::new(urdf, &xml);
    let Some(root) = log.root() else { return log.verdict(None) };
    if let Some(node) = root.node.descendants().find(is_xacro) {
        let what = "it still contains xacro macros";
        let help = "expand them first: xacro FILE.urdf.xacro > FILE.urdf";
        Element { node, ..root }.problem(what, help);
        return log.verdict(None);
    }
    spelling::check(&root);
    let name = root.name().to_owned();
    let mut materials = HashMap::new();
    for own in root.children("material") {
        link::material(own, &mut materials);
    }
    let links: Vec<_> = root.children("link").map(|own| link::read(own, &mut materials)).collect();
    let joints: Vec<_> = root.children("joint").map(joint::read).collect();
    if links.is_empty() {
        root.problem("it has no <link>", "describe its links and joints");
    }
    log.verdict(tree::build(&log, name, links, joints))
}

fn is_xacro(node: &Node<'_, '_>) -> bool {
    node.tag_name().namespace().is_some_and(|name| name.contains("xacro"))
}
