use proptest::prelude::*;
use scene::{ObjectId, Scene};
use vocabulary::Table;
use vocabulary::time::{Span, Time};

use crate::{Change, Detection, Frame, Hiding, Look, Refusal, Settings, Sighting, Tracker};

mod beliefs;

const CAMERA: &str = "camera";

fn file() -> Scene {
    Scene::from_toml("bowls", include_str!("../../../config/scenes/bowls.toml")).unwrap()
}

fn settings() -> Settings {
    Settings {
        appear: 3,
        moved_m: 0.02,
        gate_m: 0.1,
        vanish: Span::from_ms(2_000),
        age_max: Span::from_ms(1_000),
        hidden_m: 0.25,
        frames: vec![Frame { name: "lens".to_owned(), xyz: [1.0, 0.0, 0.5], rpy: [0.0, 0.0, 0.5] }],
    }
}

fn seen(class: &str, x: f64, y: f64) -> Detection {
    Detection { classes: vec![(class.to_owned(), 1.0)], xyz: [x, y, -0.1], ..Detection::default() }
}

/// A table in front of a camera that looks ten times a second.
struct Scenery {
    file: Scene,
    tracker: Tracker,
    now: Time,
    hiding: Hiding,
}

impl Scenery {
    fn new() -> Self {
        let file = file();
        let tracker = Tracker::new(settings(), &Table::default(), &file, Time(0));
        Self { file, tracker, now: Time(10_000_000_000), hiding: Hiding::default() }
    }

    fn look(&mut self, seen: &[Detection]) {
        self.now = self.now + Span::from_ms(100);
        let look = Look { at_ns: self.now.ns(), whole: true, seen: seen.to_vec() };
        self.report(CAMERA, Change::Look(look)).unwrap();
    }

    fn looks(&mut self, times: usize, seen: &[Detection]) {
        (0..times).for_each(|_| self.look(seen));
    }

    fn report(&mut self, source: &str, change: Change) -> Result<Option<ObjectId>, Refusal> {
        let (source, frame) = (source.to_owned(), "base".to_owned());
        let sighting = Sighting { key: 1, source, frame, change };
        self.tracker.take(&sighting, &self.file, &self.hiding, self.now)
    }

    fn numbers(&self) -> Vec<u16> {
        self.tracker.objects().iter().map(|object| object.number.0).collect()
    }
}

#[test]
fn an_object_appears_after_three_detections_and_numbers_start_after_the_files() {
    let mut it = Scenery::new();
    it.looks(2, &[seen("white", 0.7, 0.1)]);
    assert_eq!(it.numbers(), [0_u16; 0]);
    it.look(&[seen("white", 0.7, 0.1)]);
    assert_eq!(it.numbers(), [6]);
    assert_eq!(it.tracker.objects()[0].name, "white-6");
}

#[test]
fn an_object_vanishes_after_it_was_looked_for_and_its_number_is_not_given_again() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    it.looks(19, &[]);
    assert_eq!(it.numbers(), [6]);
    it.looks(2, &[]);
    assert_eq!(it.numbers(), [0_u16; 0]);
    it.tracker.forget_gone();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    assert_eq!(it.numbers(), [7]);
}

#[test]
fn what_the_arm_hides_is_not_missed_and_neither_is_what_no_look_could_show() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    it.hiding.grippers = vec![[0.75, 0.2, 0.3]];
    it.looks(50, &[]);
    assert_eq!(it.numbers(), [6]);
    it.hiding.grippers.clear();
    // Looks of another camera, and looks that show a part.
    for _ in 0..50 {
        it.now = it.now + Span::from_ms(100);
        let look = |whole| Change::Look(Look { at_ns: it.now.ns(), whole, seen: Vec::new() });
        let (other, part) = (look(true), look(false));
        it.report("other", other).unwrap();
        it.report(CAMERA, part).unwrap();
    }
    assert_eq!(it.numbers(), [6]);
}

/// Looks that were taken while the policy restarted arrive after it.
#[test]
fn an_object_that_was_moved_during_a_restart_keeps_its_number() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    let (objects, next) = (it.tracker.objects(), it.tracker.next());
    let table = Table { next, objects, ..Table::default() };
    let restart = it.now + Span::from_ms(500);
    it.tracker = Tracker::new(settings(), &table, &it.file, restart);
    it.looks(3, &[seen("white", 0.5, -0.3)]);
    assert!(it.now < restart);
    assert_eq!(it.numbers(), [6]);
    assert_eq!(it.tracker.objects()[0].xyz, [0.5, -0.3, -0.1]);
}

