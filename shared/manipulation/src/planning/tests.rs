use nalgebra::{Isometry3, Translation3, Vector3};

use super::*;
use crate::collision::Clearance;
use crate::collision::Cuboid;
use crate::gripper::{STROKE_M, attached_pose};
use crate::kinematics::limb::{Arms, Joints, Limb};
use crate::planning::grasp::ObjectPose;
use crate::samples::{Random, arm, full, named, neutral, robot};
use crate::trajectory::Timeline;

const SETTINGS: PlanSettings = PlanSettings {
    speed_ratio: 0.6,
    hover_m: 0.15,
    hand_over_xyz_m: [0.80, 0.35, 0.15],
    table_z_m: -0.155,
    open_width_m: STROKE_M,
    standoff_m: 0.25,
    point_s: 0.5,
    margin_m: 0.01,
};

/// Six bowls: one low on the right, three on the table, two on a shelf on the left.
fn bowls() -> Vec<ObjectPose> {
    [
        ([0.65, -0.45, -0.175], 0.12, 0.05),
        ([0.64, 0.0, -0.13], 0.12, 0.05),
        ([0.64, 0.57, 0.135], 0.18, 0.07),
        ([0.70, 0.38, 0.125], 0.12, 0.05),
        ([0.70, -0.2, -0.12], 0.18, 0.07),
        ([0.70, 0.2, -0.12], 0.18, 0.07),
    ]
    .map(|(xyz_m, across, high)| ObjectPose {
        xyz_m,
        yaw_rad: 0.0,
        size_m: [across, across, high],
        grasp_width_m: 0.006,
    })
    .into()
}

fn marker() -> ObjectPose {
    ObjectPose {
        xyz_m: [0.68, -0.15, -0.148],
        yaw_rad: 0.3,
        size_m: [0.14, 0.014, 0.014],
        grasp_width_m: 0.014,
    }
}

fn all_but(objects: &[ObjectPose], i: usize) -> Vec<Cuboid> {
    let others = objects.iter().enumerate().filter(|(j, _)| *j != i);
    others.map(|(_, object)| object.cuboid()).collect()
}

/// Every limit at every 5 ms, continuity across stages, and clearance by the two-arm check that
/// planning does not use.
fn assert_sound<P: Copy + PartialEq + std::fmt::Debug>(timeline: &Timeline<P>, others: &[Cuboid]) {
    let limits = full().at_speed_ratio(SETTINGS.speed_ratio);
    let limb = timeline.limb();
    let steps = (timeline.duration_s() / 0.005).ceil() as usize;
    let mut before = timeline.at(0.0);
    for k in 0..=steps {
        let now = timeline.at(k as f64 * 0.005);
        assert!(full().position.within(&now.q));
        for j in 0..7 {
            assert!(now.qd[j].abs() <= limits.velocity[j] * (1.0 + 1e-9), "{now:?}");
            let change = (now.qd[j] - before.qd[j]).abs();
            assert!(change <= limits.acceleration[j] * 0.005 + 1e-6, "{before:?} {now:?}");
            assert!((now.q[j] - before.q[j]).abs() <= limits.velocity[j] * 0.005 + 1e-9);
        }
        assert!((0.0..=STROKE_M).contains(&now.width_m));
        if k % 4 == 0 {
            let mut arms = robot().neutral();
            *arms.of_mut(limb) = now.q;
            let clearance = Clearance::of(robot(), &arms.left, &arms.right, others);
            assert!(clearance.robot().distance_m > 0.008, "{now:?} {clearance:?}");
            let around = match limb {
                Limb::Left => clearance.left_surroundings,
                Limb::Right => clearance.right_surroundings,
            };
            assert!(others.is_empty() || around.distance_m > -1e-4, "{now:?} {around:?}");
        }
        before = now;
    }
    assert_eq!(before.q, timeline.at(1e9).q);
    assert!(before.qd.iter().all(|v| v.abs() < 1e-6));
}

#[test]
fn every_bowl_is_fetched() {
    let bowls = bowls();
    for (i, bowl) in bowls.iter().enumerate() {
        let others = all_but(&bowls, i);
        let plan = plan_pick(robot(), bowl, None, &robot().neutral(), &others, &SETTINGS).unwrap();
        assert_sound(&plan.timeline, &others);
        assert_fetches(&plan, bowl);
        assert!(plan.duration_s() < 16.0, "bowl {i} takes {}", plan.duration_s());
    }
}

