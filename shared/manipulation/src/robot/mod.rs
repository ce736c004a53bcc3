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

/// A robot of one or two limbs with five to seven turning joints each. Copies share what it holds.
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
    /// Its joints' names in the description, shoulder first: five to seven.
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
    /// Enclosures that must not touch the body.
    pub(crate) loose: Loose,
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

/// For each shape of the body, the enclosures of an arm that must not touch it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Loose {
    pub(crate) cuboids: Vec<Vec<usize>>,
    pub(crate) capsules: Vec<Vec<usize>>,
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

    /// Returns the limbs that are asked for: all of them, or one, see [`Robot::arm`].
    pub(crate) fn limbs_of(&self, asked: Option<Limb>) -> Vec<Limb> {
        asked.map_or_else(|| self.limbs().to_vec(), |limb| vec![self.arm(limb).limb])
    }

    /// Both limbs at rest; the only one twice.
    pub fn neutral(&self) -> [Joints; 2] {
        self.arms.each_ref().map(|arm| arm.neutral)
    }
}

impl Robot {
    /// What is taken for granted where the description says nothing.
    pub fn assumptions(&self) -> Vec<String> {
        let mut all = Vec::new();
        for arm in self.limbs().iter().map(|limb| self.arm(*limb)) {
            let name = &arm.name;
            if arm.enclosures.is_empty() {
                all.push(format!(
                    "limb {name} has no collision shapes: its plans keep it off nothing but by chance"
                ));
            }
            if arm.gripper.jaw.is_none() && fingers::of(&self.description, name).is_none() {
                let (open_mm, force_n) = (arm.gripper.open_m * 1e3, arm.gripper.force_n);
                all.push(format!(
                    "limb {name} has no two fingers on prismatic joints: they are taken to open {open_mm:.1} mm and to \
                     press with {force_n:.0} N"
                ));
            }
        }
        all
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

/// Postures for finding the shapes that always overlap.
const POSTURES: u32 = 60;

/// Shapes of one limb, for deciding which of them must not touch what.
pub(crate) struct Touch<'a> {
    enclosures: &'a [Enclosure],
    /// Pairs of links that may touch, without the limb's name.
    may_touch: Vec<(String, String)>,
    /// The enclosures in postures that together use the whole range of every joint.
    placed: Vec<Vec<Capsule>>,
}

impl<'a> Touch<'a> {
    pub(crate) fn new(
        chain: &Chain,
        enclosures: &'a [Enclosure],
        may_touch: Vec<(String, String)>,
    ) -> Self {
        let at = |k: u32| {
            // Strides without a common period: each joint goes through its whole range.
            let share =
                std::array::from_fn(|i| (f64::from(k) * 0.618 * (1.0 + 0.37 * i as f64)).fract());
            placed(chain, enclosures, &chain.limits().at(&share))
        };
        Self { enclosures, may_touch, placed: (0..POSTURES).map(at).collect() }
    }

    fn is_excused(&self, a: &str, b: &str) -> bool {
        self.may_touch.iter().any(|(c, d)| (a == c && b == d) || (a == d && b == c))
    }

    /// Returns whether shapes overlap wherever the arm is: they are wider than what they enclose.
    fn always(&self, overlap: impl Fn(&[Capsule]) -> bool) -> bool {
        self.placed.iter().all(|capsules| overlap(capsules))
    }

    /// Returns the pairs of enclosures that must not touch: of links at least two joints apart, unless
    /// the description lets them, or they always overlap.
    pub(crate) fn pairs(&self) -> Vec<(usize, usize)> {
        let count = self.enclosures.len();
        let all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let apart = |(i, j): &(usize, usize)| {
            let (a, b) = (&self.enclosures[*i], &self.enclosures[*j]);
            b.joint >= a.joint + 2
                && !self.is_excused(a.link, b.link)
                && !self.always(|capsules| capsules[*i].to_capsule(&capsules[*j]) < 0.0)
        };
        all.filter(apart).collect()
    }

    /// Returns the enclosures that must not touch the body's shapes: of links behind the second joint,
    /// and those between it and the first, again unless the description lets them or they always overlap.
    pub(crate) fn loose(&self, body: &Body) -> Loose {
        let from = |name: &str, overlap: &dyn Fn(&Capsule) -> bool| -> Vec<usize> {
            let is_loose = |i: &usize| {
                let Enclosure { joint, link, .. } = self.enclosures[*i];
                let free = || {
                    !self.is_excused(link, name) && !self.always(|capsules| overlap(&capsules[*i]))
                };
                joint >= 2 || joint == 1 && free()
            };
            (0..self.enclosures.len()).filter(is_loose).collect()
        };
        let cuboids = body.cuboids.iter();
        let capsules = body.capsules.iter();
        Loose {
            cuboids: cuboids.map(|(n, c)| from(n, &|own| own.to_cuboid(c) < 0.0)).collect(),
            capsules: capsules.map(|(n, c)| from(n, &|own| own.to_capsule(c) < 0.0)).collect(),
        }
    }
}
