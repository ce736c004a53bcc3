//! Lines of detectors, after the camera_info of the camera and a zero byte.

use std::sync::OnceLock;
use std::time::Duration;

use config::Settings;
use detections::args::FeedArgs;
use detections::{Camera, Feed};
use messages::Change;
use service::Time;

pub(super) fn run(input: &[u8]) {
    static SETTINGS: OnceLock<Settings> = OnceLock::new();
    let settings = SETTINGS.get_or_init(|| crate::settings(&[]));
    let text = String::from_utf8_lossy(input);
    let (yaml, line) = text.split_once('\0').unwrap_or(("", &text));
    let args = FeedArgs {
        camera: None,
        frame: "base".to_owned(),
        height: Some(1.0),
        classes: vec![("7".to_owned(), "white".to_owned())],
        source: "detector".to_owned(),
        age: Duration::ZERO,
    };
    let mut feed =
        Feed::new(&args, settings).expect("a known frame").with(Camera::from_yaml(yaml).ok());
    let mut problems = Vec::new();
    match feed.sighting(line, Time(1), &mut problems) {
        Ok(sighting) => {
            let Change::Look(look) = sighting.change else { panic!("expected a look") };
            assert!(look.seen.iter().all(perception::Detection::is_sound), "{look:?}");
        }
        Err(problem) => assert!(!problem.is_empty()),
    }
    assert!(problems.iter().all(|problem| !problem.is_empty()));
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    const CAMERA: &str = "camera_matrix:\n  rows: 3\n  data: [500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0]\n\
        distortion_model: plumb_bob\nd:\n- -0.2\n- 0.05\n\0";
    let lines = [
        r#"{"age_s": 0.5, "seen": [{"classes": {"white": 0.8}, "xyz": [0.7, 0.1, -0.1]}]}"#,
        r#"[{"name": "white bowl", "confidence": 0.8, "box": {"x1": 360, "y1": 230, "x2": 380, "y2": 250}}]"#,
        r#"[{"category_id": 7, "bbox": [310.0, 230.0, 20.0, 20.0], "score": 0.7, "depth": 0.9}]"#,
        r#"[{"label": "metal", "score": 0.5, "box": {"xmin": 360, "ymin": 230, "xmax": 380, "ymax": 250}}]"#,
        r#"{"scores": [0.8], "boxes": [[100.0, 50.0, 120.0, 90.0]], "labels": ["a clear bowl"], "depths": [0.9]}"#,
        r#"{"header": {"frame_id": "base"}, "detections": [{"results": [{"hypothesis": {"class_id": "white",
            "score": 0.8}}], "bbox": {"center": {"position": {"x": 0.7, "y": 0.1, "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}}}]}"#,
        r#"[{"tag_family": "tag36h11", "tag_id": 7, "pose_t": [[0.1], [0.0], [1.0]],
            "pose_R": [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]}]"#,
    ];
    lines.into_iter().map(|line| [CAMERA, line].concat().into_bytes()).collect()
}
