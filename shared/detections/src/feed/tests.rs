use std::path::Path;
use std::time::Duration;

use clap::Args;

use super::*;

fn settings() -> Settings {
    let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    let frame =
        "[{ name = \"lens\", xyz = [0.7, 0.1, 0.88], rpy = [3.141592653589793, 0.0, 0.0] }]";
    let over = [("group.perception.frames".to_owned(), frame.to_owned())];
    Settings::load(config, None, &over).unwrap_or_else(|error| panic!("{error}"))
}

fn args() -> FeedArgs {
    FeedArgs {
        camera: None,
        frame: "base".to_owned(),
        height: None,
        classes: Vec::new(),
        source: "detector".to_owned(),
        age: Duration::ZERO,
    }
}

/// What a line becomes: the detections in frame `base`, and the problems.
fn read(args: &FeedArgs, line: &Json) -> Result<(Vec<Detection>, Vec<String>), String> {
    read_look(args, line).map(|(look, problems)| (look.seen, problems))
}

/// The look that a line becomes, and the problems.
fn read_look(args: &FeedArgs, line: &Json) -> Result<(Look, Vec<String>), String> {
    let settings = settings();
    let mut feed = Feed::new(args, &settings)?;
    let mut problems = Vec::new();
    let sighting = feed.sighting(&line.to_string(), Time(2_000_000_000), &mut problems)?;
    let Change::Look(look) = sighting.change else { panic!("a look") };
    let frames = &settings.group.perception.tracker.frames;
    let (used, _) =
        perception::in_base(frames, &sighting.frame, &look.seen, &settings.scene).unwrap();
    Ok((Look { seen: used, ..look }, problems))
}

fn camera() -> (tempfile::TempDir, FeedArgs) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera.yaml");
    let yaml = "camera_matrix:\n  data: [500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0]\n";
    std::fs::write(&path, yaml).unwrap();
    let frame = "lens".to_owned();
    (folder, FeedArgs { camera: Some(path), frame, ..args() })
}

fn assert_at(detection: &Detection, xyz: [f64; 3]) {
    assert!(detection.xyz.iter().zip(xyz).all(|(a, b)| (a - b).abs() < 1e-9), "{detection:?}");
}

#[test]
fn objects_feed_reads_looks_and_says_what_is_wrong() {
    let line = json!({"age_s": 0.5, "seen": [{"classes": {"white": 0.8, "metal": 0.2},
        "attributes": {"color": {"white": 0.9}}, "xyz": [0.7, 0.1, -0.1]}]});
    let sighting = look(&line, Time(2_000_000_000)).unwrap();
    assert_eq!((sighting.source.as_str(), sighting.frame.as_str()), ("script", "base"));
    let Change::Look(look) = sighting.change else { panic!("a look") };
    assert_eq!((look.at_ns, look.whole, look.seen.len()), (1_500_000_000, true, 1));
    assert_eq!(look.seen[0].attributes[0].1, [("white".to_owned(), 0.9)]);
    let (before_start, _) = read_look(&args(), &json!({"age_s": 1e6, "seen": []})).unwrap();
    assert_eq!(before_start.at_ns, 1, "old: 0 stands for now");
    let unknown = read(&args(), &json!({"seen": [], "colour": 1})).unwrap_err();
    assert!(unknown.contains("colour"), "{unknown}");
    assert!(read(&args(), &json!("nothing")).is_err());
    let person = json!({"seen": [{"classes": {"person": 0.9}, "xyz": [1.0, 0.0, 0.0]}]});
    let (used, problems) = read(&args(), &person).unwrap();
    assert!(used.is_empty() && problems[0].contains("no object `person`"), "{problems:?}");
}

#[test]
fn boxes_become_objects_in_front_of_the_robot() {
    let (_folder, at_height) = camera();
    let bowl = json!([{"name": "white bowl", "confidence": 0.8,
        "box": {"x1": 360.0, "y1": 230.0, "x2": 380.0, "y2": 250.0}}]);
    let (used, problems) = read(&at_height, &bowl).unwrap();
    assert!(used.is_empty() && problems[0].contains("--height"), "{problems:?}");
    let at_height = FeedArgs { height: Some(-0.12), ..at_height };
    let (used, problems) = read(&at_height, &bowl).unwrap();
    assert_eq!(problems, [""; 0]);
    assert_at(&used[0], [0.8, 0.1, -0.12]);
    assert_eq!(used[0].classes.len(), 3, "three white bowls: {used:?}");
    assert!(used[0].variances[3] > 9.0, "a box says nothing of the yaw: {used:?}");
    assert!(read(&args(), &bowl).unwrap().1[0].contains("--camera"));
    let classes = vec![("51".to_owned(), "metal".to_owned())];
    let by_id = FeedArgs { classes, ..at_height };
    let coco = json!([{"category_id": 51, "bbox": [310.0, 230.0, 20.0, 20.0], "score": 0.7, "depth": 0.9}]);
    let (used, _) = read(&by_id, &coco).unwrap();
    assert_at(&used[0], [0.7, 0.1, -0.02]);
    assert_eq!(used[0].classes, [("metal".to_owned(), 0.7)]);
}

