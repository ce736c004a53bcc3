use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;

const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn label(id: &str, object: &str) -> Label {
    Label { id: id.to_owned(), object: object.to_owned(), xyz: [0.0; 3], rpy: [0.0; 3] }
}

fn pose(position: [f64; 3]) -> Pose {
    Pose { position, orientation: UPRIGHT }
}

fn hypothesis(id: &str, score: f64) -> Hypothesis {
    let pose = pose([0.7, 0.1, -0.1]);
    Hypothesis { id: id.to_owned(), score, pose, covariance: [0.0; 36] }
}

fn reported(hypotheses: Vec<Hypothesis>) -> Reported {
    Reported { frame: "base".to_owned(), hypotheses, ..Reported::default() }
}

fn detector(labels: &[Label], frames: &[Frame]) -> Detector {
    let bowls = include_str!("../../../../config/scenes/bowls.toml");
    let scene = Scene::from_toml("bowls", bowls).unwrap();
    Detector::new("/detections", labels, Some(scene), frames)
}

fn seen(sighting: &Sighting) -> &[Detection] {
    match &sighting.change {
        Change::Look(look) => &look.seen,
        other => panic!("expected a look, found {other:?}"),
    }
}

/// The only detection of a report.
fn only(detector: &mut Detector, reported: Reported) -> Detection {
    let sighting = detector.look(1, 5, &[reported]);
    assert_eq!((sighting.frame.as_str(), seen(&sighting).len()), ("base", 1), "{sighting:?}");
    seen(&sighting)[0].clone()
}

#[test]
fn identifiers_become_names_of_the_scene_and_unknown_ones_are_reported_once() {
    let mut detector =
        detector(&[label("3", "white"), label("4", "white"), label("5", "clear")], &[]);
    let all = [("3", 0.25), ("4", 0.5), ("metal", 0.2), ("cup", 0.7), ("5", 0.0), ("5", f64::NAN)];
    let hypotheses: Vec<_> = all.iter().map(|(id, score)| hypothesis(id, *score)).collect();
    let found = only(&mut detector, reported(hypotheses.clone()));
    assert_eq!(found.classes, [("white".to_owned(), 0.75), ("metal".to_owned(), 0.2)]);
    only(&mut detector, reported(hypotheses));
    assert_eq!(detector.take_unused(), [Unused::Unknown("cup".to_owned())]);
    assert_eq!(detector.counts(), UnusedCounts { unknown: 2, poses: 0 });
    let likeliest = vec![hypothesis("cup", 0.6), hypothesis("3", 0.3), hypothesis("4", 0.2)];
    for unknown in [vec![hypothesis("cup", 0.9)], likeliest] {
        let unknown = detector.look(1, 5, &[reported(unknown)]);
        assert!(seen(&unknown).is_empty() && detector.take_unused().is_empty());
    }
    let over = only(&mut detector, reported(vec![hypothesis("3", 7.0)]));
    assert_eq!(over.classes, [("white".to_owned(), 1.0)]);
}

#[test]
fn memory_of_unknown_identifiers_is_bounded() {
    let mut detector = detector(&[], &[]);
    let many: Vec<_> = (0..1_000).map(|n| hypothesis(&n.to_string(), 0.5)).collect();
    detector.look(1, 5, &[reported(many)]);
    assert_eq!(detector.take_unused().len(), UNKNOWN_MAX);
    assert_eq!(detector.counts().unknown, 1_000);
}

#[test]
fn pose_is_that_of_the_likeliest_hypothesis_or_else_the_stated_center() {
    let mut detector = detector(&[], &[]);
    let mut likely = hypothesis("metal", 0.6);
    likely.pose = pose([0.5, 0.0, 0.0]);
    let found = only(&mut detector, reported(vec![hypothesis("white", 0.4), likely.clone()]));
    assert_eq!(found.xyz, [0.5, 0.0, 0.0]);
    likely.pose = Pose::default();
    let mut of_box = reported(vec![likely.clone()]);
    of_box.center = Some(pose([0.6, 0.0, 0.0]));
    assert_eq!(only(&mut detector, of_box).xyz, [0.6, 0.0, 0.0]);
    for unusable in [[0.0; 3], [f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]] {
        likely.pose = pose(unusable);
        let both = [reported(vec![likely.clone()]), reported(vec![hypothesis("white", 1.0)])];
        let sighting = detector.look(1, 5, &both);
        assert_eq!(seen(&sighting).len(), 1, "{unusable:?}: the other one counts");
    }
    assert_eq!(detector.counts().poses, 3);
    assert_eq!(detector.take_unused(), [Unused::Pose("metal".to_owned())]);
}

