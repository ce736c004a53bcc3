//! Arms of five joints: every posture is found again, and what they cannot take is refused with the least error. The
//! targets and their best answers were computed by other code (`five_joints_so101.json`).

use manipulation::{Chain, Joints};
use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};
use robot_model::Robot;
use serde_json::Value;

use super::file;

/// File and tip, and whether its limits lack velocity and effort, which the strict reader wants.
const ARMS: [(&str, &str); 4] = [
    ("so101/so101.urdf", "gripper_frame_link"),
    ("so100.urdf", "gripper"),
    ("widowx.urdf", "wrist_2_link"),
    ("koch.urdf", "gripper_tcp"),
];

fn described(name: &str) -> Robot {
    let text = std::fs::read_to_string(file(name)).unwrap();
    let whole = |line: &str| match line.contains("<limit") && !line.contains("velocity") {
        true => line.replace("/>", " velocity=\"1\" effort=\"1\"/>"),
        false => line.to_owned(),
    };
    let text: Vec<String> = text.lines().map(whole).collect();
    Robot::parse(&text.join("\n"), None).unwrap_or_else(|faults| panic!("{name}: {faults}"))
}

fn five_numbers(value: &Value) -> Joints {
    let mut q = [0.0; 7];
    value
        .as_array()
        .unwrap()
        .iter()
        .zip(&mut q)
        .for_each(|(from, to)| *to = from.as_f64().unwrap());
    q
}

fn vector(value: &Value) -> Vector3<f64> {
    let q = five_numbers(value);
    Vector3::new(q[0], q[1], q[2])
}

fn apart(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A gripper at a point with this z axis and, as nearly as that lets it, this y axis.
fn pose(at: &Vector3<f64>, z: &Vector3<f64>, y: &Vector3<f64>) -> Isometry3<f64> {
    let y = (y - z * z.dot(y)).normalize();
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[y.cross(z), y, *z]));
    Isometry3::from_parts((*at).into(), UnitQuaternion::from_rotation_matrix(&turn))
}

#[test]
fn five_joints_take_every_posture_again() {
    let seed = 1;
    for (name, tip) in ARMS {
        let description = described(name);
        let chain = Chain::from_description(&description, tip).unwrap();
        let described = description.chain(tip).unwrap();
        let mut random = crate::random::Random::seeded(seed);
        for k in 0..1500 {
            let share = std::array::from_fn(|_| random.unit());
            let q = chain.limits().at(&share);
            let target = chain.forward(&q);
            let off = target.translation.vector - described.forward(&q[..5]).translation.vector;
            assert!(off.norm() < 1e-12, "{name}, seed {seed}: {k}");
            let all = chain.solutions(&target);
            assert!(
                all.iter().any(|own| apart(own, &q) < 1e-4),
                "{name}, seed {seed}: {k} {q:?} {all:?}"
            );
            for own in [all, vec![chain.inverse(&target, Some(&q)).unwrap().q]].concat() {
                let reached = described.forward(&own[..5]);
                let off = (reached.translation.vector - target.translation.vector).norm();
                assert!(
                    off <= 1e-6 && chain.limits().within(&own),
                    "{name}, seed {seed}: {k} {off}"
                );
                assert!(
                    reached.rotation.angle_to(&target.rotation) < 1e-4,
                    "{name}, seed {seed}: {k}"
                );
            }
        }
    }
}

/// Counts of targets by kind: reached, and refused.
#[derive(Default, Debug, PartialEq)]
struct Counts([[usize; 2]; 3]);