#[test]
fn a_small_motion_is_estimated_and_not_reported_and_a_larger_one_is() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    it.looks(30, &[seen("white", 0.715, 0.1)]);
    assert_eq!(it.tracker.objects()[0].xyz, [0.7, 0.1, -0.1]);
    let live = it.tracker.live(ObjectId(6)).unwrap();
    assert!((live.place[0] - 0.715).abs() < 0.003, "{live:?}");
    it.looks(2, &[seen("white", 0.76, 0.1)]);
    assert_eq!(it.tracker.objects()[0].xyz, [0.7, 0.1, -0.1], "two may be wrong");
    it.look(&[seen("white", 0.76, 0.1)]);
    assert!((it.tracker.objects()[0].xyz[0] - 0.76).abs() < 1e-9);
    assert_eq!(it.numbers(), [6]);
}

/// Looks at an object that is as far away as a detection may err to both sides of it.
#[test]
fn an_object_that_was_moved_as_far_as_the_gate_keeps_its_number() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    for y in [0.203, 0.198, 0.202, 0.201] {
        it.look(&[seen("white", 0.7, y)]);
    }
    assert_eq!(it.numbers(), [6]);
    assert!((it.tracker.objects()[0].xyz[1] - 0.2).abs() < 0.005, "{:?}", it.tracker.objects());
    // The object's old place is not a candidate for the next motion, whoever ended the first.
    it.looks(1, &[seen("white", 0.7, 0.1)]);
    for y in [0.098, 0.102, 0.098, 0.2, 0.303, 0.298, 0.302, 0.301] {
        it.look(&[seen("white", 0.7, y)]);
        assert_eq!(it.numbers(), [6]);
    }
}

#[test]
fn an_object_that_was_seen_beside_another_one_is_not_it() {
    // One slides while another one is put down.
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    for y in [0.13, 0.16, 0.19] {
        it.look(&[seen("white", 0.7, y), seen("white", 0.7, -0.3)]);
    }
    it.look(&[seen("white", 0.7, -0.3)]);
    it.looks(3, &[seen("white", 0.7, 0.19), seen("white", 0.7, -0.3)]);
    assert_eq!(it.numbers(), [6, 7]);
    assert!((it.tracker.objects()[0].xyz[1] - 0.19).abs() < 0.01, "{:?}", it.tracker.objects());
    // The slid one is missed in the look that shows the new one.
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    for y in [0.13, 0.16] {
        it.look(&[seen("white", 0.7, y), seen("white", 0.7, -0.3)]);
    }
    it.look(&[seen("white", 0.7, -0.3)]);
    assert_eq!(it.numbers(), [6, 7]);
    // One of two is moved while the other one is pushed.
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1), seen("white", 0.7, -0.2)]);
    for y in [0.13, 0.16, 0.19] {
        it.look(&[seen("white", 0.7, y), seen("white", 0.4, -0.6)]);
    }
    assert_eq!(it.numbers(), [6, 7]);
    assert!((it.tracker.objects()[1].xyz[1] + 0.6).abs() < 1e-9, "{:?}", it.tracker.objects());
}

#[test]
fn two_of_a_class_side_by_side_are_two() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    it.looks(3, &[seen("white", 0.7, 0.1), seen("white", 0.7, 0.118)]);
    assert_eq!(it.numbers(), [6, 7]);
}

proptest! {
    /// However it is moved, and its looks err, the only one of its class keeps its number.
    #[test]
    fn the_only_one_of_its_class_keeps_its_number_wherever_it_is_moved_to(
        moves in prop::collection::vec((0.03_f64..0.3, 0.0_f64..std::f64::consts::TAU), 1..4),
        errors in prop::collection::vec(-0.006_f64..0.006, 200),
    ) {
        let mut it = Scenery::new();
        let (mut x, mut y) = (0.7, 0.1);
        let mut errors = errors.into_iter().cycle();
        let mut error = || errors.next().unwrap();
        it.looks(3, &[seen("white", x, y)]);
        for (far, angle) in moves {
            (x, y) = (x + far * angle.cos(), y + far * angle.sin());
            for _ in 0..8 {
                let look = seen("white", x + error(), y + error());
                it.look(&[look]);
                prop_assert_eq!(it.numbers(), [6]);
            }
            let [known_x, known_y, _] = it.tracker.objects()[0].xyz;
            prop_assert!((known_x - x).hypot(known_y - y) < 0.03, "{:?}", it.tracker.objects());
        }
    }
}

