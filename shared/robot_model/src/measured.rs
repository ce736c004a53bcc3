//! The joints of a description under the names by which their values are measured.

use crate::{JointKind, Robot};

/// Order of a limb's joints from the shoulder on, by the ends of their names.
const LIMB_JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];
const LIMBS: [&str; 2] = ["left", "right"];

/// The joints of a description, and where their values are among those measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredJoints {
    /// Name of each measured entry; none where the robot has no such joint.
    names: Vec<Option<String>>,
    fingers: Vec<Finger>,
}

/// A sliding joint of a gripper.
#[derive(Clone, Debug, PartialEq)]
pub struct Finger {
    /// Its limb: 0 left, 1 right.
    pub limb: usize,
    /// Name of the joint.
    pub name: String,
    /// Position of the closed and of the open gripper, metres.
    closed_m: f64,
    open_m: f64,
}

impl Finger {
    /// Returns the joint's position, metres, at an opening of the gripper in percent of its range.
    pub fn position_m(&self, percent: f64) -> f64 {
        let open = percent.clamp(0.0, 100.0) / 100.0;
        self.closed_m + (self.open_m - self.closed_m) * open
    }
}

impl MeasuredJoints {
    /// Finds the joints of `entries`: by their own name, else by limb and order (`left_s0` is the first
    /// movable joint of the left limb).
    pub fn new(robot: &Robot, entries: &[&str]) -> Self {
        let limbs = LIMBS.map(|limb| {
            let chain = robot.chain(&format!("{limb}_gripper")).ok();
            chain.map(|chain| chain.movable().map(|joint| joint.name.clone()).collect::<Vec<_>>())
        });
        let name = |entry: &&str| {
            let of_chain = || {
                let (limb, joint) = entry.split_once('_')?;
                let limb = LIMBS.iter().position(|known| *known == limb)?;
                let at = LIMB_JOINTS.iter().position(|known| *known == joint)?;
                limbs[limb].as_ref()?.get(at).cloned()
            };
            let movable =
                |name: &&str| robot.joint(name).is_some_and(|joint| joint.kind != JointKind::Fixed);
            Some(*entry).filter(movable).map(str::to_owned).or_else(of_chain)
        };
        let fingers = (0..LIMBS.len()).flat_map(|limb| fingers(robot, limb)).collect();
        Self { names: entries.iter().map(name).collect(), fingers }
    }

    /// The joint of each entry; none where the robot has no such joint.
    pub fn names(&self) -> &[Option<String>] {
        &self.names
    }

    /// The fingers of all grippers.
    pub fn fingers(&self) -> &[Finger] {
        &self.fingers
    }
}

/// The sliding joints that a limb's gripper carries. Those that mimic another follow it by their
/// description.
fn fingers(robot: &Robot, limb: usize) -> Vec<Finger> {
    let Ok(chain) = robot.chain(&format!("{}_gripper", LIMBS[limb])) else { return Vec::new() };
    // From the last joint of the arm on: where the gripper's link is beside its fingers, too.
    let Some(hand) = chain.movable().next_back().map(|joint| joint.child) else {
        return Vec::new();
    };
    let is_carried = |mut link: usize| loop {
        if link == hand {
            return true;
        }
        match robot.carrier(link) {
            Some(joint) => link = joint.parent,
            None => return false,
        }
    };
    let mut found = Vec::new();
    for joint in robot.joints() {
        let Some(limits) = joint.limits.filter(|limits| limits.lower < limits.upper) else {
            continue;
        };
        let slides = joint.kind == JointKind::Prismatic && joint.mimic.is_none();
        if !slides || !is_carried(joint.parent) {
            continue;
        }
        let (low, high) = (limits.lower, limits.upper);
        let (closed_m, open_m) = if low.abs() <= high.abs() { (low, high) } else { (high, low) };
        found.push(Finger { limb, name: joint.name.clone(), closed_m, open_m });
    }
    found
}