#[test]
fn covariance_of_zero_is_not_stated_and_neither_are_negative_ones() {
    let mut detector = detector(&[], &[]);
    let mut with = |covariance: [f64; 36]| {
        let hypothesis = Hypothesis { covariance, ..hypothesis("white", 1.0) };
        only(&mut detector, reported(vec![hypothesis])).variances
    };
    assert_eq!(with([0.0; 36]), [0.0; 4]);
    assert_eq!(with([-1.0; 36]), [0.0; 4]);
    assert_eq!(with([f64::NAN; 36]), [0.0; 4]);
    let diagonal = std::array::from_fn(|n| if n % 7 == 0 { n as f64 / 7.0 + 1.0 } else { 0.0 });
    assert_eq!(with(diagonal), [1.0, 2.0, 3.0, 6.0]);
}

#[test]
fn message_in_an_unknown_frame_becomes_a_look_that_is_refused() {
    let mut detector = detector(&[], &[]);
    let elsewhere =
        Reported { frame: "/lens".to_owned(), ..reported(vec![hypothesis("white", 1.0)]) };
    let sighting = detector.look(1, 5, &[reported(vec![hypothesis("white", 1.0)]), elsewhere]);
    assert_eq!((sighting.frame.as_str(), seen(&sighting)), ("lens", &[][..]));
    let empty = detector.look(1, 5, &[]);
    assert_eq!(empty.frame, "base", "nothing seen is nothing seen in any frame");
}

#[test]
fn markers_are_sources_of_their_own_and_other_transforms_are_ignored() {
    let mut detector = Detector::new("/tf", &[label("tag36h11:7", "white")], None, &[]);
    let marker = |id: &str| Reported::marker("base", id, pose([0.5, 0.0, 0.1]), [0.0; 36]);
    assert_eq!(detector.marker(1, 5, &marker("left_wrist")), None);
    assert_eq!(detector.counts(), UnusedCounts::default());
    let sighting = detector.marker(1, 5, &marker("tag36h11:7")).unwrap();
    assert_eq!(sighting.source, "/tf tag36h11:7");
    assert_eq!(seen(&sighting)[0].track, "tag36h11:7");
    assert!(matches!(sighting.change, Change::Look(Look { whole: false, at_ns: 5, .. })));
}

fn isometry(xyz: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    Isometry3::from_parts(Translation3::from(xyz), rotation)
}

proptest! {
    #[test]
    fn poses_in_any_frame_are_those_that_nalgebra_computes(
        frame in prop::array::uniform6(-1.5..1.5_f64),
        marker in prop::array::uniform6(-1.5..1.5_f64),
        offset in prop::array::uniform6(-1.5..1.5_f64),
        length in 0.1..3.0_f64,
        spread in prop::array::uniform9(-0.1..0.1_f64),
    ) {
        let split = |n: [f64; 6]| ([n[0], n[1], n[2]], [n[3], n[4], n[5]]);
        let [(fx, fr), (mx, mr), (ox, or)] = [frame, marker, offset].map(split);
        let in_frame = isometry(mx, mr);
        let expected = isometry(fx, fr) * in_frame * isometry(ox, or);
        let axis = expected.rotation * Vector3::x();
        // A rotation of the x axis onto the vertical has no yaw.
        prop_assume!(axis.xy().norm() > 0.05);

        let spread = Matrix3::from_row_slice(&spread);
        let spread = spread * spread.transpose();
        let covariance = std::array::from_fn(|n| match (n / 6, n % 6) {
            (i @ 0..3, j @ 0..3) => spread[(i, j)],
            (i @ 3..6, j @ 3..6) => 2.0 * spread[(i - 3, j - 3)],
            _ => 7.0,
        });
        let to_base = isometry(fx, fr).rotation.to_rotation_matrix().into_inner();
        let turned = to_base * spread * to_base.transpose();

        let Quaternion { coords } = in_frame.rotation.into_inner();
        let pose = Pose { position: mx, orientation: (coords * length).into() };
        let lens = Frame { name: "lens".to_owned(), xyz: fx, rpy: fr };
        let own = Label { xyz: ox, rpy: or, ..label("7", "white") };
        let found = only(
            &mut detector(&[own], &[lens]),
            Reported::marker("lens", "7", pose, covariance),
        );
        for i in 0..3 {
            prop_assert!((found.xyz[i] - expected.translation.vector[i]).abs() < 1e-9);
            prop_assert!((found.variances[i] - turned[(i, i)]).abs() < 1e-12);
        }
        prop_assert!((found.variances[3] - 2.0 * turned[(2, 2)]).abs() < 1e-12);
        let off = found.yaw - axis.y.atan2(axis.x);
        prop_assert!(off.sin().abs() < 1e-9 && off.cos() > 0.0);
    }
}
