//! Messages of ROS 2, field by field in the order of their definitions: CDR has no names.

use serde::{Deserialize, Serialize};
use std::time::Duration as Elapsed;

mod detectors;

pub use detectors::*;
pub use ros::geometry::{
    BoundingBox3D, Covariance, Point, Pose, PoseWithCovariance, Quaternion, Vector3,
};

/// `builtin_interfaces/Time`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Time {
    /// Seconds since 1970.
    pub sec: i32,
    /// Further nanoseconds.
    pub nanosec: u32,
}

impl Time {
    /// A time since 1970.
    pub fn new(since_1970: Elapsed) -> Self {
        // `Time` of ROS ends in 2038.
        let sec = i32::try_from(since_1970.as_secs()).unwrap_or(i32::MAX);
        Self { sec, nanosec: since_1970.subsec_nanos() }
    }
}

/// `std_msgs/Header`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// When the data were measured.
    pub stamp: Time,
    /// Frame of the data.
    pub frame_id: String,
}

/// `std_msgs/String`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Text {
    /// The text.
    pub data: String,
}

/// `std_msgs/Empty`, and the request of `std_srvs/Trigger`: nothing has one byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Empty {
    structure_needs_at_least_one_member: u8,
}

/// Response of `std_srvs/Trigger`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Triggered {
    /// Whether it has been done.
    pub success: bool,
    /// What has been done, or why it has not.
    pub message: String,
}

/// `sensor_msgs/JointState`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// When they were measured.
    pub header: Header,
    /// Names of the joints.
    pub name: Vec<String>,
    /// Positions, radians or metres.
    pub position: Vec<f64>,
    /// Velocities, per second.
    pub velocity: Vec<f64>,
    /// Efforts, newton metres or newtons.
    pub effort: Vec<f64>,
}

/// `geometry_msgs/TransformStamped`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TransformStamped {
    /// Parent frame, and when it was so.
    pub header: Header,
    /// The frame.
    pub child_frame_id: String,
    /// Its pose in the parent's.
    pub transform: Pose,
}

/// `tf2_msgs/TFMessage`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TfMessage {
    /// The frames.
    pub transforms: Vec<TransformStamped>,
}

/// `std_msgs/ColorRGBA`; parts from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Color {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
    /// Opacity.
    pub a: f32,
}

/// `visualization_msgs/Marker`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// Frame and time.
    pub header: Header,
    /// Namespace of the number.
    pub ns: String,
    /// Number.
    pub id: i32,
    /// Shape.
    pub kind: i32,
    /// What is done with it.
    pub action: i32,
    /// Where it is.
    pub pose: Pose,
    /// Its extents, metres.
    pub scale: Vector3,
    /// Its colour.
    pub color: Color,
    /// How long it stays; 0 for ever.
    pub lifetime: Time,
    /// Moves with its frame.
    pub frame_locked: bool,
    /// Unused.
    pub points: Vec<Vector3>,
    /// Unused.
    pub colors: Vec<Color>,
    /// Unused.
    pub texture_resource: String,
    /// Unused.
    pub texture: CompressedImage,
    /// Unused.
    pub uv_coordinates: Vec<UvCoordinate>,
    /// Text that is shown.
    pub text: String,
    /// Unused.
    pub mesh_resource: String,
    /// Unused.
    pub mesh_file: MeshFile,
    /// Unused.
    pub mesh_use_embedded_materials: bool,
}

impl Marker {
    /// Kind of a box.
    pub const CUBE: i32 = 1;
    /// Kind of a text that faces the viewer.
    pub const TEXT: i32 = 9;
    /// Action that shows it.
    pub const ADD: i32 = 0;
    /// Action that removes all markers of the topic.
    pub const DELETE_ALL: i32 = 3;
}

/// `sensor_msgs/CompressedImage`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompressedImage {
    /// Frame and time.
    pub header: Header,
    /// Its format.
    pub format: String,
    /// The image.
    pub data: Vec<u8>,
}

/// `visualization_msgs/UVCoordinate`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UvCoordinate {
    /// Across.
    pub u: f32,
    /// Down.
    pub v: f32,
}

/// `visualization_msgs/MeshFile`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshFile {
    /// Its name.
    pub filename: String,
    /// Its contents.
    pub data: Vec<u8>,
}

/// `visualization_msgs/MarkerArray`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MarkerArray {
    /// The markers.
    pub markers: Vec<Marker>,
}

/// `diagnostic_msgs/KeyValue`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    /// What it is.
    pub key: String,
    /// Its value.
    pub value: String,
}

/// `diagnostic_msgs/DiagnosticStatus`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// One of the levels.
    pub level: u8,
    /// What is judged.
    pub name: String,
    /// The judgement.
    pub message: String,
    /// The machine.
    pub hardware_id: String,
    /// Figures.
    pub values: Vec<KeyValue>,
}

impl DiagnosticStatus {
    /// Level of what works.
    pub const OK: u8 = 0;
    /// Level of what will work again.
    pub const WARN: u8 = 1;
    /// Level of what does not work.
    pub const ERROR: u8 = 2;
    /// Level of what is not known.
    pub const STALE: u8 = 3;
}

/// `diagnostic_msgs/DiagnosticArray`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// When it was so.
    pub header: Header,
    /// The judgements.
    pub status: Vec<DiagnosticStatus>,
}
