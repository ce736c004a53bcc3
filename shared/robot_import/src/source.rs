//! A published description as it is written: links, joints and pieces, with nothing decided.

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use robot_model::JointKind;

/// A tree of links, parents first.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    /// Joints in the order of the file.
    pub(crate) joints: Vec<Joint>,
}

#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// The joint that carries it; none for the root.
    pub(crate) carrier: Option<usize>,
    pub(crate) collision: Vec<Piece>,
    pub(crate) visual: Vec<Piece>,
}

/// A shape on a link.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) origin: Isometry3<f64>,
    pub(crate) form: Form,
}

#[derive(Clone, Debug)]
pub(crate) enum Form {
    /// Edges.
    Box(Vector3<f64>),
    /// Radius, and length along z without the ends of a capsule.
    Round { radius: f64, length: f64, is_capsule: bool },
    /// File, as it is written, and scale.
    Mesh(String, Vector3<f64>),
}

#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) kind: JointKind,
    pub(crate) parent: usize,
    pub(crate) child: usize,
    pub(crate) origin: Isometry3<f64>,
    pub(crate) axis: Unit<Vector3<f64>>,
    /// Least and greatest position, where stated.
    pub(crate) range: Option<(f64, f64)>,
    pub(crate) velocity: Option<f64>,
    pub(crate) effort: Option<f64>,
    pub(crate) follows: Option<Follows>,
}

/// Position = factor × position of the other joint + offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Follows {
    pub(crate) joint: usize,
    pub(crate) factor: f64,
    pub(crate) offset: f64,
}

impl Joint {
    pub(crate) fn turns(&self) -> bool {
        matches!(self.kind, JointKind::Revolute | JointKind::Continuous)
    }

    /// Range in which it is sampled: a continuous joint turns once.
    pub(crate) fn span(&self) -> (f64, f64) {
        match (self.kind, self.range) {
            (JointKind::Revolute | JointKind::Prismatic, Some(range)) => range,
            (JointKind::Prismatic | JointKind::Fixed, _) => (0.0, 0.0),
            _ => (-std::f64::consts::PI, std::f64::consts::PI),
        }
    }

    /// Zero, or the middle of its range where that excludes zero.
    pub(crate) fn zero(&self) -> f64 {
        let (low, high) = self.span();
        if (low..=high).contains(&0.0) { 0.0 } else { 0.5 * (low + high) }
    }

    fn step(&self, at: f64) -> Isometry3<f64> {
        match self.kind {
            JointKind::Fixed => self.origin,
            JointKind::Prismatic => self.origin * Translation3::from(self.axis.into_inner() * at),
            _ => self.origin * UnitQuaternion::from_axis_angle(&self.axis, at),
        }
    }
}

impl Source {
    pub(crate) fn root(&self) -> usize {
        0
    }

    pub(crate) fn link(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|link| link.name == name)
    }

    /// Joints that hang on a link.
    pub(crate) fn children(&self, link: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.joints.len()).filter(move |joint| self.joints[*joint].parent == link)
    }

    /// Joints from the root to a link, the root's first.
    pub(crate) fn way(&self, mut link: usize) -> Vec<usize> {
        let mut way = Vec::new();
        while let Some(joint) = self.links[link].carrier {
            way.push(joint);
            link = self.joints[joint].parent;
        }
        way.reverse();
        way
    }

    /// Whether `link` is `top` or hangs on it.
    pub(crate) fn is_below(&self, link: usize, top: usize) -> bool {
        link == top || self.way(link).iter().any(|joint| self.joints[*joint].parent == top)
    }

    /// Poses of all links in the root's frame; `q` has a position per joint, and followers follow.
    pub(crate) fn poses(&self, q: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses = vec![Isometry3::identity(); self.links.len()];
        for (index, link) in self.links.iter().enumerate() {
            let Some(carrier) = link.carrier else { continue };
            let joint = &self.joints[carrier];
            let at = match joint.follows {
                Some(rule) => rule.factor * q[rule.joint] + rule.offset,
                None => q[carrier],
            };
            poses[index] = poses[joint.parent] * joint.step(at);
        }
        poses
    }

    /// Every joint at zero, or in the middle of its range where that excludes zero.
    pub(crate) fn zeros(&self) -> Vec<f64> {
        self.joints.iter().map(Joint::zero).collect()
    }
}
