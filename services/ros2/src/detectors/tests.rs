use super::*;
use crate::types::{
    Detection3D, ObjectHypothesis, ObjectHypothesisWithPose, Point, Pose, PoseStamped,
    PoseWithCovariance, Quaternion, TransformStamped,
};
use messages::{Change, Look};
use perception::Frame;
use ros::detector::Label;

fn detector(labels: &[(&str, &str)]) -> TopicDetector {
    let label = |(id, object): &(&str, &str)| Label {
        id: (*id).to_owned(),
        object: (*object).to_owned(),
        ..Label::default()
    };
    let labels: Vec<_> = labels.iter().map(label).collect();
    let lens = Frame { name: "lens".to_owned(), xyz: [0.0, 0.0, 1.0], rpy: [0.0; 3] };
    let bowls = include_str!("../../../../config/scenes/bowls.toml");
    let scene = scene::Scene::from_toml("bowls", bowls).unwrap();
    let detector = Detector::new("/camera", &labels, Some(scene), &[lens]);
    TopicDetector { topic: "/camera".to_owned(), detector }
}

fn header() -> Header {
    Header { stamp: Time { sec: 1000, nanosec: 250_000_000 }, frame_id: "lens".to_owned() }
}

fn turned(x: f64) -> Pose {
    let orientation = Quaternion { x: 0.0, y: 0.0, z: 0.6, w: 0.8 };
    Pose { position: Point { x, y: 0.1, z: 0.2 }, orientation }
}

/// Two objects; the second one has its pose in the box alone.
fn detections() -> Detection3DArray {
    let mut covariance = crate::types::Covariance::default();
    for (n, variance) in [(0, 0.01), (7, 0.02), (14, 0.03), (35, 0.04)] {
        covariance.0[n] = variance;
    }
    let result = |class: &str, score, pose| ObjectHypothesisWithPose {
        hypothesis: ObjectHypothesis { class_id: class.to_owned(), score },
        pose: PoseWithCovariance { pose, covariance },
    };
    let detection = |id: &str, results| {
        let mut detection = Detection3D { header: header(), results, ..Detection3D::default() };
        detection.id = id.to_owned();
        detection.bbox.center = turned(0.9);
        detection.bbox.size = [0.1; 3].into();
        detection
    };
    let both = vec![result("cup", 0.7, turned(0.5)), result("dog", 0.2, turned(0.6))];
    let boxed = vec![result("white", 0.9, Pose::IDENTITY)];
    Detection3DArray {
        header: header(),
        detections: vec![detection("17", both), detection("", boxed)],
    }
}

fn ar_markers() -> AlvarMarkers {
    let pose = PoseStamped { header: Header::default(), pose: turned(0.5) };
    let marker = AlvarMarker { header: header(), id: 11, confidence: 0, pose };
    AlvarMarkers { header: Header::default(), markers: vec![marker] }
}

fn look_of(sighting: Sighting) -> Look {
    assert_eq!(sighting.frame, "base");
    match sighting.change {
        Change::Look(look) => look,
        other => panic!("expected a look, found {other:?}"),
    }
}

fn assert_at(detection: &messages::Detection, x: f64) {
    let rounded = |xyz: [f64; 3]| xyz.map(|n| (n * 1e9).round());
    assert_eq!(rounded(detection.xyz), rounded([x, 0.1, 1.2]));
    assert!((detection.yaw - 2.0 * 0.6_f64.atan2(0.8)).abs() < 1e-9, "{detection:?}");
}

#[test]
fn detections_become_a_look_with_tracks_classes_and_covariances() {
    let mut detector = detector(&[("cup", "metal")]);
    let clock = SystemClock::now();
    let look = look_of(detector.look(&detections(), clock));
    assert_eq!((look.at_ns, look.whole, look.seen.len()), (1, true, 2), "decades old");
    assert_at(&look.seen[0], 0.5);
    assert_at(&look.seen[1], 0.9);
    let seen = look.seen.iter().map(|it| (it.track.as_str(), it.classes[0].0.as_str()));
    assert_eq!(seen.collect::<Vec<_>>(), [("17", "metal"), ("", "white")]);
    assert_eq!(look.seen[0].variances, [0.01, 0.02, 0.03, 0.04]);
    assert_eq!(detector.detector.counts().unknown, 1, "a dog");
}

#[test]
fn headers_of_ar_markers_count_where_the_outer_one_is_empty() {
    let mut detector = detector(&[("11", "metal")]);
    let look = look_of(detector.look(&ar_markers(), SystemClock::now()));
    assert_at(&look.seen[0], 0.5);
    assert_eq!((look.seen[0].track.as_str(), look.seen[0].variances), ("11", [0.0; 4]));
}

#[test]
fn message_without_a_stamp_counts_from_its_arrival() {
    let mut detector = detector(&[]);
    let empty = look_of(detector.look(&Detection3DArray::default(), SystemClock::now()));
    assert_eq!(empty, Look { at_ns: 0, whole: true, seen: Vec::new() });
}

#[test]
fn of_all_transforms_those_of_markers_are_taken() {
    let mut detector = detector(&[("tag36h11:7", "metal"), ("ar_marker_3", "white")]);
    let frame = |child: &str| TransformStamped {
        header: header(),
        child_frame_id: child.to_owned(),
        transform: turned(0.5),
    };
    let transforms = ["left_wrist", "tag36h11:7", "white", "/ar_marker_3"].map(frame).to_vec();
    let sightings = detector.markers(&TfMessage { transforms }, SystemClock::now());
    let sources: Vec<_> = sightings.iter().map(|it| it.source.as_str()).collect();
    assert_eq!(sources, ["/camera tag36h11:7", "/camera ar_marker_3"]);
    assert_eq!(detector.detector.counts(), UnusedCounts::default());
    for sighting in sightings {
        let look = look_of(sighting);
        assert_at(&look.seen[0], 0.5);
        assert!(!look.whole, "what has no message may be there all the same");
    }
}

#[cfg(feature = "dds")]
pub(crate) mod bytes {
    use super::*;
    use rustdds::RepresentationIdentifier;
    use rustdds::serialization::deserialize_from_cdr_with_rep_id;
    use serde::de::DeserializeOwned;

    /// Reads a message that Cyclone DDS has written, behind the four bytes of its encoding.
    pub(crate) fn read<M: DeserializeOwned>(hex: &str) -> M {
        let digits: Vec<char> = hex.chars().filter(char::is_ascii_hexdigit).collect();
        let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16);
        let bytes: Vec<u8> = digits.chunks(2).map(|pair| byte(pair).unwrap()).collect();
        assert_eq!(bytes[..4], [0, 1, 0, 0], "little endian");
        let encoding = RepresentationIdentifier::CDR_LE;
        deserialize_from_cdr_with_rep_id(&bytes[4..], encoding).unwrap().0
    }

    #[test]
    fn messages_of_cyclone_dds_are_read() {
        let hex = include_str!("../../../../tests/fixtures/ros2/detections.hex");
        assert_eq!(read::<Detection3DArray>(hex), detections());
        let hex = include_str!("../../../../tests/fixtures/ros2/ar_markers.hex");
        assert_eq!(read::<AlvarMarkers>(hex), ar_markers());
    }
}