/// Links that make up the elbow and the forearm up to the wrist.
const ELBOW: [&str; 3] = ["lower_elbow", "upper_forearm", "lower_forearm"];

/// Heights of those links by the description's own forward kinematics, metres.
fn link_heights(limb: Limb, q: &Joints) -> [f64; 3] {
    let names = &robot().arm(limb).joint_names;
    let description = robot().description();
    let poses = description
        .poses(|joint| names.iter().position(|name| *name == joint.name).map_or(0.0, |i| q[i]));
    ELBOW
        .map(|link| poses[description.link_index(&format!("{limb}_{link}")).unwrap()].translation.z)
}

#[test]
fn the_elbow_stays_above_the_table() {
    let bowls = bowls();
    let all: Vec<Cuboid> = bowls.iter().map(ObjectPose::cuboid).collect();
    for (i, bowl) in bowls.iter().enumerate() {
        let others = all_but(&bowls, i);
        let neutral = robot().neutral();
        let pick = plan_pick(robot(), bowl, None, &neutral, &others, &SETTINGS).unwrap();
        let point = plan_point(robot(), bowl.xyz_m, None, &neutral, &all, &SETTINGS).unwrap();
        let lowest = |limb, at: &dyn Fn(f64) -> Joints, duration_s: f64| {
            let steps = (duration_s / 0.02).ceil() as usize;
            (0..=steps)
                .flat_map(|k| link_heights(limb, &at(k as f64 * 0.02)))
                .fold(f64::INFINITY, f64::min)
        };
        // The joints' own axes; the housings reach 8 cm round them.
        let picking = lowest(pick.limb(), &|t| pick.at(t).q, pick.duration_s());
        let pointing = lowest(point.limb(), &|t| point.timeline.at(t).q, point.duration_s());
        for height in [picking, pointing] {
            assert!(height > SETTINGS.table_z_m + 0.15, "bowl {i}: {height}");
        }
    }
}

/// The gripper is at the grasp when it closes, goes straight down before and up after, and lets go
/// where the person waits.
fn assert_fetches(plan: &PickPlan, object: &ObjectPose) {
    let phases: Vec<PickPhase> = plan.timeline.stages().iter().map(|stage| stage.phase).collect();
    let [approach, close, lift, hand_over, release, home] = phases[..] else {
        panic!("{phases:?}")
    };
    assert_eq!(approach, PickPhase::Approach);
    assert_eq!(home, PickPhase::Return);
    let limb = plan.limb();
    let gripper = |t: f64| arm(limb).chain.forward(&plan.at(t).q);
    let span = |phase| plan.timeline.span_s(phase).unwrap();
    let grasp = plan.grasp.unwrap();

    let closing = span(close);
    let at = gripper(closing.0);
    assert!((at.translation.vector - grasp.gripper.translation.vector).norm() < 1e-5);
    assert!((plan.at(closing.0).width_m - STROKE_M).abs() < 1e-12);
    assert!((plan.at(closing.1 - 1e-9).width_m - object.grasp_width_m).abs() < 1e-6);
    let held = attached_pose(&at, &plan.object_in_gripper).translation.vector;
    assert!((held - Vector3::from(object.xyz_m)).norm() < 1e-5);

    // From the grasp outwards in time, both ways: straight until 10 cm above it.
    let lifted = span(lift);
    for (start, step) in [(closing.0, -0.01), (lifted.0, 0.01)] {
        let mut t = start;
        loop {
            let from_grasp = gripper(t).translation.vector - grasp.gripper.translation.vector;
            if from_grasp.z > 0.10 {
                break;
            }
            assert!(from_grasp.xy().norm() < 1e-3, "{from_grasp:?} at {t}");
            assert!((0.0..lifted.1).contains(&t), "never rose");
            t += step;
        }
    }

    let place = SETTINGS.hand_over_xyz_m;
    let let_go = gripper(span(release).0).translation.vector;
    let expected = Vector3::new(place[0], limb.side() * place[1], place[2]);
    assert!((let_go - expected).norm() < 1e-5, "{let_go:?}");
    let tilt = gripper(span(release).0).rotation * Vector3::z() + Vector3::z();
    assert!(tilt.norm() < 1e-5, "the bowl is handed over upright");
    assert!(span(hand_over).1 == span(release).0);
    assert_eq!(plan.at(1e9).q, neutral());
    assert!((plan.at(1e9).width_m - STROKE_M).abs() < 1e-12);
    assert!(PickPlan::carries(lift) && PickPlan::carries(hand_over));
    assert!(!PickPlan::carries(approach) && !PickPlan::carries(home));
}

