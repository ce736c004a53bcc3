//! Messages that viewers draw, in the schemas of Foxglove, as JSON: names and fields are theirs.

use serde::{Deserialize, Serialize};

/// Nanoseconds of a second.
const SECOND: u64 = 1_000_000_000;

/// A moment, or a length of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Time {
    /// Whole seconds, of a moment since 1970.
    pub sec: u64,
    /// Nanoseconds in addition to the seconds.
    pub nsec: u32,
}

impl Time {
    /// A moment, nanoseconds since 1970.
    pub fn at(wall_ns: u64) -> Self {
        Self { sec: wall_ns / SECOND, nsec: (wall_ns % SECOND) as u32 }
    }
}

/// A vector or a point, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "coordinates")]
pub struct Vector3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "coordinates")]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Default for Quaternion {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }
    }
}

/// Position and orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the type says it")]
pub struct Pose {
    pub position: Vector3,
    pub orientation: Quaternion,
}

impl From<[f64; 7]> for Pose {
    fn from([px, py, pz, x, y, z, w]: [f64; 7]) -> Self {
        Self { position: [px, py, pz].into(), orientation: Quaternion { x, y, z, w } }
    }
}

/// A colour, each part from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "parts of a colour")]
pub struct Color {
    pub r: f64,
    pub g: f64,
    pub b: f64,
    pub a: f64,
}

/// `foxglove.JointStates`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointStates {
    /// When the joints were so.
    pub timestamp: Time,
    /// The joints.
    pub joints: Vec<JointState>,
}

/// A joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// Name in the robot's description.
    pub name: String,
    /// Radians or metres.
    pub position: f64,
    /// rad/s or m/s.
    pub velocity: f64,
    /// Newton metres or newtons.
    pub effort: f64,
}

/// `foxglove.FrameTransforms`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameTransforms {
    /// The frames.
    pub transforms: Vec<FrameTransform>,
}

/// Pose of a frame in its parent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameTransform {
    /// Time of the pose.
    pub timestamp: Time,
    /// The parent.
    pub parent_frame_id: String,
    /// The frame.
    pub child_frame_id: String,
    /// Origin of the frame in the parent, metres.
    pub translation: Vector3,
    /// Orientation of the frame in the parent.
    pub rotation: Quaternion,
}

/// `foxglove.SceneUpdate`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneUpdate {
    /// Entities that are gone.
    pub deletions: Vec<SceneEntityDeletion>,
    /// Present entities; each replaces the one of its name.
    pub entities: Vec<SceneEntity>,
}

/// Deletion of an entity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneEntityDeletion {
    /// Since when.
    pub timestamp: Time,
    /// 0: the one of this name; 1: all.
    #[serde(rename = "type")]
    pub kind: u8,
    /// Name of the entity.
    pub id: String,
}

/// A group of shapes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneEntity {
    /// Time from which the entity has this state.
    pub timestamp: Time,
    /// Frame of the shapes.
    pub frame_id: String,
    /// Name of the entity.
    pub id: String,
    /// How long it is shown; 0 for as long as it is not replaced.
    pub lifetime: Time,
    /// Whether the entity moves with its frame.
    pub frame_locked: bool,
    /// Further properties of the entity.
    pub metadata: Vec<KeyValue>,
    /// None.
    pub arrows: Vec<Unused>,
    /// Boxes.
    pub cubes: Vec<CubePrimitive>,
    /// None.
    pub spheres: Vec<Unused>,
    /// None.
    pub cylinders: Vec<Unused>,
    /// Lines.
    pub lines: Vec<LinePrimitive>,
    /// None.
    pub triangles: Vec<Unused>,
    /// Texts in space.
    pub texts: Vec<TextPrimitive>,
    /// None.
    pub models: Vec<Unused>,
}

/// A shape that is never drawn here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unused {}

/// A named text.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    /// Name of the property.
    pub key: String,
    /// The text.
    pub value: String,
}

/// A box.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CubePrimitive {
    /// Centre of the box.
    pub pose: Pose,
    /// Extents of the box, metres.
    pub size: Vector3,
    /// Colour of the box.
    pub color: Color,
}

/// Lines between points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinePrimitive {
    /// 0: from each point to the next.
    #[serde(rename = "type")]
    pub kind: u8,
    /// Origin of the points.
    pub pose: Pose,
    /// Thickness, metres or pixels.
    pub thickness: f64,
    /// Whether the thickness is in pixels.
    pub scale_invariant: bool,
    /// The points.
    pub points: Vec<Vector3>,
    /// Colour of all.
    pub color: Color,
    /// Colour of each point, if they differ.
    pub colors: Vec<Color>,
    /// Order of the points, if it is another one.
    pub indices: Vec<u32>,
}

/// Text in space.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TextPrimitive {
    /// Centre of the text.
    pub pose: Pose,
    /// Whether the text faces the camera.
    pub billboard: bool,
    /// Height of a line, metres or pixels.
    pub font_size: f64,
    /// Whether the height is in pixels.
    pub scale_invariant: bool,
    /// Colour of the text.
    pub color: Color,
    /// The text.
    pub text: String,
}

/// `foxglove.Log`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Log {
    /// Time of writing.
    pub timestamp: Time,
    /// One of [`level`].
    pub level: u8,
    /// The text.
    pub message: String,
    /// Name of the writer.
    pub name: String,
    /// Module of the program.
    pub file: String,
    /// Unknown: 0.
    pub line: u32,
}

/// Levels of a [`Log`].
pub mod level {
    /// Not known.
    pub const UNKNOWN: u8 = 0;
    /// For developers.
    pub const DEBUG: u8 = 1;
    /// Normal operation.
    pub const INFO: u8 = 2;
    /// Unusual.
    pub const WARNING: u8 = 3;
    /// Wrong.
    pub const ERROR: u8 = 4;
}

/// `foxglove.RawAudio`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RawAudio {
    /// When the first sample was taken.
    pub timestamp: Time,
    /// The samples.
    pub data: Base64,
    /// `pcm-s16`: 16 bits each, little-endian.
    pub format: String,
    /// Samples of a channel in a second.
    pub sample_rate: u32,
    /// Channels.
    pub number_of_channels: u32,
}

/// Bytes as text of the base64 alphabet.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Base64(pub String);

impl From<&[u8]> for Base64 {
    fn from(bytes: &[u8]) -> Self {
        const LETTERS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
        for three in bytes.chunks(3) {
            let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            for letter in 0..4 {
                let six = (bits >> (18 - 6 * letter)) & 63;
                let is_used = letter <= three.len();
                text.push(if is_used { char::from(LETTERS[six as usize]) } else { '=' });
            }
        }
        Self(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_as_base64() {
        let of = |text: &str| Base64::from(text.as_bytes()).0;
        assert_eq!(
            ["", "f", "fo", "foo", "foob"].map(of),
            ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]
        );
        assert_eq!(Base64::from(&[0xfb, 0xff][..]).0, "+/8=");
    }
}
