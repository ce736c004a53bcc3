//! The robot: its limbs and the body that they hang on.

mod describe;
mod fingers;
#[cfg(test)]
mod tests;

use std::sync::{Arc, LazyLock};

use robot_model::Robot as Description;

use crate::collision::{Capsule, Cuboid};
use crate::gripper::Gripper;
use crate::kinematics::chain::Chain;
use crate::kinematics::limb::{Joints, Limb};
use crate::kinematics::limits::MotionLimits;

pub use describe::Unsuitable;

/// A robot of one or two limbs with six or seven turning joints each. Copies share what it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    description: Arc<Description>,
    /// Both arms, or the only one twice.
    arms: Arc<[Arm; 2]>,
}

/// One limb: how it moves, and the room that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Which of the robot's limbs it is.
    pub limb: Limb,
    /// Its name in the description: the link at its end is `<name>_gripper`.
    pub name: String,
    /// Its joints' names in the description, shoulder first: six or seven.
    pub joint_names: Vec<String>,
    /// Its fingers.
    pub gripper: Gripper,
    /// Its kinematics.
    pub chain: Chain,
    /// Motion limits of its joints.
    pub limits: MotionLimits,
    /// Neutral posture.
    pub neutral: Joints,
    /// Postures over which it may find its way, radians: the one at rest, and others in which it is
    /// clear of itself and of the body.
    pub via_postures: Vec<Joints>,
    /// The shapes that enclose its links, shoulder first.
    pub(crate) enclosures: Vec<Enclosure>,
    /// Pairs of enclosures that must not touch.
    pub(crate) pairs: Vec<(usize, usize)>,
    /// Mount of the limb.
    pub(crate) body: Arc<Body>,
}

/// A capsule that moves with a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Enclosure {
    /// 0 shoulder to 5 or 6 wrist.
    pub(crate) joint: usize,
    /// The link that it encloses, without the limb's name.
    pub(crate) link: &'static str,
    /// In the joint's frame, see [`Chain::frames`].
    pub(crate) capsule: Capsule,
}

/// Torso, pedestal and head, in `base`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Body {
    pub(crate) cuboids: Vec<(&'static str, Cuboid)>,
    pub(crate) capsules: Vec<(&'static str, Capsule)>,
}

impl Robot {
    /// Returns the robot that whichone ships: Baxter with its electric grippers and extended
    /// fingers.
    pub fn baxter() -> &'static Self {
        static BAXTER: LazyLock<Robot> = LazyLock::new(|| {
            Robot::from_description(Description::baxter()).expect("the tests build this very robot")
        });
        &BAXTER
    }

    /// Description with every link and its shape.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Returns the limbs that it has: both, left first, or the only one.
    pub fn limbs(&self) -> &'static [Limb] {
        match self.arms[0].limb {
            Limb::Only => &[Limb::Only],
            Limb::Left | Limb::Right => &Limb::BOTH,
        }
    }

    /// Returns the limb of that name in the description, e.g. `left`.
    pub fn limb_named(&self, name: &str) -> Option<Limb> {
        self.limbs().iter().copied().find(|limb| self.arm(*limb).name == name)
    }

    /// One of its limbs. A limb that the robot does not have stands for the one that it has.
    pub fn arm(&self, limb: Limb) -> &Arm {
        &self.arms[limb]
    }

    /// Both limbs at rest; the only one twice.
    pub fn neutral(&self) -> [Joints; 2] {
        self.arms.each_ref().map(|arm| arm.neutral)
    }
}

impl Arm {
    /// Number of the wrist's last joint.
    pub(crate) fn wrist(&self) -> usize {
        self.chain.joints() - 1
    }

    /// Returns the enclosing capsules at `q`, in `base`.
    pub(crate) fn capsules(&self, q: &Joints) -> Vec<Capsule> {
        placed(&self.chain, &self.enclosures, q)
    }
}

fn placed(chain: &Chain, enclosures: &[Enclosure], q: &Joints) -> Vec<Capsule> {
    let frames = chain.frames(q);
    let place = |Enclosure { joint, capsule, .. }: &Enclosure| {
        let frame = &frames[*joint];
        Capsule { a: frame.point(&capsule.a), b: frame.point(&capsule.b), ..*capsule }
    };
    enclosures.iter().map(place).collect()
}

/// Postures for finding the capsules that always overlap.
const POSTURES: u32 = 60;

/// Returns the pairs of enclosures that must not touch: of links at least two joints apart, unless
/// the description lets them, or they overlap wherever the arm is: enclosures are wider than what
/// they enclose.
fn pairs(
    chain: &Chain,
    enclosures: &[Enclosure],
    may_touch: &[(String, String)],
) -> Vec<(usize, usize)> {
    let excused =
        |a: &str, b: &str| may_touch.iter().any(|(c, d)| (a == c && b == d) || (a == d && b == c));
    let apart = |(i, j): &(usize, usize)| {
        let (a, b) = (&enclosures[*i], &enclosures[*j]);
        b.joint >= a.joint + 2 && !excused(a.link, b.link)
    };
    let count = enclosures.len();
    let all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    let mut wanted: Vec<_> = all.filter(apart).map(|pair| (pair, true)).collect();
    for k in 0..POSTURES {
        // Strides without a common period: each joint goes through its whole range.
        let share =
            std::array::from_fn(|i| (f64::from(k) * 0.618 * (1.0 + 0.37 * i as f64)).fract());
        let capsules = placed(chain, enclosures, &chain.limits().at(&share));
        for ((i, j), always) in &mut wanted {
            *always &= capsules[*i].to_capsule(&capsules[*j]) < 0.0;
        }
    }
    wanted.into_iter().filter(|(_, always)| !always).map(|(pair, _)| pair).collect()
}
