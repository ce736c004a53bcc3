//! Joint states under the names of the robot's description, the fingers included.

use crate::types::{Header, JointState, Time};
use messages::{JOINT_STATE_NAMES, JointStates};
use robot_model::{MeasuredJoints, Robot};

/// The joints of a description, and where their values are in the group's message.
#[derive(Clone, Debug, PartialEq)]
pub struct JointNames(MeasuredJoints);

impl JointNames {
    /// Finds them.
    pub fn new(robot: &Robot) -> Self {
        Self(MeasuredJoints::new(robot, &JOINT_STATE_NAMES))
    }

    /// Converts joint states that were measured at `stamp`. Velocity and effort of the fingers are not
    /// measured and given as 0.
    pub fn convert(&self, states: &JointStates, stamp: Time) -> JointState {
        let mut converted = JointState {
            header: Header { stamp, frame_id: String::new() },
            ..JointState::default()
        };
        let JointState { name, position, velocity, effort, .. } = &mut converted;
        for (entry, own) in self.0.names().iter().enumerate() {
            let Some(own) = own else { continue };
            name.push(own.clone());
            position.push(states.position[entry]);
            velocity.push(states.velocity[entry]);
            effort.push(states.effort[entry]);
        }
        for finger in self.0.fingers() {
            name.push(finger.name.clone());
            position.push(finger.position_m(states.gripper_percent[finger.limb]));
            velocity.push(0.0);
            effort.push(0.0);
        }
        converted
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use robot_model::JointKind;

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
