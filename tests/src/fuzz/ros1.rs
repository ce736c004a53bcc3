//! Messages, headers and calls of ROS 1, which any program on the robot's network may send.

use ros::wire::Field;
use ros::wire::{Message, RosTime};
use ros1::connection::read_header;
use ros1::convert;
use ros1::types::{EndEffectorState, Header, JointState};
use ros1::xmlrpc::{answer, method_call};
use service::Time;

pub(super) fn run(input: &[u8]) {
    if let Ok(state) = JointState::from_bytes(input) {
        assert_eq!(state.to_frame()[4..], *input);
        if let Ok(own) = convert::joint_state(&state, Time(7)) {
            assert_eq!(own.len as usize, state.name.len());
        }
    }
    if let Ok(state) = EndEffectorState::from_bytes(input) {
        assert_eq!(state.to_frame()[4..], *input);
        convert::gripper_state(&state, Time(7));
    }
    let _ = read_header(&mut &*input);
    if let Ok(text) = std::str::from_utf8(input) {
        method_call(text);
        answer(text);
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let header = Header { seq: 1, stamp: RosTime { secs: 2, nsecs: 3 }, frame_id: "base".into() };
    let (name, position) = (vec!["left_s0".into(), "left_s1".into()], vec![0.5, -1.0]);
    let joints = JointState { header, name, position, ..JointState::default() };
    let gripper = EndEffectorState { command: "go".into(), ..EndEffectorState::default() };
    let mut bytes = [Vec::new(), Vec::new()];
    joints.write(&mut bytes[0]);
    gripper.write(&mut bytes[1]);
    let mut fields = Vec::new();
    let pairs = [("topic", "/robot/state"), ("md5sum", "*"), ("type", "*")];
    ros1::connection::write_header(&mut fields, &pairs).expect("a vector takes everything");
    let call = "<methodCall><methodName>publisherUpdate</methodName><params><param><value>/master</value>\
                </param><param><value><array><data><value><int>1</int></value></data></array></value></param>\
                </params></methodCall>";
    let found = "<methodResponse><params><param><value><array><data><value><int>1</int></value></data>\
                 </array></value></param></params></methodResponse>";
    let [joints, gripper] = bytes;
    // Elements within elements, as deep as a message is long.
    let deep = "<a>".repeat(200_000);
    vec![joints, gripper, fields, call.into(), found.into(), deep.into()]
}
