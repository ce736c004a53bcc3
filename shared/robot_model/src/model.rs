//! Parts of a robot.

use nalgebra::{Isometry3, Matrix3, Unit, Vector3};

/// A tree of links joined by joints.
///
/// Links are ordered parents first; link 0 is the root, and joint `i` carries link `i + 1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) postures: Vec<Posture>,
    pub(crate) may_touch: Vec<(usize, usize)>,
}

/// A rigid body with its own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Unique among the links.
    pub name: String,
    /// Mass and inertia, where the description states them.
    pub inertial: Option<Inertial>,
    /// Collision shapes, in the order of the file.
    pub collision: Vec<Body>,
    /// Visual shapes, in the order of the file.
    pub visual: Vec<Body>,
}

/// The mass of a link and how it is spread.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertial {
    /// The centre of mass, and the axes of `inertia`, in the link's frame.
    pub origin: Isometry3<f64>,
    /// Kilograms.
    pub mass: f64,
    /// Moments about the centre of mass, kg·m².
    pub inertia: Matrix3<f64>,
}

/// A shape fixed to a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The shape's frame in the link's.
    pub origin: Isometry3<f64>,
    /// The shape.
    pub shape: Shape,
    /// The colour of a visual body, where the description gives one.
    pub colour: Option<Rgba>,
}

/// Red, green, blue and opacity, each 0 to 1.
pub type Rgba = [f64; 4];

/// A shape about the origin of its own frame. Lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box with these edges along x, y and z.
    Box {
        /// Edges.
        size: Vector3<f64>,
    },
    /// A cylinder about z.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length along z.
        length: f64,
    },
    /// A cylinder about z with a half ball on either end.
    Capsule {
        /// Radius.
        radius: f64,
        /// Distance between the centres of the two half balls.
        length: f64,
    },
    /// A ball.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A mesh file, kept as a name: nothing in this crate opens it.
    Mesh {
        /// As the description writes it, e.g. `package://…`.
        file: String,
    },
}

/// A joint between a link and its parent. Positions are radians, for a prismatic joint metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Unique among the joints.
    pub name: String,
    /// Its degree of freedom.
    pub kind: JointKind,
    /// Index of the parent in [`Robot::links`].
    pub parent: usize,
    /// Index of the child in [`Robot::links`].
    pub child: usize,
    /// The child's frame in the parent's at position 0.
    pub origin: Isometry3<f64>,
    /// The axis in the child's frame; x for a fixed joint.
    pub axis: Unit<Vector3<f64>>,
    /// Always there for revolute and prismatic joints, never for fixed ones.
    pub limits: Option<Limits>,
    /// The joint that this one mimics, if any.
    pub mimic: Option<Mimic>,
}

/// The kinds of joints that are understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Does not move.
    Fixed,
    /// Turns about its axis between two limits.
    Revolute,
    /// Turns about its axis without end.
    Continuous,
    /// Slides along its axis between two limits.
    Prismatic,
}

/// Limits of a joint, with x for rad, or for m if it is prismatic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least position, x; −∞ for a continuous joint.
    pub lower: f64,
    /// Greatest position, x; +∞ for a continuous joint.
    pub upper: f64,
    /// Greatest speed, x/s.
    pub velocity: f64,
    /// Greatest torque in Nm, or force in N.
    pub effort: f64,
    /// Greatest acceleration, x/s², where stated.
    pub acceleration: Option<f64>,
    /// Greatest jerk, x/s³, where stated.
    pub jerk: Option<f64>,
}

/// Position = `multiplier` × the other joint's position + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// Index of the followed joint in [`Robot::joints`]. It mimics no other: chained rules
    /// of the file are combined here.
    pub joint: usize,
    /// Factor.
    pub multiplier: f64,
    /// Radians or metres.
    pub offset: f64,
}

/// A named posture of a group of joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Posture {
    /// E.g. `neutral`.
    pub name: String,
    /// E.g. `left_arm`.
    pub group: String,
    /// Index in [`Robot::joints`] and position, in the order of the file.
    pub positions: Vec<(usize, f64)>,
}

impl JointKind {
    /// The word for it in a description.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Revolute => "revolute",
            Self::Continuous => "continuous",
            Self::Prismatic => "prismatic",
        }
    }
}

impl Robot {
    /// The robot's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Every link, parents first.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// Every joint; joint `i` carries link `i + 1`.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The link without a parent joint.
    pub fn root(&self) -> &Link {
        &self.links[0]
    }

    /// The link of that name.
    pub fn link(&self, name: &str) -> Option<&Link> {
        self.link_index(name).map(|index| &self.links[index])
    }

    /// The place of the link of that name in [`Robot::links`] and in [`Robot::poses`].
    pub fn link_index(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|link| link.name == name)
    }

    /// The joint of that name.
    pub fn joint(&self, name: &str) -> Option<&Joint> {
        self.joints.iter().find(|joint| joint.name == name)
    }

    /// The parent joint of a link; none for the root.
    ///
    /// # Panics
    /// If there is no such link.
    pub fn carrier(&self, link: usize) -> Option<&Joint> {
        assert!(link < self.links.len(), "the robot has {} links", self.links.len());
        link.checked_sub(1).map(|joint| &self.joints[joint])
    }

    /// Every named posture, in the order of the file.
    pub fn postures(&self) -> &[Posture] {
        &self.postures
    }

    /// The posture `name` of the group `group`.
    pub fn posture(&self, group: &str, name: &str) -> Option<&Posture> {
        self.postures.iter().find(|posture| posture.group == group && posture.name == name)
    }

    /// The pairs of links that may touch, each with its smaller index
    /// first, in the order of the file.
    pub fn may_touch(&self) -> &[(usize, usize)] {
        &self.may_touch
    }
}

impl Posture {
    /// The position of a joint (by its index), if the posture sets it.
    pub fn position(&self, joint: usize) -> Option<f64> {
        self.positions.iter().find(|(index, _)| *index == joint).map(|(_, position)| *position)
    }
}
