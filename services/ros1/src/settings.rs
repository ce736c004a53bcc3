//! `[ros1]` of `arm.toml`: the bridge to a Baxter's ROS 1 topics.

use config::{Check, Section};
use diagnostics::Fields;
use ros::detectors::{self, Labels, topic};

/// The bridge to a Baxter's ROS 1 topics. Addresses that are absent come from the environment.
#[derive(Clone, Debug, PartialEq)]
pub struct Ros1 {
    /// The robot's ROS master: `HOST`, `HOST:PORT` or a URI.
    pub master: Option<String>,
    /// Name or address under which the robot reaches this machine.
    pub host: Option<String>,
    /// Objects from detectors.
    pub objects: Ros1Objects,
}

/// Detectors of ROS 1. A topic that is absent is not subscribed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ros1Objects {
    /// Topic of `vision_msgs/Detection3DArray`.
    pub detections: Option<String>,
    /// Topic of `apriltag_ros/AprilTagDetectionArray`.
    pub apriltags: Option<String>,
    /// Topic of `ar_track_alvar_msgs/AlvarMarkers`.
    pub ar_markers: Option<String>,
    /// Identifiers, all of them numbers.
    pub labels: Labels,
}

impl Section for Ros1 {
    const KEY: &'static [&'static str] = &["arm", "ros1"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            master: f.optional_text("master"),
            host: f.optional_text("host"),
            objects: f.table("objects", objects),
        }
    }

    fn check(&self, others: &mut Check<'_>) {
        let Ros1Objects { detections, apriltags, ar_markers, labels } = &self.objects;
        let topics =
            [("detections", detections), ("apriltags", apriltags), ("ar_markers", ar_markers)];
        detectors::check(&["arm", "ros1", "objects"], topics, labels, others);
    }
}

fn objects(f: &mut Fields<'_>) -> Ros1Objects {
    let objects = Ros1Objects {
        detections: topic(f, "detections"),
        apriltags: topic(f, "apriltags"),
        ar_markers: topic(f, "ar_markers"),
        labels: Labels::read(f),
    };
    for (key, labels) in objects.labels.lists() {
        let is_number = |id: &str| {
            id.is_empty() || id.parse::<i64>().is_ok_and(|number| number.to_string() == id)
        };
        for (n, label) in labels.iter().enumerate().filter(|(_, label)| !is_number(&label.id)) {
            let what = format!("`{}` is not a number", label.id);
            f.problem(&format!("{key}[{n}]"), what, "ROS 1 has numbers, e.g. id = \"3\"");
        }
    }
    objects
}
