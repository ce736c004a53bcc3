//! The message types of detectors that the bridge reads.
//!
//! Names, fields, constants and checksums are facts of geometry_msgs, sensor_msgs, of vision_msgs as it is in
//! ROS 1 (kinetic to noetic), of apriltag_ros and of ar_track_alvar_msgs.

use ros::message;
use ros::wire::Skipped;

use super::{BoundingBox3D, Header, Pose, PoseWithCovariance};

message! {
    /// A pose with covariance at a time in a frame.
    PoseWithCovarianceStamped = "geometry_msgs/PoseWithCovarianceStamped" "953b798c0f514ff060a53a3498ce6246" {
        header: Header,
        pose: PoseWithCovariance,
    }
}
message! {
    /// A pose at a time in a frame.
    PoseStamped = "geometry_msgs/PoseStamped" "d3812c3cbc69362b77dc0b19b345f8f5" {
        header: Header,
        pose: Pose,
    }
}
message! {
    /// One channel of a point cloud.
    PointField = "sensor_msgs/PointField" "268eacb2962780ceac86cbd17e328150"
        "uint8 INT8=1
        uint8 UINT8=2
        uint8 INT16=3
        uint8 UINT16=4
        uint8 INT32=5
        uint8 UINT32=6
        uint8 FLOAT32=7
        uint8 FLOAT64=8" {
        name: String,
        offset: u32,
        datatype: u8,
        count: u32,
    }
}
message! {
    /// A point cloud, whose points are skipped.
    PointCloud2 = "sensor_msgs/PointCloud2" "1158d486dd51d683ce2f1be655c3c181" {
        header: Header,
        height: u32,
        width: u32,
        fields: Vec<PointField>,
        is_bigendian: bool,
        point_step: u32,
        row_step: u32,
        data: Skipped,
        is_dense: bool,
    }
}
message! {
    /// What a detected object may be.
    ObjectHypothesisWithPose = "vision_msgs/ObjectHypothesisWithPose" "fa1ab3bc7146f53921fa142d631d02db" {
        id: i64,
        score: f64,
        pose: PoseWithCovariance,
    }
}
message! {
    /// A detected object.
    Detection3D = "vision_msgs/Detection3D" "7f3d8e29f3ab9853108801543aec1a5d" {
        header: Header,
        results: Vec<ObjectHypothesisWithPose>,
        bbox: BoundingBox3D,
        source_cloud: PointCloud2,
    }
}
message! {
    /// The objects that one image shows.
    Detection3DArray = "vision_msgs/Detection3DArray" "05c51d9aea1fb4cfdc8effb94f197b6f" {
        header: Header,
        detections: Vec<Detection3D>,
    }
}
message! {
    /// An AprilTag, or a bundle of several with one pose.
    AprilTagDetection = "apriltag_ros/AprilTagDetection" "090173a6e2b6c8fd96ce000fe9378b4e" {
        id: Vec<i32>,
        size: Vec<f64>,
        pose: PoseWithCovarianceStamped,
    }
}
message! {
    /// The AprilTags that one image shows.
    AprilTagDetectionArray = "apriltag_ros/AprilTagDetectionArray" "2b6c03434883a5c9897c13b5594dbd91" {
        header: Header,
        detections: Vec<AprilTagDetection>,
    }
}
message! {
    /// A marker of ALVAR.
    AlvarMarker = "ar_track_alvar_msgs/AlvarMarker" "ef2b6ad42bcb18e16b22fefb5c0fb85f" {
        header: Header,
        id: u32,
        confidence: u32,
        pose: PoseStamped,
    }
}
message! {
    /// The markers of ALVAR that one image shows.
    AlvarMarkers = "ar_track_alvar_msgs/AlvarMarkers" "943fe17bfb0b4ea7890368d0b25ad0ad" {
        header: Header,
        markers: Vec<AlvarMarker>,
    }
}
