//! Publication of the robot's reports, at the rates and in the order of the real one.

use crate::robot::Robot;
use manipulation::Limb;
use manipulation::pose_array::to_array;
use messages::FixedText;
use messages::robot::{
    EndEffectorProperties, EndpointState, JointState, Measurement, Report, UiType,
};
use messages::{JOINT_STATE_NAMES, WireError};
use nalgebra::SVector;
use service::Time;

/// Beats between two states of a gripper, and between two of its properties.
const GRIPPER_BEATS: u64 = 2;
const PROPERTIES_BEATS: u64 = 100;
/// Deviation of measured velocities over that of positions, 1/s: they come from differences.
const VELOCITY_NOISE: f64 = 25.0;

/// Everything that is due in beat number `beat`.
pub(crate) fn all(robot: &mut Robot, beat: u64, now: Time) -> Vec<Report<'static>> {
    let mut reports = vec![Report::Assembly(robot.assembly.state())];
    let lost = robot.random.uniform() < robot.config.simulated.loss || now < robot.silent_until;
    let joints = joint_states(robot, now);
    if !lost {
        reports.extend(joints.into_iter().flatten().map(|state| Report::Joints(state.into())));
    }
    for limb in robot.config.robot.limbs().iter().copied() {
        reports.push(Report::Endpoint(limb.index(), endpoint(robot, limb, now).into()));
        if beat.is_multiple_of(GRIPPER_BEATS) {
            let enabled = robot.assembly.is_enabled();
            let state = robot.fingers[limb].state(now.ns(), enabled, &robot.gripper(limb));
            reports.push(Report::Gripper(limb.index(), state.into()));
        }
        if beat.is_multiple_of(PROPERTIES_BEATS) {
            reports.push(Report::Properties(limb.index(), properties(limb).into()));
        }
    }
    reports
}

/// Returns the joints in alphabetical order, 17 of a Baxter, and the joint of one finger of each of its
/// grippers in a message of its own.
fn joint_states(robot: &mut Robot, now: Time) -> Vec<Result<JointState, WireError>> {
    let noise_rad = robot.config.simulated.noise_rad;
    let mut measured: Vec<(String, Measurement)> = Vec::new();
    for limb in robot.config.robot.limbs().iter().copied() {
        let names = robot.config.robot.arm(limb).joint_names.clone();
        for (j, name) in names.into_iter().enumerate() {
            let servo = &robot.servos[limb];
            let (q, qd) = (servo.q[j], servo.qd[j]);
            let q = q + noise_rad * robot.random.normal();
            let qd = qd + VELOCITY_NOISE * noise_rad * robot.random.normal();
            measured.push((name, [q, qd, 0.0]));
        }
    }
    // Head and torso of a Baxter stand still.
    let has = |name: &str| robot.config.robot.description().joint(name).is_some();
    for name in JOINT_STATE_NAMES.into_iter().filter(|name| has(name)) {
        if measured.iter().all(|(own, _)| own != name) {
            measured.push((name.to_owned(), [0.0; 3]));
        }
    }
    measured.sort_by(|a, b| a.0.cmp(&b.0));
    let body: Vec<(&str, Measurement)> =
        measured.iter().map(|(name, measured)| (name.as_str(), *measured)).collect();
    let body = JointState::new(now.ns(), &body);
    let fingers =
        [("l", Limb::Left), ("r", Limb::Right)].into_iter().filter_map(|(letter, limb)| {
            let name = format!("{letter}_gripper_l_finger_joint");
            let travel_m = robot.gripper(limb).travel_m(robot.fingers[limb].width_m);
            has(&name).then(|| JointState::new(now.ns(), &[(&name, [travel_m, 0.0, 0.0])]))
        });
    std::iter::once(body).chain(fingers).collect()
}

/// Pose and velocity of the gripper's tip; the model feels no forces.
fn endpoint(robot: &Robot, limb: Limb, now: Time) -> EndpointState {
    let servo = &robot.servos[limb];
    let (frame, jacobian) = robot.config.robot.arm(limb).chain.tool_and_jacobian(&servo.q);
    let twist = jacobian * SVector::<f64, 7>::from(servo.qd);
    EndpointState {
        stamp_ns: now.ns(),
        pose: to_array(&frame.isometry()),
        twist: twist.into(),
        ..EndpointState::default()
    }
}

fn properties(limb: Limb) -> EndEffectorProperties {
    EndEffectorProperties {
        id: 65_664,
        ui_type: UiType::Electric.code(),
        has_calibration: 1,
        controls_grip: 1,
        senses_grip: 1,
        controls_force: 1,
        senses_force: 1,
        controls_position: 1,
        senses_position: 1,
        manufacturer: FixedText::truncated("whichone"),
        product: FixedText::truncated("simulated electric gripper"),
        serial_number: FixedText::truncated(limb.name()),
        ..EndEffectorProperties::default()
    }
}
