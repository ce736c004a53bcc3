//! Joint states under the names of the robot's description, the fingers included.

use crate::types::{Header, JointState, Time};
use messages::{JOINT_STATE_LEN, JOINT_STATE_NAMES, JointStates};
use robot_model::{JointKind, Robot};

/// Order of a limb's joints from the shoulder on, by the ends of their names in [`JOINT_STATE_NAMES`].
const LIMB_JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];
/// Limbs by the beginnings of those names. The limb of a one-armed robot has the place of the first one.
const LIMBS: [&str; 2] = ["left", "right"];
/// End of the name of the link at a limb's end.
const GRIPPER: &str = "_gripper";

/// The joints of a description, and where their values are in the group's message.
#[derive(Clone, Debug, PartialEq)]
pub struct JointNames {
    /// Name of each entry of the message; none where the robot has no such joint.
    names: [Option<String>; JOINT_STATE_LEN],
    fingers: Vec<Finger>,
}

/// A sliding joint of a gripper.
#[derive(Clone, Debug, PartialEq)]
struct Finger {
    limb: usize,
    name: String,
    /// Position of the closed and of the open gripper, metres.
    closed_m: f64,
    open_m: f64,
}

impl JointNames {
    /// Finds the joints of a robot with one limb or two.
    pub fn new(robot: &Robot) -> Self {
        let grippers = grippers(robot);
        let limbs = grippers.each_ref().map(|link| joints(robot, link.as_deref()));
        let name = |entry: &str| match place(entry) {
            Some((limb, joint)) => limbs[limb].get(joint).cloned(),
            None => {
                let moves = robot.joint(entry).is_some_and(|it| it.kind != JointKind::Fixed);
                moves.then(|| entry.to_owned())
            }
        };
        let fingers = grippers.iter().enumerate();
        let fingers = fingers.flat_map(|(limb, link)| fingers_of(robot, limb, link.as_deref()));
        Self { names: JOINT_STATE_NAMES.map(name), fingers: fingers.collect() }
    }

    /// Converts joint states that were measured at `stamp`. Velocity and effort of the fingers are not
    /// measured and given as 0.
    pub fn convert(&self, states: &JointStates, stamp: Time) -> JointState {
        let mut converted = JointState {
            header: Header { stamp, frame_id: String::new() },
            ..JointState::default()
        };
        let JointState { name, position, velocity, effort, .. } = &mut converted;
        for (entry, own) in self.names.iter().enumerate() {
            let Some(own) = own else { continue };
            name.push(own.clone());
            position.push(states.position[entry]);
            velocity.push(states.velocity[entry]);
            effort.push(states.effort[entry]);
        }
        for finger in &self.fingers {
            let open = states.gripper_percent[finger.limb].clamp(0.0, 100.0) / 100.0;
            name.push(finger.name.clone());
            position.push(finger.closed_m + (finger.open_m - finger.closed_m) * open);
            velocity.push(0.0);
            effort.push(0.0);
        }
        converted
    }
}

/// Returns the links at the ends of the limbs: of both, or of the only one.
fn grippers(robot: &Robot) -> [Option<String>; 2] {
    let all: Vec<_> = robot.links().iter().filter(|link| link.name.ends_with(GRIPPER)).collect();
    match all.as_slice() {
        [only] => [Some(only.name.clone()), None],
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

/// Returns the sliding joints that the gripper of a limb carries. Those that mimic another follow it by
/// their description.
fn fingers_of(robot: &Robot, limb: usize, link: Option<&str>) -> Vec<Finger> {
    let Some(chain) = link.and_then(|link| robot.chain(link).ok()) else { return Vec::new() };
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use ::diagnostics::TextFile;

    /// Joint states in which each entry of the message is its number.
    fn numbered(robot: &Robot) -> JointState {
        let mut states = JointStates { gripper_percent: [0.0, 100.0], ..JointStates::default() };
        states.position = std::array::from_fn(|entry| entry as f64);
        JointNames::new(robot).convert(&states, Time { sec: 7, nanosec: 8 })
    }

    /// Every joint that moves by itself has one state, and no other.
    fn assert_complete(robot: &Robot, state: &JointState) {
        for joint in robot.joints() {
            let moves = joint.kind != JointKind::Fixed && joint.mimic.is_none();
            let count = state.name.iter().filter(|name| **name == joint.name).count();
            assert_eq!(count, usize::from(moves), "{}: {:?}", joint.name, state.name);
        }
        let lengths = [state.position.len(), state.velocity.len(), state.effort.len()];
        assert_eq!(lengths, [state.name.len(); 3]);
    }

    fn position(state: &JointState, name: &str) -> f64 {
        state.position[state.name.iter().position(|known| known == name).unwrap()]
    }

    #[test]
    fn every_moving_joint_of_both_limbs_has_a_state() {
        let robot = Robot::baxter();
        let state = numbered(robot);
        assert_eq!(state.header.stamp, Time { sec: 7, nanosec: 8 });
        assert_complete(robot, &state);
        let entry = JOINT_STATE_NAMES.iter().position(|name| *name == "right_w1").unwrap();
        assert_eq!(position(&state, "right_w1"), entry as f64);
        let fingers: Vec<_> = state.name.iter().filter(|name| name.contains("finger")).collect();
        assert!(fingers.len() >= 2, "{:?}", state.name);
    }

    #[test]
    fn joints_of_a_single_arm_have_the_names_of_its_description() {
        let urdf = include_str!("../../../config/robots/ur5e.urdf");
        let robot = Robot::read(&TextFile::new("ur5e.urdf", urdf), None).unwrap();
        let state = numbered(&robot);
        assert_complete(&robot, &state);
        let arm = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];
        for (joint, own) in arm.iter().zip(LIMB_JOINTS) {
            let entry = JOINT_STATE_NAMES.iter().position(|name| *name == format!("left_{own}"));
            assert_eq!(
                position(&state, &format!("{joint}_joint")),
                entry.unwrap() as f64,
                "{joint}"
            );
        }
    }

    #[test]
    fn single_arm_may_be_named_like_one_of_two() {
        let urdf = include_str!("../../../config/robots/ur5e.urdf");
        let urdf = urdf.replace("arm_gripper", "right_gripper").replace("elbow_joint", "right_e0");
        let robot = Robot::read(&TextFile::new("right.urdf", urdf), None).unwrap();
        let state = numbered(&robot);
        assert_complete(&robot, &state);
        let entry = JOINT_STATE_NAMES.iter().position(|name| *name == "left_e0").unwrap();
        assert_eq!(position(&state, "right_e0"), entry as f64);
    }
}
