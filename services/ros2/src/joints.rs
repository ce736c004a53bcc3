//! Joint states under the names of the robot's description, the fingers included.

use crate::types::{Header, JointState, Time};
use messages::{JOINT_STATE_LEN, JOINT_STATE_NAMES, JointStates};
use robot_model::{JointKind, Robot};

/// Order of a limb's joints from the shoulder on, by the ends of their names in [`JOINT_STATE_NAMES`].
const LIMB_JOINTS: [&str; 7] = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];
const LIMBS: [&str; 2] = ["left", "right"];

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
    /// Finds them.
    pub fn new(robot: &Robot) -> Self {
        let limbs = LIMBS.map(|limb| {
            let chain = robot.chain(&format!("{limb}_gripper")).ok();
            chain.map(|chain| chain.movable().map(|joint| joint.name.clone()).collect::<Vec<_>>())
        });
        let name = |entry: &str| {
            let of_chain = || {
                let (limb, joint) = entry.split_once('_')?;
                let limb = LIMBS.iter().position(|known| *known == limb)?;
                let at = LIMB_JOINTS.iter().position(|known| *known == joint)?;
                limbs[limb].as_ref()?.get(at).cloned()
            };
            let movable =
                |name: &&str| robot.joint(name).is_some_and(|joint| joint.kind != JointKind::Fixed);
            Some(entry).filter(movable).map(str::to_owned).or_else(of_chain)
        };
        let fingers = (0..LIMBS.len()).flat_map(|limb| fingers(robot, limb)).collect();
        Self { names: JOINT_STATE_NAMES.map(name), fingers }
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_moving_joint_of_the_description_has_a_state() {
        let robot = Robot::baxter();
        let mut states = JointStates { gripper_percent: [0.0, 100.0], ..JointStates::default() };
        states.position = std::array::from_fn(|entry| entry as f64);
        let state = JointNames::new(robot).convert(&states, Time { sec: 7, nanosec: 8 });
        assert_eq!(state.header.stamp, Time { sec: 7, nanosec: 8 });
        for joint in robot.joints() {
            let moves = joint.kind != JointKind::Fixed && joint.mimic.is_none();
            let count = state.name.iter().filter(|name| **name == joint.name).count();
            let is_known = JOINT_STATE_NAMES.contains(&joint.name.as_str());
            assert!(count == usize::from(moves) || (is_known && count == 1), "{}", joint.name);
        }
        let lengths = [state.position.len(), state.velocity.len(), state.effort.len()];
        assert_eq!(lengths, [state.name.len(); 3]);
        let position =
            |name: &str| state.position[state.name.iter().position(|known| known == name).unwrap()];
        let entry = JOINT_STATE_NAMES.iter().position(|name| *name == "right_w1").unwrap();
        assert_eq!(position("right_w1"), entry as f64);
        let fingers: Vec<_> = state.name.iter().filter(|name| name.contains("finger")).collect();
        assert!(fingers.len() >= 2, "{:?}", state.name);
    }
}