#[test]
fn five_joints_reach_what_can_be_reached_and_miss_by_the_least_angle() {
    let text = std::fs::read_to_string(file("five_joints_so101.json")).unwrap();
    let oracle: Value = serde_json::from_str(&text).unwrap();
    let description = described("so101/so101.urdf");
    let chain = Chain::from_description(&description, "gripper_frame_link").unwrap();
    let described = description.chain("gripper_frame_link").unwrap();
    let (mut counts, mut better) = (Counts::default(), 0);
    for target in oracle["targets"].as_array().unwrap() {
        let (id, at) = (&target["id"], vector(&target["xyz"]));
        let is_right = |q: &Joints, off_rad: f64| {
            let reached = described.forward(&q[..5]);
            let z = reached.rotation * Vector3::z();
            (reached.translation.vector - at).norm() <= 1e-6
                && z.angle(&vector(&target["axis"])) <= off_rad
                && chain.limits().within(q)
        };
        let reachable = target["reachable"].as_bool().unwrap();
        let kind = target["kind"].as_str().unwrap();
        let (place, reached) = match kind {
            "position, elevation, roll" => {
                let (elevation, roll) =
                    (target["elevation"].as_f64().unwrap(), target["roll"].as_f64().unwrap());
                let found = chain.reach(at.into(), elevation, roll);
                // A limit of the rounded posture may lie inside by as much.
                let best = five_numbers(&target["best_q"]);
                let has_best = found.iter().any(|q| apart(q, &best) < 1e-3);
                (
                    0,
                    has_best
                        && found.iter().any(|q| is_right(q, 1e-4) && (q[4] - roll).abs() < 1e-9),
                )
            }
            "straight down with yaw" => {
                let down = pose(&at, &vector(&target["axis"]), &vector(&target["jaw_y"]));
                let found = chain.solutions(&down);
                assert_eq!(found.is_empty(), chain.inverse(&down, None).is_err(), "{id}");
                assert!(found.iter().all(|q| is_right(q, 1e-4)), "{id}");
                (1, !found.is_empty())
            }
            "position and any axis" => {
                let axis = vector(&target["axis"]);
                // The roll that the best posture has, so that the axis alone may be in the way.
                let best = described.forward(&five_numbers(&target["best_q"])[..5]);
                let wanted = pose(&at, &axis, &(best.rotation * Vector3::y()));
                let least = target["axis_error_rad"].as_f64().unwrap();
                let (found, q) = match chain.inverse(&wanted, None) {
                    Ok(found) => (0.0, found.q),
                    Err(missed) => {
                        assert!(missed.position_error_m <= 1e-6, "{id}: {missed}");
                        (missed.rotation_error_rad, missed.nearest)
                    }
                };
                assert!(is_right(&q, found + 1e-4), "{id}");
                // The other search may have ended beside the least; what is found is a posture that is so near.
                assert!((found - least).to_degrees() <= 0.1, "{id}: {found} {least} rad");
                better += usize::from((least - found).to_degrees() > 0.1);
                // Within the 0.1 degrees of both searches a target counts as what it is said to be.
                (2, if least.to_degrees() <= 0.1 { reachable } else { found <= 1e-4 })
            }
            _ => continue,
        };
        // The other search may have missed a posture; one that is found was checked above.
        assert!(
            reached == reachable || reached && place == 2,
            "{id} {kind} {}",
            target["axis_error_rad"]
        );
        counts.0[place][usize::from(!reachable)] += 1;
    }
    eprintln!("{better} approaches nearer than those known by more than 0.1 degrees");
    assert!(better <= 15, "{better}");
    assert_eq!(counts, Counts([[300, 0], [73, 227], [11, 239]]));
}

const SO101: &str = "so101/so101.urdf";

/// The jaw of the imported robot is that of the meshes: parallel at 0 rad, where its faces are 15.8 mm apart.
#[test]
fn jaw_opens_as_its_meshes_do() {
    let robot = super::robot(&super::imported(SO101));
    let gripper = robot.arm(robot.limbs()[0]).gripper;
    let jaw = gripper.jaw.unwrap();
    assert!((jaw.opening_m(0.0) - 0.0158).abs() < 3e-4, "{}", jaw.opening_m(0.0));
    // The meshes' innermost points near the tips by other code: 1.9 mm apart closed, 30.3 mm at 0.2 rad.
    for (angle, opening_m) in [(-0.1745, 0.0019), (0.2, 0.0303)] {
        assert!(
            (jaw.opening_m(angle) - opening_m).abs() < 2.5e-3,
            "{angle}: {}",
            jaw.opening_m(angle)
        );
        assert!((jaw.angle_rad(jaw.opening_m(angle)) - angle).abs() < 1e-6);
    }
    assert!(gripper.open_m > 0.055 && gripper.open_m < 0.07, "{gripper:?}");
    assert!((gripper.force_n - 20.0).abs() < 0.1, "{gripper:?}");
    let measured = measured_joints::MeasuredJoints::new(robot.description(), &["left_s0"]);
    let [finger] = measured.fingers() else { panic!("{measured:?}") };
    assert_eq!((finger.name.as_str(), finger.limb), ("gripper", 0));
    let half = 50.0;
    let opening = jaw.opening_m(finger.position(half));
    assert!((opening - gripper.width_m(half)).abs() < 1e-9);
}

/// Straight down first; further out tilted in the plane of the arm; and then refused with the angle that is missing.
#[test]
fn five_joints_grasp_from_above_then_tilted_and_then_not() {
    let robot = super::robot(&super::imported(SO101));
    let (blocks, plan) = super::blocks(&super::imported(SO101));
    let chain = &robot.arm(robot.limbs()[0]).chain;
    let tilt_deg = |x: f64| {
        let block = manipulation::ObjectPose { xyz_m: [x, 0.0, blocks[0].xyz_m[2]], ..blocks[0] };
        let planned = manipulation::plan_pick(&robot, &block, None, &robot.neutral(), &[], &plan);
        planned.map(|plan| {
            let (closing_s, _) = plan.span_s(manipulation::Phase::Close).unwrap();
            let z = (chain.forward(&plan.at(closing_s).q).rotation * Vector3::z()).z;
            z.clamp(-1.0, 1.0).acos().to_degrees()
        })
    };
    assert!(tilt_deg(0.2).unwrap() > 179.9);
    let tilted = 180.0 - tilt_deg(0.33).unwrap();
    assert!((14.0..46.0).contains(&tilted), "{tilted}");
    let error = tilt_deg(0.44).unwrap_err().to_string();
    assert!(error.contains("degrees off at best"), "{error}");
}