#[test]
fn lifting_flows_into_the_hand_over() {
    let plan = plan_pick(robot(), &marker(), None, &robot().neutral(), &[], &SETTINGS).unwrap();
    let (_, end) = plan.timeline.span_s(PickPhase::Lift).unwrap();
    assert!(plan.at(end).qd.iter().any(|v| v.abs() > 0.02), "no stop where none is needed");
    assert_fetches(&plan, &marker());
}

#[test]
fn the_forced_limb_is_used_and_the_plan_repeats() {
    for limb in Limb::BOTH {
        let plan =
            plan_pick(robot(), &marker(), Some(limb), &robot().neutral(), &[], &SETTINGS).unwrap();
        assert_eq!(plan.limb(), limb);
        let again =
            plan_pick(robot(), &marker(), Some(limb), &robot().neutral(), &[], &SETTINGS).unwrap();
        assert_eq!(plan, again);
    }
}

#[test]
fn a_pick_may_start_anywhere() {
    let seed = 71;
    let mut random = Random::seeded(seed);
    let mut planned = 0;
    while planned < 3 {
        let mut arms = robot().neutral();
        *arms.of_mut(Limb::Right) = random.posture();
        let clear = Clearance::of(
            robot(),
            &arms.left,
            &arms.right,
            &[Cuboid::aligned([0.95, 0.0, -0.4], [1.1, 2.4, 0.5])],
        );
        if clear.robot().distance_m < 0.03 || clear.right_surroundings.distance_m < 0.01 {
            continue;
        }
        let plan = plan_pick(robot(), &marker(), Some(Limb::Right), &arms, &[], &SETTINGS)
            .unwrap_or_else(|error| panic!("seed {seed}: {arms:?}: {error}"));
        assert_eq!(plan.at(0.0).q, arms.right);
        assert_sound(&plan.timeline, &[]);
        planned += 1;
    }
}

#[test]
fn delivery_resumes_from_the_grasp_and_from_the_path() {
    let object = marker();
    let whole = plan_pick(robot(), &object, None, &robot().neutral(), &[], &SETTINGS).unwrap();
    let (closed, lifted) = whole.timeline.span_s(PickPhase::Lift).unwrap();
    let (_, carried) = whole.timeline.span_s(PickPhase::HandOver).unwrap();
    for t in [closed, 0.5 * (closed + lifted), 0.5 * (lifted + carried), carried] {
        let mut arms = robot().neutral();
        *arms.of_mut(whole.limb()) = whole.at(t).q;
        let offset = whole.object_in_gripper;
        let rest =
            plan_delivery(robot(), &object, &offset, whole.limb(), &arms, &[], &SETTINGS).unwrap();
        assert_eq!(rest.at(0.0).q, whole.at(t).q);
        assert_eq!(rest.object_in_gripper, offset);
        assert_eq!(rest.timeline.stages()[0].phase, PickPhase::Lift);
        assert_sound(&rest.timeline, &[]);
        let (release, _) = rest.timeline.span_s(PickPhase::Release).unwrap();
        let there = arm(whole.limb()).chain.forward(&rest.at(release).q).translation.vector;
        let place = SETTINGS.hand_over_m(whole.limb());
        assert!((there - Vector3::from(place)).norm() < 1e-5);
    }
}

#[test]
fn held_object_is_delivered_from_every_moment_of_its_path() {
    let bowls = bowls();
    for (i, bowl) in bowls.iter().enumerate().skip(1).take(3) {
        let others = all_but(&bowls, i);
        let whole = plan_pick(robot(), bowl, None, &robot().neutral(), &others, &SETTINGS).unwrap();
        let from = whole.timeline.span_s(PickPhase::Lift).unwrap().0;
        let to = whole.timeline.span_s(PickPhase::HandOver).unwrap().1;
        for k in 0..=24 {
            let t = from + (to - from) * f64::from(k) / 24.0;
            let mut arms = robot().neutral();
            *arms.of_mut(whole.limb()) = whole.timeline.halted_at(t).end();
            let offset = &whole.object_in_gripper;
            let rest =
                plan_delivery(robot(), bowl, offset, whole.limb(), &arms, &others, &SETTINGS)
                    .unwrap_or_else(|error| panic!("bowl {i} at {t}: {error}"));
            assert_sound(&rest.timeline, &others);
        }
    }
}

