//! Messages of detectors: vision_msgs as it is from Galactic on, and ar_track_alvar_msgs.

use super::{Header, Pose};
use ros::geometry::{BoundingBox3D, PoseWithCovariance};
use serde::{Deserialize, Serialize};

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