#[test]
fn a_box_that_cannot_be_placed_leaves_the_others_of_its_line() {
    let (_folder, args) = camera();
    let bowl = |depth: f64| {
        json!({"label": "metal", "score": 0.8, "depth": depth,
            "box": {"xmin": 310.0, "ymin": 230.0, "xmax": 330.0, "ymax": 250.0}})
    };
    let (look, problems) = read_look(&args, &json!([bowl(0.0), bowl(0.9), bowl(-0.5)])).unwrap();
    assert_eq!((look.whole, look.seen.len(), problems.len()), (false, 1, 2), "{problems:?}");
    assert!(problems.iter().all(|it| it.contains("`depth` above 0 m")), "{problems:?}");
    assert!(read_look(&args, &json!([bowl(0.9)])).unwrap().0.whole);
}

/// What is printed about lines, and how many are sent.
fn printed_about(args: &FeedArgs, lines: &[u8]) -> (Vec<Json>, usize) {
    let (settings, mut printed, mut sent) = (settings(), Vec::new(), 0);
    let send = |_: Sighting| {
        sent += 1;
        Ok(())
    };
    let feed = Feed::new(args, &settings).unwrap();
    let exit = send_lines(lines, feed, send, &mut Output::to(&mut printed, false)).unwrap();
    assert_eq!(exit, Exit::NotReached);
    let printed = String::from_utf8(printed).unwrap();
    (printed.lines().map(|line| serde_json::from_str(line).unwrap()).collect(), sent)
}

#[test]
fn wrong_numbers_leave_the_others_of_a_look() {
    let seen = |p: f64| json!({"classes": {"metal": p}, "xyz": [0.7, 0.1, -0.1]});
    let (look, problems) = read_look(&args(), &json!({"seen": [seen(1.2), seen(0.8)]})).unwrap();
    assert_eq!((look.whole, look.seen.len(), problems.len()), (false, 1, 1), "{problems:?}");
    assert_eq!(look.seen[0].classes, [("metal".to_owned(), 0.8)]);
    assert!(problems[0].contains("outside of 0 to 1"), "{problems:?}");
}

#[test]
fn a_detection_without_a_class_is_said_and_is_no_object() {
    let (_folder, lens) = camera();
    let place = json!({"position": {"x": 0.7, "y": 0.1, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}});
    let pixel = json!({"position": {"x": 320.0, "y": 240.0}});
    let solid = json!({"results": [], "bbox": {"center": place}});
    let flat = json!({"results": [], "depth": 0.9, "bbox": {"center": pixel, "size_x": 20.0}});
    for (detection, reason) in [(solid, "without a class"), (flat, "no object ``")] {
        let line = json!({"header": {"frame_id": "base"}, "detections": [detection]});
        let (used, problems) = read(&lens, &line).unwrap();
        assert!(used.is_empty() && problems[0].contains(reason), "{problems:?}");
    }
}

#[test]
fn a_camera_needs_its_frame() {
    let parse = |words: &[&str]| {
        let feed = FeedArgs::augment_args(clap::Command::new("feed"));
        feed.try_get_matches_from([&["feed", "--camera", "head.yaml"], words].concat())
    };
    assert!(parse(&[]).unwrap_err().to_string().contains("--frame <NAME>"));
    assert!(parse(&["--frame", "head"]).is_ok());
}

#[test]
fn a_problem_is_said_once_wherever_its_object_is() {
    let far = |x: f64| {
        let seen = json!({"classes": {"metal": 1.0}, "xyz": [x, -0.5, 12.25]});
        json!({ "seen": [seen] }).to_string()
    };
    let tag = |n: u64| json!([{"tag_id": n, "pose_t": [0.1, 0.0, 1.0]}]).to_string();
    let lines = [far(650.0), far(-651.5), tag(7), far(60.0), tag(8), tag(7)].join("\n");
    let (printed, sent) = printed_about(&args(), lines.as_bytes());
    let at: Vec<_> = printed.iter().map(|line| line["line"].as_u64().unwrap()).collect();
    assert_eq!((at, sent), (vec![1, 3, 4, 5], 6), "{printed:?}");
    assert!(printed[0]["error"].as_str().unwrap().contains("650 -0.5 12.25"), "{printed:?}");
}

#[test]
fn a_line_that_is_no_text_is_skipped() {
    let lines = b"{\"seen\": []}\n\xff\xfe\n \r\n{\"seen\": []}\r\n";
    let (printed, sent) = printed_about(&args(), lines);
    assert_eq!((printed.len(), sent, printed[0]["line"].as_u64()), (1, 2, Some(2)), "{printed:?}");
    assert!(printed[0]["error"].as_str().unwrap().contains("utf-8"), "{printed:?}");
}

#[test]
fn tags_and_poses_are_those_of_their_labels() {
    let (_folder, lens) = camera();
    let lens = FeedArgs { classes: vec![("7".to_owned(), "clear".to_owned())], ..lens };
    let tag = json!([{"tag_family": "tag36h11", "tag_id": 7, "pose_t": [0.1, 0.0, 1.0]},
        {"tag_family": "tag36h11", "tag_id": 8, "pose_t": [0.1, 0.0, 1.0]}]);
    let (used, problems) = read(&lens, &tag).unwrap();
    assert_at(&used[0], [0.8, 0.1, -0.12]);
    assert_eq!((used.len(), used[0].track.as_str()), (1, "tag36h11:7"));
    assert!(problems[0].contains("tag36h11:8"), "{problems:?}");
    let frame = read(&FeedArgs { frame: "nose".to_owned(), ..lens }, &tag).unwrap_err();
    assert!(frame.contains("unknown frame `nose`"), "{frame}");
}