#[test]
fn arm_returns_from_every_moment_of_a_pick() {
    let bowls = bowls();
    let others = all_but(&bowls, 1);
    let whole =
        plan_pick(robot(), &bowls[1], None, &robot().neutral(), &others, &SETTINGS).unwrap();
    for k in 0..8 {
        let t = whole.duration_s() * f64::from(k) / 7.0;
        let mut arms = robot().neutral();
        *arms.of_mut(whole.limb()) = whole.timeline.halted_at(t).end();
        let home = plan_return(robot(), whole.limb(), &arms, &others, &SETTINGS)
            .unwrap_or_else(|error| panic!("at {t}: {error}"));
        assert_sound(&home.timeline, &others);
        assert_eq!(home.at(1e9).q, neutral());
        assert_eq!(home.timeline.stages().len(), 1);
    }
}

#[test]
fn pointing_aims_the_gripper_at_the_object() {
    let bowls = bowls();
    let all: Vec<Cuboid> = bowls.iter().map(ObjectPose::cuboid).collect();
    for bowl in &bowls {
        let plan =
            plan_point(robot(), bowl.xyz_m, None, &robot().neutral(), &all, &SETTINGS).unwrap();
        assert_sound(&plan.timeline, &all);
        let (hold, end) = plan.timeline.span_s(PointPhase::Hold).unwrap();
        assert!((end - hold - SETTINGS.point_s).abs() < 1e-12);
        let gripper = arm(plan.limb()).chain.forward(&plan.timeline.at(hold).q);
        let to_object = Vector3::from(bowl.xyz_m) - gripper.translation.vector;
        let axis = gripper.rotation * Vector3::z();
        assert!((to_object.norm() - SETTINGS.standoff_m).abs() < 1e-5);
        assert!(axis.cross(&to_object).norm() < 1e-5, "the axis passes through the centre");
        assert!(axis.dot(&to_object) > 0.0, "and points at it");
        assert_eq!(plan.timeline.at(1e9).q, neutral());
        let same = (gripper.inverse() * plan.gripper).translation.vector.norm();
        assert!(same < 1e-5);
    }
}

#[test]
fn check_reachable_reports_each_object() {
    let mut objects = bowls();
    objects.push(ObjectPose { xyz_m: [1.6, 0.0, -0.13], ..objects[1] });
    objects.push(ObjectPose { grasp_width_m: 0.06, ..marker() });
    let checked = check_reachable(robot(), &objects, None, &SETTINGS);
    assert_eq!(checked.len(), 8);
    assert!(checked[..6].iter().all(Result::is_ok), "{checked:?}");
    assert_eq!(checked[0], Ok(Limb::Right));
    assert_eq!(checked[2], Ok(Limb::Left));
    assert!(matches!(checked[6], Err(PlanError::Unreachable { .. })), "{:?}", checked[6]);
    assert!(matches!(checked[7], Err(PlanError::Grasp(_))));
}

#[test]
fn plan_errors_name_their_reason() {
    let far = ObjectPose { xyz_m: [1.7, 0.0, -0.13], ..bowls()[1] };
    let error = plan_pick(robot(), &far, None, &robot().neutral(), &[], &SETTINGS).unwrap_err();
    let PlanError::Unreachable { distance_m, .. } = error else { panic!("{error:?}") };
    assert!(distance_m > 0.3 && distance_m < 1.0, "{error}");
    assert!(error.to_string().contains("out of the"), "{error}");

    let mut arms = robot().neutral();
    arms.left[1] = 2.0;
    let error = plan_pick(robot(), &marker(), Some(Limb::Left), &arms, &[], &SETTINGS).unwrap_err();
    assert!(matches!(error, PlanError::Start(_)), "{error}");
    assert!(plan_return(robot(), Limb::Left, &arms, &[], &SETTINGS).is_err());
    assert!(plan_point(robot(), [0.7, 0.0, 0.0], Some(Limb::Left), &arms, &[], &SETTINGS).is_err());

    let lid = Cuboid::aligned([0.68, -0.15, -0.05], [0.4, 0.4, 0.02]);
    let error =
        plan_pick(robot(), &marker(), None, &robot().neutral(), &[lid], &SETTINGS).unwrap_err();
    assert!(matches!(error, PlanError::Blocked { .. }), "{error}");
    assert!(error.to_string().contains("other object"), "{error}");

    let tucked = Arms { right: named(Limb::Right, "tuck"), ..robot().neutral() };
    let error = plan_return(robot(), Limb::Right, &tucked, &[], &SETTINGS).unwrap_err();
    assert!(error.to_string().contains("present posture"), "{error}");
}

