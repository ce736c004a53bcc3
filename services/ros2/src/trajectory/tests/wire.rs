//! Messages that an rclpy client and an rclpy server have exchanged.

use ros2_client::action::{GetResultResponse, SendGoalRequest, SendGoalResponse};
use ros2_client::action_msgs::{CancelGoalResponse, GoalStatusArray};
use ros2_client::unique_identifier_msgs::UUID;
use rustdds::CDRSerializerAdapter;
use rustdds::no_key::SerializerAdapter;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::super::types::{
    GripperGoal, GripperResult, ParallelGoal, ParallelResult, TrajectoryGoal, TrajectoryResult,
};
use crate::detectors::tests::bytes::read;
use crate::types::JointState;

/// Bytes and contents of the messages of a topic.
fn captured(topic: &str) -> Vec<(String, Value)> {
    let text = include_str!("../../../../../tests/fixtures/ros2/actions.json");
    let all: Value = serde_json::from_str(text).unwrap();
    let own = all["messages"].as_array().unwrap().iter().filter(|it| it["topic"] == topic);
    own.map(|it| (it["cdr"].as_str().unwrap().to_owned(), it["decoded"].clone())).collect()
}

/// Reads the messages of a topic and compares their contents. What is written of them is read as the same: padding is not
/// zero in those of rclpy.
fn assert_read<M>(topic: &str, content: impl Fn(&M) -> Value)
where
    M: DeserializeOwned + Serialize,
{
    let messages = captured(topic);
    assert!(!messages.is_empty(), "{topic}");
    for (bytes, decoded) in messages {
        let message: M = read(&bytes);
        assert_eq!(content(&message), decoded, "{topic}");
        let written = CDRSerializerAdapter::<M>::to_bytes(&message).unwrap();
        let hex: String = written.iter().map(|byte| format!("{byte:02x}")).collect();
        let again: M = read(&format!("00010000{hex}"));
        assert_eq!(content(&again), decoded, "{topic}, written");
        // The whole message is read, but for what pads its end.
        assert!(bytes.len().abs_diff(hex.len() + 8) <= 8, "{topic}: {} {}", bytes.len(), hex.len());
    }
}

fn uuid(id: &UUID) -> Value {
    json!({ "uuid": id.uuid.as_bytes() })
}

fn plain(message: &impl Serialize) -> Value {
    serde_json::to_value(message).unwrap()
}

#[test]
fn messages_of_the_trajectory_action_are_those_of_rclpy() {
    assert_read(
        "rq/ARM/send_goalRequest",
        |it: &SendGoalRequest<TrajectoryGoal>| json!({ "goal_id": uuid(&it.goal_id), "goal": plain(&it.goal) }),
    );
    let accepted = |it: &SendGoalResponse| it.accepted;
    for (bytes, decoded) in captured("rr/ARM/send_goalReply") {
        assert_eq!(json!(accepted(&read(&bytes))), decoded["accepted"]);
    }
    assert_read(
        "rr/ARM/get_resultReply",
        |it: &GetResultResponse<TrajectoryResult>| json!({ "status": it.status as i8, "result": plain(&it.result) }),
    );
    for (bytes, decoded) in captured("rr/ARM/cancel_goalReply") {
        let reply: CancelGoalResponse = read(&bytes);
        assert_eq!(json!(reply.return_code as i8), decoded["return_code"]);
    }
    for (bytes, decoded) in captured("rt/ARM/status") {
        let array: GoalStatusArray = read(&bytes);
        let found: Vec<Value> = array
            .status_list
            .iter()
            .map(|it| json!([uuid(&it.goal_info.goal_id), it.status as i8]))
            .collect();
        let expected = decoded["status_list"].as_array().unwrap().iter();
        let expected: Vec<Value> =
            expected.map(|it| json!([it["goal_info"]["goal_id"], it["status"]])).collect();
        assert_eq!(found, expected);
    }
}

#[test]
fn messages_of_both_gripper_actions_and_joint_states_are_those_of_rclpy() {
    assert_read(
        "rq/PARALLEL/send_goalRequest",
        |it: &SendGoalRequest<ParallelGoal>| json!({ "goal_id": uuid(&it.goal_id), "goal": plain(&it.goal) }),
    );
    assert_read(
        "rr/PARALLEL/get_resultReply",
        |it: &GetResultResponse<ParallelResult>| json!({ "status": it.status as i8, "result": plain(&it.result) }),
    );
    assert_read(
        "rq/GRIPPER/send_goalRequest",
        |it: &SendGoalRequest<GripperGoal>| json!({ "goal_id": uuid(&it.goal_id), "goal": { "command": plain(&it.goal) } }),
    );
    assert_read(
        "rr/GRIPPER/get_resultReply",
        |it: &GetResultResponse<GripperResult>| json!({ "status": it.status as i8, "result": plain(&it.result) }),
    );
    assert_read("rt/joint_states", |it: &JointState| plain(it));
}
