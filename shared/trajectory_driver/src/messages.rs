//! Messages between the driver and the bridge to the controllers. Joints are in the order of the robot's description,
//! shoulder first; times are of the monotonic clock.

use messages::schema::payloads;
use messages::{Service, Topic};
use serde::{Deserialize, Serialize};

payloads! {
    ArmOrder [Motion]
    ControllerReport [Condition, Ending]
}

/// Name of the bridge's service.
pub const BRIDGE: &str = "trajectory";

/// Unread orders that the bridge holds.
const BUFFER: usize = 8;

/// Arm to bridge: with each change, and at least every [`ORDER_EVERY_MS`](crate::ORDER_EVERY_MS).
pub const ORDERS: Topic = Topic {
    readers: &[Service::Other(BRIDGE)],
    buffer: BUFFER,
    recorded: 4 * BUFFER,
    history: 0,
    ..Topic::new::<ArmOrder>("arm/trajectory_orders", Some(Service::Arm))
};

/// Bridge to arm: with each joint state, and with each change.
pub const REPORTS: Topic = Topic {
    readers: &[Service::Arm],
    buffer: BUFFER,
    recorded: 4 * BUFFER,
    ..Topic::new::<ControllerReport>("trajectory/reports", Some(Service::Other(BRIDGE)))
};

/// Everything that the arm wants, whole: the newest order replaces the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ArmOrder {
    /// When it was given, ns. The bridge stops an arm whose orders have ceased.
    pub at_ns: u64,
    /// The motion of the joints.
    pub motion: Motion,
    /// The latest command to the fingers; `None` before the first one, and after a stop.
    pub fingers: Option<FingerOrder>,
}

/// A motion of the joints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// None: the arm stands.
    #[default]
    Rest,
    /// A window of a motion, in place of the window before.
    Follow(Window),
    /// Everything is stopped, whoever moves it. The number is that of the stop.
    Stop(u64),
}

/// The next part of a motion, with a ramp to rest on its path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Window {
    /// Its number, larger than those of all windows before.
    pub number: u64,
    /// When it begins, ns. Its first point is due a little later.
    pub begin_ns: u64,
    /// The points, by increasing time; at the last one the arm is at rest.
    pub points: Vec<WindowPoint>,
}

/// A point of a window.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WindowPoint {
    /// Seconds from the window's begin.
    pub t_s: f64,
    /// Joint positions, radians.
    pub q: Vec<f64>,
    /// Joint velocities, rad/s.
    pub qd: Vec<f64>,
}

/// A command to the fingers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FingerOrder {
    /// Its number, larger than those of all commands before.
    pub number: u64,
    /// Position, in the gripper controller's unit.
    pub position: f64,
    /// Whether the fingers close on an object.
    pub closes: bool,
}

/// What the bridge knows of the controllers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ControllerReport {
    /// The newest joint state.
    pub joints: Option<JointMeasurement>,
    /// Whether the controllers can be used.
    pub condition: Condition,
    /// The newest window that the controller has accepted; 0 for none.
    pub accepted: u64,
    /// The latest end of a goal that counts, with the number of its window: of the newest one, or a violated tolerance.
    pub ended: Option<(u64, Ending)>,
    /// The newest stop after which the joints were measured at rest; 0 for none.
    pub stopped: u64,
    /// The latest end of a command to the fingers.
    pub fingers: Option<FingerEnd>,
}

/// Measurements of the joints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointMeasurement {
    /// When they were made, ns.
    pub at_ns: u64,
    /// Positions, radians.
    pub q: Vec<f64>,
    /// Velocities, rad/s.
    pub qd: Vec<f64>,
    /// Torques, newton metres; 0 where they are not measured.
    pub effort: Vec<f64>,
    /// Position of the fingers, in the gripper controller's unit, if a joint of theirs is measured.
    pub fingers: Option<f64>,
}

/// Whether the controllers can be used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Condition {
    /// They have not answered yet.
    #[default]
    Unheard,
    /// They answer.
    Ready,
    /// They have answered before and do not any more; or the bridge has stopped the arm by itself, and no order without
    /// a motion has come since.
    Silent,
    /// A goal of another client is being executed.
    Foreign,
    /// The gripper's controller does not answer.
    NoGripper,
}

/// End of a goal, judged by its status before anything else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// The goal was reached.
    Succeeded,
    /// It was not accepted.
    Refused,
    /// It was cancelled.
    Cancelled,
    /// It was aborted, with this `error_code`.
    Aborted(i32),
}

/// End of a command to the fingers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FingerEnd {
    /// The command's number.
    pub number: u64,
    /// Whether it closed the fingers.
    pub closes: bool,
    /// Whether the fingers stopped at something.
    pub stalled: bool,
    /// Whether they came to the position.
    pub reached: bool,
}
