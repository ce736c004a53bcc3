//! The joints of a description under the names by which their values are measured: for recordings and ROS 2, which show
//! a robot to other programs.
//!
//! This crate is pure: no IO, no clock, no threads.

use robot_model::{Jaw, JointKind, Robot};

/// Order of a limb's joints from the shoulder on, by the ends of their names.
const LIMB_JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];
/// Limbs by the beginnings of those names. The limb of a one-armed robot has the place of the first one.
const LIMBS: [&str; 2] = ["left", "right"];
/// End of the name of the link at a limb's end.
const GRIPPER: &str = "_gripper";

/// The joints of a description, and where their values are among those measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredJoints {
    /// Name of each measured entry; none where the robot has no such joint.
    names: Vec<Option<String>>,
    fingers: Vec<Finger>,
}

/// A joint of a gripper: one that slides, or a jaw that turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Finger {
    /// Its limb: 0 left or only, 1 right.
    pub limb: usize,
    /// Name of the joint.
    pub name: String,
    /// Position, or opening of a jaw, of the closed and of the open gripper, metres.
    closed_m: f64,
    open_m: f64,
    jaw: Option<Jaw>,
}

impl Finger {
    /// Returns the joint's position, metres or radians, at an opening of the gripper in percent of its range.
    pub fn position(&self, percent: f64) -> f64 {
        let open = percent.clamp(0.0, 100.0) / 100.0;
        let at_m = self.closed_m + (self.open_m - self.closed_m) * open;
        self.jaw.map_or(at_m, |jaw| jaw.angle_rad(at_m))
    }
}

impl MeasuredJoints {
    /// Finds the joints of `entries` on a robot with one limb or two: those of a limb by limb and order
    /// (`left_s0` is the first movable joint of the left limb), others by their own name. The limb of a
    /// one-armed robot has the place of the left one.
    pub fn new(robot: &Robot, entries: &[&str]) -> Self {
        let grippers = grippers(robot);
        let limbs = grippers.each_ref().map(|link| joints(robot, link.as_deref()));
        let name = |entry: &&str| match place(entry) {
            Some((limb, joint)) => limbs[limb].get(joint).cloned(),
            None => {
                let moves = robot.joint(entry).is_some_and(|it| it.kind != JointKind::Fixed);
                moves.then(|| (*entry).to_owned())
            }
        };
        let fingers = grippers.iter().enumerate();
        let fingers = fingers.flat_map(|(limb, link)| fingers_of(robot, limb, link.as_deref()));
        Self { names: entries.iter().map(name).collect(), fingers: fingers.collect() }
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

/// Returns the links at the ends of the limbs: of both, or of the only one.
fn grippers(robot: &Robot) -> [Option<String>; 2] {
    let all: Vec<_> = robot.limb_ends().collect();
    match all.as_slice() {
        [only] => [Some(format!("{only}{GRIPPER}")), None],
        _ => LIMBS.map(|limb| Some(format!("{limb}{GRIPPER}"))),
    }
}

/// Returns the place of a limb's joint: the limb, and the joint from the shoulder on.
fn place(entry: &str) -> Option<(usize, usize)> {
    let (limb, joint) = entry.split_once('_')?;
    let limb = LIMBS.iter().position(|known| *known == limb)?;
    Some((limb, LIMB_JOINTS.iter().position(|known| *known == joint)?))
}

/// Returns the names of the joints that move a link, the first of the robot's first.
fn joints(robot: &Robot, link: Option<&str>) -> Vec<String> {
    let chain = link.and_then(|link| robot.chain(link).ok());
    chain.iter().flat_map(|it| it.movable()).map(|joint| joint.name.clone()).collect()
}

/// Returns the sliding joints that the gripper of a limb carries, or its jaw. Those that mimic another follow it by
/// their description.
fn fingers_of(robot: &Robot, limb: usize, link: Option<&str>) -> Vec<Finger> {
    let Some(chain) = link.and_then(|link| robot.chain(link).ok()) else { return Vec::new() };
    if let Some(jaw) = link.and_then(|link| robot.jaw(link.strip_suffix(GRIPPER)?)) {
        let name = robot.joints()[jaw.link - 1].name.clone();
        let (closed_m, open_m) = jaw.ends_m();
        return vec![Finger { limb, name, closed_m: closed_m.max(0.0), open_m, jaw: Some(jaw) }];
    }
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
        found.push(Finger { limb, name: joint.name.clone(), closed_m, open_m, jaw: None });
    }
    found
}