#[test]
fn the_only_one_of_its_class_keeps_its_number_over_any_distance_and_one_of_two_does_not() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1), seen("metal", 0.7, -0.2)]);
    it.looks(3, &[seen("white", 0.7, 0.4), seen("metal", 0.7, -0.2)]);
    assert_eq!(it.numbers(), [6, 7]);
    assert!((it.tracker.objects()[0].xyz[1] - 0.4).abs() < 1e-9);
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1), seen("white", 0.7, -0.2)]);
    it.looks(30, &[seen("white", 0.7, 0.5), seen("white", 0.4, 0.0)]);
    assert_eq!(it.numbers(), [8, 9], "neither is known to be either");
}

#[test]
fn a_source_that_follows_objects_names_them() {
    let mut it = Scenery::new();
    let marker = |x| Detection { track: "7".to_owned(), ..seen("white", x, 0.1) };
    it.looks(3, &[marker(0.7)]);
    it.looks(3, &[marker(0.3)]);
    assert_eq!(it.numbers(), [6]);
    assert!((it.tracker.objects()[0].xyz[0] - 0.3).abs() < 1e-9);
}

#[test]
fn old_looks_unknown_frames_and_wrong_numbers_are_refused() {
    let mut it = Scenery::new();
    let at = it.now - Span::from_ms(1_001);
    let look = |seen, at_ns| Change::Look(Look { at_ns, whole: true, seen });
    let refused = it.report(CAMERA, look(vec![], at.ns())).unwrap_err();
    assert!(matches!(refused, Refusal::Old(_)), "{refused}");
    let wrong = Detection { yaw: f64::NAN, ..seen("white", 0.7, 0.1) };
    for n in 0..33 {
        it.now = it.now + Span::from_ms(100);
        let all = [vec![wrong.clone()], vec![seen("white", 0.7, 0.1); usize::from(n < 3)]].concat();
        assert_eq!(it.report(CAMERA, look(all, it.now.ns())), Err(Refusal::Number));
    }
    assert_eq!(it.numbers(), [6], "the other one counts, and such a look misses none");
    let (source, frame) = (CAMERA.to_owned(), "tool".to_owned());
    let sighting = Sighting { key: 1, source, frame, change: look(vec![], 0) };
    let refused = it.tracker.take(&sighting, &it.file, &it.hiding, it.now).unwrap_err();
    assert_eq!(refused, Refusal::Frame("tool".to_owned()));
    assert!(refused.to_string().contains("perception.frames"));
}

