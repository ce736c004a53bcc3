//! Messages of places and directions that ROS 1 and ROS 2 have in common.
//!
//! Names, fields and checksums are facts of geometry_msgs and vision_msgs; CDR, the encoding of ROS 2, has no names and
//! keeps the order of the fields.

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

use crate::message;
use crate::wire::{Field, Unreadable};

message! {
    /// A position, metres.
    #[derive(Copy, Serialize, Deserialize)]
    Point = "geometry_msgs/Point" "4a842b65f413084dc2b10fb484ea7f17" { x: f64, y: f64, z: f64 }
}
message! {
    /// A direction with a length.
    #[derive(Copy, Serialize, Deserialize)]
    Vector3 = "geometry_msgs/Vector3" "4a842b65f413084dc2b10fb484ea7f17" { x: f64, y: f64, z: f64 }
}
message! {
    /// An orientation, real part last. The default is none; [`Pose::IDENTITY`] has one.
    #[derive(Copy, Serialize, Deserialize)]
    Quaternion = "geometry_msgs/Quaternion" "a779879fadf0160734f906b8c19c7004" {
        x: f64,
        y: f64,
        z: f64,
        w: f64,
    }
}
message! {
    /// Position and orientation.
    #[derive(Copy, Serialize, Deserialize)]
    Pose = "geometry_msgs/Pose" "e45d45a5a1ce597b249e23fb30fc871f" {
        position: Point,
        orientation: Quaternion,
    }
}
message! {
    /// A pose and how uncertain it is.
    #[derive(Copy, Serialize, Deserialize)]
    PoseWithCovariance = "geometry_msgs/PoseWithCovariance" "c23e848cf1b7533a8d7c259073a97e6f" {
        pose: Pose,
        covariance: Covariance,
    }
}
message! {
    /// A box around an object: pose of its centre, and its extents, metres.
    #[derive(Copy, Serialize, Deserialize)]
    BoundingBox3D = "vision_msgs/BoundingBox3D" "727c83f2b037373b8e968433d9c84ecb" {
        center: Pose,
        size: Vector3,
    }
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl Pose {
    /// At the frame's origin, turned as the frame is.
    pub const IDENTITY: Self = Self {
        position: Point { x: 0.0, y: 0.0, z: 0.0 },
        orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    };
}

/// Position, metres, and quaternion with the real part last.
impl From<[f64; 7]> for Pose {
    fn from([px, py, pz, x, y, z, w]: [f64; 7]) -> Self {
        Self { position: Point { x: px, y: py, z: pz }, orientation: Quaternion { x, y, z, w } }
    }
}

impl From<&Pose> for crate::detector::Pose {
    fn from(Pose { position: p, orientation: q }: &Pose) -> Self {
        Self { position: [p.x, p.y, p.z], orientation: [q.x, q.y, q.z, q.w] }
    }
}

/// A covariance of position and rotation, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covariance(pub [f64; 36]);

impl Default for Covariance {
    fn default() -> Self {
        Self([0.0; 36])
    }
}

impl Field for Covariance {
    fn ros_type() -> String {
        "float64[36]".to_owned()
    }

    fn read(bytes: &mut &[u8]) -> Result<Self, Unreadable> {
        let mut covariance = Self::default();
        for value in &mut covariance.0 {
            *value = f64::read(bytes)?;
        }
        Ok(covariance)
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        self.0.iter().for_each(|value| value.write(bytes));
    }
}

impl Serialize for Covariance {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|value| tuple.serialize_element(value))?;
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for Covariance {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Values;
        impl<'de> Visitor<'de> for Values {
            type Value = Covariance;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("36 numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Covariance, A::Error> {
                let mut covariance = Covariance::default();
                for (n, value) in covariance.0.iter_mut().enumerate() {
                    let next = values.next_element()?;
                    *value = next.ok_or_else(|| A::Error::invalid_length(n, &self))?;
                }
                Ok(covariance)
            }
        }
        deserializer.deserialize_tuple(36, Values)
    }
}