#[test]
fn planner_rejects_a_handover_out_of_reach() {
    let settings = PlanSettings { hand_over_xyz_m: [1.5, 0.3, 0.2], ..SETTINGS };
    let error =
        plan_pick(robot(), &marker(), None, &robot().neutral(), &[], &settings).unwrap_err();
    assert!(error.to_string().contains("hand over"), "{error}");
    assert!(check_reachable(robot(), &[marker()], None, &settings)[0].is_err());
}

#[test]
fn a_plan_is_halted_on_its_path() {
    let plan = plan_pick(robot(), &marker(), None, &robot().neutral(), &[], &SETTINGS).unwrap();
    for k in 0..20 {
        let t = plan.duration_s() * f64::from(k) / 19.0;
        let halt = plan.timeline.halted_at(t);
        assert!(halt.duration_s() <= 0.1 + 1e-9);
        let start: Joints = halt.start();
        assert!((0..7).all(|j| (start[j] - plan.at(t).q[j]).abs() < 1e-9));
        assert!(halt.sample(halt.duration_s()).1.iter().all(|v| v.abs() < 1e-6));
    }
}

#[test]
fn plans_for_random_tables_never_touch_anything() {
    let seed = 72;
    let mut random = Random::seeded(seed);
    let mut fetched = 0;
    for round in 0..4 {
        let objects = random_table(&mut random);
        for (i, object) in objects.iter().enumerate().take(2) {
            let others = all_but(&objects, i);
            match plan_pick(robot(), object, None, &robot().neutral(), &others, &SETTINGS) {
                Ok(plan) => {
                    assert_sound(&plan.timeline, &others);
                    assert_fetches(&plan, object);
                    fetched += 1;
                }
                Err(error) => {
                    let known = check_reachable(robot(), &objects, None, &SETTINGS);
                    assert!(
                        known[i].is_err()
                            || matches!(
                                error,
                                PlanError::NoPath { .. } | PlanError::Blocked { .. }
                            ),
                        "seed {seed} round {round}: {error}"
                    );
                }
            }
        }
    }
    assert!(fetched >= 5, "seed {seed}: only {fetched} of 8");
}

/// Six to eight small objects on the table, apart from each other.
fn random_table(random: &mut Random) -> Vec<ObjectPose> {
    let count = 6 + (random.unit() * 3.0) as usize;
    let mut objects: Vec<ObjectPose> = Vec::new();
    while objects.len() < count {
        let height = random.between(0.012, 0.08);
        let across = random.between(0.012, 0.12);
        let xyz_m = [random.between(0.58, 0.78), random.between(-0.5, 0.5), -0.155 + 0.5 * height];
        let apart =
            |other: &ObjectPose| (other.xyz_m[0] - xyz_m[0]).hypot(other.xyz_m[1] - xyz_m[1]) > 0.2;
        if objects.iter().all(apart) {
            objects.push(ObjectPose {
                xyz_m,
                yaw_rad: random.between(-3.0, 3.0),
                size_m: [across, across, height],
                grasp_width_m: if across < STROKE_M { across } else { 0.005 },
            });
        } else if random.unit() < 0.01 {
            objects.clear();
        }
    }
    objects
}

#[test]
fn a_raised_gripper_needs_no_lift() {
    let object = marker();
    let far = Isometry3::from(Translation3::new(0.2, 0.6, 0.3));
    assert_eq!(deliver::still_to_lift_m(&object, &far, &SETTINGS), 0.0);
    let at = Isometry3::from(Translation3::from(Vector3::from(object.xyz_m)));
    let lift = deliver::still_to_lift_m(&object, &at, &SETTINGS);
    assert!((lift - SETTINGS.hover_m - 0.007).abs() < 1e-9);
}
