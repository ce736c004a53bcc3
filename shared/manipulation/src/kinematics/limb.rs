//! Limbs, and the names and order of their joints.

use std::fmt;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// Joint positions of one limb in radians, ordered `s0 s1 e0 e1 w0 w1 w2`. The last entry of a limb
/// with six joints is zero: a seventh joint that cannot move.
pub type Joints = [f64; 7];

/// Joint names without their limb, from the shoulder to the wrist: the order of [`Joints`] and of
/// everything in Baxter's own interface except its alphabetical joint-state message.
pub const JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];

/// One of a robot's arms: of two like Baxter's, or the only one. Pairs of what each arm has, left
/// first, are indexed by it; the only arm has the first place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Limb {
    /// The arm at +y of frame `base`.
    Left,
    /// The arm at −y of frame `base`.
    Right,
    /// The arm of a robot that has one.
    Only,
}

impl Limb {
    /// Both limbs of a robot with two, left first.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// `left`, `right` or `only`; the first two are prefixes of the limb's link and joint names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Only => "only",
        }
    }

    /// Returns the limb of that name.
    pub fn named(name: &str) -> Option<Self> {
        [Self::Left, Self::Right, Self::Only].into_iter().find(|limb| limb.name() == name)
    }

    /// Returns the other arm, if there are two.
    pub fn other(self) -> Option<Self> {
        match self {
            Self::Left => Some(Self::Right),
            Self::Right => Some(Self::Left),
            Self::Only => None,
        }
    }

    /// Place in pairs of what each arm has: 0 or 1.
    pub fn index(self) -> usize {
        match self {
            Self::Left | Self::Only => 0,
            Self::Right => 1,
        }
    }

    /// +1 for the left limb and the only one, −1 for the right: the sign of everything mirrored in the xz plane.
    pub fn side(self) -> f64 {
        match self {
            Self::Left | Self::Only => 1.0,
            Self::Right => -1.0,
        }
    }

    /// Returns Baxter's seven full joint names in the order of [`Joints`].
    pub fn joint_names(self) -> [String; 7] {
        JOINTS.map(|joint| format!("{self}_{joint}"))
    }
}

impl fmt::Display for Limb {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl<T> Index<Limb> for [T; 2] {
    type Output = T;

    fn index(&self, limb: Limb) -> &T {
        &self[limb.index()]
    }
}

impl<T> IndexMut<Limb> for [T; 2] {
    fn index_mut(&mut self, limb: Limb) -> &mut T {
        &mut self[limb.index()]
    }
}

/// Returns the Euclidean distance of two postures, radians.
pub(crate) fn distance(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_baxters() {
        assert_eq!(Limb::Right.joint_names()[6], "right_w2");
        assert_eq!(serde_json::to_string(&Limb::Right).unwrap(), "\"right\"");
        assert_eq!(serde_json::from_str::<Limb>("\"left\"").unwrap(), Limb::Left);
        for limb in Limb::BOTH {
            assert_eq!(Limb::named(limb.name()), Some(limb));
            assert_eq!(limb.other().and_then(Limb::other), Some(limb));
        }
        assert_eq!(Limb::named("Left"), None);
    }
}
