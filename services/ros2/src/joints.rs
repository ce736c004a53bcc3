//! Joint states under the names of the robot's description, the fingers included.

use crate::types::{Header, JointState, Time};
use measured_joints::MeasuredJoints;
use messages::{JOINT_STATE_NAMES, JointStates};
use robot_model::Robot;

/// The joints of a description, and where their values are in the group's message.
#[derive(Clone, Debug, PartialEq)]
pub struct JointNames(MeasuredJoints);

impl JointNames {
    /// Finds the joints of a robot with one limb or two.
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
            position.push(finger.position(states.gripper_percent[finger.limb]));
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
    use ::diagnostics::TextFile;
    use robot_model::JointKind;

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
        for (joint, own) in arm.iter().zip(["s0", "s1", "e0", "e1", "w0", "w1"]) {
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
