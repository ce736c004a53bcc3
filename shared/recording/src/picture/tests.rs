use super::*;
use messages::{ActKind, FixedText, MotionPhase, PhaseWay, WireMessage};
use serde_json::Value;
use std::path::Path;

fn painter() -> Painter {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let settings = Settings::load(&config, None, &[]).unwrap();
    Painter::new(&settings, Robot::baxter(), PathBuf::from("/dev/null/log"))
}

const CLOCK: WallClock = WallClock { offset_ns: 1_000_000_000 };

fn collect(act: impl FnOnce(&mut dyn FnMut(Shown))) -> Vec<(Picture, u64, Value)> {
    let mut shown = Vec::new();
    act(&mut |(picture, at, bytes)| {
        let value = match picture {
            Picture::RobotDescription => Value::Null,
            _ => serde_json::from_slice(&bytes).unwrap(),
        };
        shown.push((picture, at, value));
    });
    shown
}

fn send(painter: &mut Painter, topic: &Topic, at: u64, payload: &impl Serialize) -> Vec<Value> {
    let bytes = postcard::to_stdvec(payload).unwrap();
    let message = AnyMessage::Encoded(&bytes);
    let shown = collect(|show| painter.on_message(topic, (Monotonic(at), CLOCK), message, show));
    shown.into_iter().map(|(.., value)| value).collect()
}

fn send_fixed<T: WireMessage>(painter: &mut Painter, at: u64, message: &T) -> Vec<Value> {
    let message = AnyMessage::Fixed(FixedMessage::of(message));
    let topic = &topics::JOINTS;
    let shown = collect(|show| painter.on_message(topic, (Monotonic(at), CLOCK), message, show));
    shown.into_iter().map(|(.., value)| value).collect()
}

fn scene_of(painter: &mut Painter) -> Option<Value> {
    let shown = collect(|show| painter.show_scene(Monotonic(0), CLOCK, show));
    shown.into_iter().next().map(|(.., value)| value)
}

fn world() -> WorldView {
    let pose = |x: usize| Some([x as f64, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]);
    let mut objects: Vec<_> = (0..6).map(pose).collect();
    objects[2] = None;
    WorldView { objects, ..WorldView::default() }
}

#[test]
fn scene_has_boxes_in_the_colour_of_the_belief_and_the_planned_path() {
    let mut painter = painter();
    assert_eq!(scene_of(&mut painter), None, "nothing is known yet");
    let frames = send(&mut painter, &topics::WORLD, 5, &world());
    let frames = frames[0]["transforms"].as_array().unwrap();
    assert_eq!((frames.len(), &frames[1]["child_frame_id"]), (5, &"object/white2".into()));
    assert_eq!(frames[0]["timestamp"], serde_json::json!({"sec": 1, "nsec": 0}));
    let view = PolicyView { belief: vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0], ..PolicyView::default() };
    send(&mut painter, &topics::VIEW, 5, &view);
    let scene = scene_of(&mut painter).unwrap();
    let objects = &scene["entities"][0];
    assert_eq!(objects["cubes"].as_array().unwrap().len(), 5);
    let red = serde_json::json!({"r": 1.0, "g": 0.0, "b": 0.0, "a": 1.0});
    assert_eq!(objects["cubes"][1]["color"], red);
    assert_eq!(objects["texts"][1]["text"], "white2 100 %");
    assert_eq!(scene["deletions"][0]["id"], "path");
    assert_eq!(scene_of(&mut painter), None, "nothing has changed");
    let way = |x| PhaseWay {
        phase: MotionPhase::Approach,
        points_m: vec![[x, 0.0, 0.0]; 2],
        t_s: vec![0.0, 1.0],
    };
    let path = TrajectoryView { phases: vec![way(0.5), way(0.7)], ..TrajectoryView::default() };
    send(&mut painter, &topics::TRAJECTORY, 6, &path);
    let scene = scene_of(&mut painter).unwrap();
    assert_eq!(scene["entities"][1]["lines"][0]["points"].as_array().unwrap().len(), 4);
    send(&mut painter, &topics::TRAJECTORY, 7, &TrajectoryView::default());
    assert_eq!(scene_of(&mut painter).unwrap()["entities"].as_array().unwrap().len(), 1);
    // A new file shows it again.
    let shown = collect(|show| painter.begin(Monotonic(9), CLOCK, show));
    let pictures: Vec<_> = shown.iter().map(|(picture, ..)| *picture).collect();
    assert_eq!(pictures, [Picture::RobotDescription, Picture::Frames]);
    assert!(scene_of(&mut painter).is_some());
}

#[test]
fn joints_have_the_descriptions_names_and_are_shown_less_often_at_rest() {
    let mut painter = painter();
    let states = messages::JointStates { gripper_percent: [100.0, 0.0], ..Default::default() };
    let shown = send_fixed(&mut painter, 1, &states);
    let joints = shown[0]["joints"].as_array().unwrap();
    let names: Vec<_> = joints.iter().map(|joint| joint["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"left_s0") && names.iter().any(|name| name.contains("finger")));
    let ms = 1_000_000;
    assert_eq!(send_fixed(&mut painter, 100 * ms, &states).len(), 0);
    let mut moved = states;
    moved.position[3] = 0.5;
    assert_eq!(send_fixed(&mut painter, 110 * ms, &moved).len(), 1);
    assert_eq!(send_fixed(&mut painter, 120 * ms, &states).len(), 0, "20 a second");
    assert_eq!(send_fixed(&mut painter, 2_000 * ms, &moved).len(), 1);
}

#[test]
fn dialogue_has_each_line_once() {
    let mut painter = painter();
    let text = FixedText::truncated("the white one");
    let heard =
        Receipt { status: ReceiptStatus::Accepted.code(), note: text, ..Receipt::default() };
    let shown = send_fixed(&mut painter, 1, &heard);
    assert_eq!(
        (&shown[0]["name"], &shown[0]["message"]),
        (&"user".into(), &"the white one".into())
    );
    let refused = Receipt { status: ReceiptStatus::Refused.code(), ..heard };
    assert_eq!(send_fixed(&mut painter, 2, &refused).len(), 0);
    let text = FixedText::truncated("Is it on the counter?");
    let act = RobotAct {
        prompt: 3,
        presentation: 1,
        kind: ActKind::Ask.into(),
        text,
        ..RobotAct::default()
    };
    assert_eq!(send_fixed(&mut painter, 3, &act)[0]["name"], "robot");
    assert_eq!(send_fixed(&mut painter, 4, &act).len(), 0, "it is repeated until it is superseded");
    let again = RobotAct { presentation: 2, ..act };
    assert_eq!(send_fixed(&mut painter, 5, &again).len(), 1);
}

#[test]
fn sound_is_raw_audio_and_text_is_cdr() {
    let mut painter = painter();
    let mut chunk = AudioChunk { count: 2, taken_ns: 5, ..AudioChunk::default() };
    chunk.samples.0[1] = -1;
    let shown = send_fixed(&mut painter, 9, &chunk);
    assert_eq!((&shown[0]["data"], &shown[0]["sample_rate"]), (&"AAD//w==".into(), &16_000.into()));
    assert_eq!(cdr_string("ab"), [0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0]);
}
