//! Messages of detectors: vision_msgs as it is from Galactic on, and ar_track_alvar_msgs.

use super::{Header, Pose, Vector3};
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A covariance of position and rotation, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covariance(pub [f64; 36]);

impl Default for Covariance {
    fn default() -> Self {
        Self([0.0; 36])
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

/// `geometry_msgs/PoseWithCovariance`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseWithCovariance {
    /// The pose.
    pub pose: Pose,
    /// Its covariance.
    pub covariance: Covariance,
}

/// `geometry_msgs/PoseStamped`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseStamped {
    /// Frame and time.
    pub header: Header,
    /// The pose.
    pub pose: Pose,
}

/// `vision_msgs/ObjectHypothesis`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectHypothesis {
    /// Class.
    pub class_id: String,
    /// Score, 0 to 1.
    pub score: f64,
}

/// `vision_msgs/ObjectHypothesisWithPose`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectHypothesisWithPose {
    /// What the object may be.
    pub hypothesis: ObjectHypothesis,
    /// Its pose if it is that.
    pub pose: PoseWithCovariance,
}

/// `vision_msgs/BoundingBox3D`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox3D {
    /// Pose of the centre.
    pub center: Pose,
    /// Extents, metres.
    pub size: Vector3,
}

/// `vision_msgs/Detection3D`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detection3D {
    /// Frame and time.
    pub header: Header,
    /// What the object may be.
    pub results: Vec<ObjectHypothesisWithPose>,
    /// A box around it.
    pub bbox: BoundingBox3D,
    /// Identifier under which the detector follows it.
    pub id: String,
}

/// `vision_msgs/Detection3DArray`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detection3DArray {
    /// Frame and time of the image.
    pub header: Header,
    /// What it shows.
    pub detections: Vec<Detection3D>,
}

/// `ar_track_alvar_msgs/AlvarMarker`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AlvarMarker {
    /// Frame and time.
    pub header: Header,
    /// Number of the marker.
    pub id: u32,
    /// Unused by most versions.
    pub confidence: u32,
    /// Its pose.
    pub pose: PoseStamped,
}

/// `ar_track_alvar_msgs/AlvarMarkers`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AlvarMarkers {
    /// Often empty: those of the markers count.
    pub header: Header,
    /// What the image shows.
    pub markers: Vec<AlvarMarker>,
}