#[test]
fn places_in_another_frame_are_converted() {
    let mut it = Scenery::new();
    for _ in 0..3 {
        it.now = it.now + Span::from_ms(100);
        let look = Look { at_ns: 0, whole: true, seen: vec![seen("white", 1.0, 0.0)] };
        let (source, frame) = (CAMERA.to_owned(), "lens".to_owned());
        let sighting = Sighting { key: 1, source, frame, change: Change::Look(look) };
        it.tracker.take(&sighting, &it.file, &it.hiding, it.now).unwrap();
    }
    let object = &it.tracker.objects()[0];
    let expected = [1.0 + 0.5_f64.cos(), 0.5_f64.sin(), 0.4];
    assert!(object.xyz.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{object:?}");
    assert!((object.yaw - 0.5).abs() < 1e-9);
}

#[test]
fn changes_by_hand_count_at_once_and_are_not_missed_before_they_are_seen() {
    let mut it = Scenery::new();
    let number = it.report("hand", Change::Add(seen("metal", 0.6, 0.0))).unwrap();
    assert_eq!((number, it.numbers()), (Some(ObjectId(6)), vec![6]));
    it.looks(50, &[]);
    assert_eq!(it.numbers(), [6]);
    let to = Change::Move { object: "metal-6".to_owned(), xyz: [0.6, 0.01, -0.1], yaw: 0.0 };
    it.report("hand", to).unwrap();
    assert_eq!(it.tracker.objects()[0].xyz, [0.6, 0.01, -0.1]);
    it.report("hand", Change::Remove { object: "6".to_owned() }).unwrap();
    assert_eq!(it.numbers(), [0_u16; 0]);
    let gone = it.report("hand", Change::Remove { object: "6".to_owned() });
    assert_eq!(gone, Err(Refusal::NoObject("6".to_owned())));
    let teapot = it.report("hand", Change::Add(seen("teapot", 0.6, 0.0)));
    let known = "white, white2, white3, metal, metal2, clear".to_owned();
    assert_eq!(teapot, Err(Refusal::NoClass("teapot".to_owned(), known)));
    let mut of = |name: &str, value: &str| {
        let attributes = vec![(name.to_owned(), vec![(value.to_owned(), 1.0)])];
        let detection = Detection { attributes, ..seen("metal", 0.6, 0.0) };
        it.report("hand", Change::Add(detection)).unwrap_err().to_string()
    };
    let value = "unknown value `metal` of color; help: write white, metallic, clear";
    assert_eq!(of("color", "metal"), value);
    assert!(of("colour", "white").contains("unknown attribute `colour`"));
}

/// The camera sees it in the gripper: that is neither its own motion nor another object.
#[test]
fn what_is_carried_is_neither_moved_nor_doubled() {
    let mut it = Scenery::new();
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    let before = it.tracker.objects();
    it.hiding.handled = Some(ObjectId(6));
    for n in 0..30 {
        let y = 0.1 - 0.02 * f64::from(n);
        it.hiding.grippers = vec![[0.7, y, 0.1]];
        it.look(&[seen("white", 0.7, y)]);
    }
    assert_eq!(it.tracker.objects(), before);
    it.tracker.hand_over(ObjectId(6), true);
    it.hiding = Hiding::default();
    it.looks(50, &[]);
    assert!(it.tracker.objects()[0].taken);
    it.looks(3, &[seen("white", 0.7, 0.1)]);
    assert_eq!(it.numbers(), [6, 7], "what stands there now is another one");
}

#[derive(Clone, Debug)]
enum Step {
    Look(Vec<(u8, f64, f64)>),
    Add(u8),
    Remove(u16),
    Forget,
    Restart,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let detection = (0_u8..3, 0.3..1.0, -0.6..0.6);
    let step = prop_oneof![
        12 => prop::collection::vec(detection, 0..6).prop_map(Step::Look),
        1 => (0_u8..3).prop_map(Step::Add),
        1 => (0_u16..40).prop_map(Step::Remove),
        1 => Just(Step::Forget),
        1 => Just(Step::Restart),
    ];
    prop::collection::vec(step, 0..120)
}

proptest! {
    /// Whatever is seen: numbers are unique, rise in order of appearance, are never given again,
    /// also after a restart from the table, and no place is invented.
    #[test]
    fn numbers_are_never_given_again(steps in steps()) {
        const CLASSES: [&str; 3] = ["white", "metal", "clear"];
        let mut it = Scenery::new();
        let mut ended: Vec<u16> = Vec::new();
        let mut known: Vec<u16> = Vec::new();
        for step in steps {
            match step {
                Step::Look(all) => {
                    let all: Vec<Detection> =
                        all.iter().map(|(c, x, y)| seen(CLASSES[usize::from(*c)], *x, *y)).collect();
                    it.look(&all);
                }
                Step::Add(class) => {
                    let _ = it.report("hand", Change::Add(seen(CLASSES[usize::from(class)], 0.5, 0.0)));
                }
                Step::Remove(number) => {
                    let _ = it.report("hand", Change::Remove { object: number.to_string() });
                }
                Step::Forget => it.tracker.forget_gone(),
                Step::Restart => {
                    let (objects, next) = (it.tracker.objects(), it.tracker.next());
                    let table = Table { next, objects, ..Table::default() };
                    it.tracker = Tracker::new(settings(), &table, &it.file, it.now);
                }
            }
            let now = it.numbers();
            prop_assert!(now.windows(2).all(|pair| pair[0] < pair[1]), "{now:?}");
            prop_assert!(now.iter().all(|n| *n >= 6 && *n < it.tracker.next().0));
            let fresh: Vec<u16> = now.iter().copied().filter(|n| !known.contains(n)).collect();
            prop_assert!(fresh.iter().all(|n| !ended.contains(n)), "{fresh:?} again");
            let back: Vec<u16> = known.iter().copied().filter(|n| !now.contains(n)).collect();
            ended.extend(back.iter().filter(|n| it.tracker.live(ObjectId(**n)).is_none()));
            for object in it.tracker.objects() {
                prop_assert!((0.3..=1.0).contains(&object.xyz[0]) && object.xyz[1].abs() <= 0.6);
                let total: f64 = object.classes.iter().map(|(_, p)| p).sum();
                prop_assert!(total <= 1.0 + 1e-9);
            }
            known = now;
        }
    }
}
