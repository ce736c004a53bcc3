//! Limbs, and the names and order of their joints.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Joint positions of one limb in radians, ordered `s0 s1 e0 e1 w0 w1 w2`.
pub type Joints = [f64; 7];

/// Joint names without their limb, from the shoulder to the wrist: the order of [`Joints`] and of
/// everything in Baxter's own interface except its alphabetical joint-state message.
pub const JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];

/// One of Baxter's two arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Limb {
    /// The arm at +y of frame `base`.
    Left,
    /// The arm at −y of frame `base`.
    Right,
}

impl Limb {
    /// Both limbs, left first.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// `left` or `right`: the prefix of the limb's link and joint names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Returns the limb of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::BOTH.into_iter().find(|limb| limb.name() == name)
    }

    /// Returns the other arm.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// +1 for the left limb, −1 for the right: the sign of everything mirrored in the xz plane.
    pub fn side(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// Returns the joint's full name, e.g. `left_s0`.
    ///
    /// # Panics
    /// If `i` is above 6.
    pub fn joint_name(self, i: usize) -> String {
        format!("{self}_{}", JOINTS[i])
    }

    /// Returns the seven full joint names in the order of [`Joints`].
    pub fn joint_names(self) -> [String; 7] {
        JOINTS.map(|joint| format!("{self}_{joint}"))
    }

    /// Returns the posture reflected in the xz plane: what the other limb does when this one does
    /// `q`.
    pub fn mirror(q: &Joints) -> Joints {
        [-q[0], q[1], -q[2], q[3], -q[4], q[5], -q[6]]
    }
}

impl fmt::Display for Limb {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Joint positions of both arms, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arms {
    /// The left arm's.
    pub left: Joints,
    /// The right arm's.
    pub right: Joints,
}

impl Arms {
    /// One arm's joint positions.
    pub fn of(&self, limb: Limb) -> &Joints {
        match limb {
            Limb::Left => &self.left,
            Limb::Right => &self.right,
        }
    }

    /// One arm's joint positions, to be changed.
    pub fn of_mut(&mut self, limb: Limb) -> &mut Joints {
        match limb {
            Limb::Left => &mut self.left,
            Limb::Right => &mut self.right,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_baxters() {
        assert_eq!(Limb::Left.joint_name(0), "left_s0");
        assert_eq!(Limb::Right.joint_names()[6], "right_w2");
        assert_eq!(serde_json::to_string(&Limb::Right).unwrap(), "\"right\"");
        assert_eq!(serde_json::from_str::<Limb>("\"left\"").unwrap(), Limb::Left);
        for limb in Limb::BOTH {
            assert_eq!(Limb::named(limb.name()), Some(limb));
            assert_eq!(limb.other().other(), limb);
        }
        assert_eq!(Limb::named("Left"), None);
    }

    #[test]
    fn mirroring_twice_changes_nothing() {
        let q = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6, -0.7];
        assert_eq!(Limb::mirror(&Limb::mirror(&q)), q);
        assert_ne!(Limb::mirror(&q), q);
    }
}
