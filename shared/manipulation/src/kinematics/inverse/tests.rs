use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::kinematics::limb::{Limb, distance};
use crate::samples::{Random, arm, full, joints, numbers, pose, table};

/// Asserts that an answer is what it claims to be, by forward kinematics.
fn verify(limb: Limb, target: &Isometry3<f64>, answer: &IkSolution) {
    let reached = arm(limb).chain.forward(&answer.q);
    let distance = (reached.translation.vector - target.translation.vector).norm();
    let angle = reached.rotation.angle_to(&target.rotation);
    assert!(full().position.within(&answer.q), "{limb} {answer:?}");
    assert!(distance <= TOLERANCE_M, "{limb} {answer:?} misses by {distance:e}");
    // The angle of two nearly equal quaternions is only known to the root of the precision.
    assert!(angle <= TOLERANCE_RAD + 3e-8, "{limb} {answer:?} turns by {angle:e}");
    assert!((answer.position_error_m - distance).abs() < 1e-12);
}

#[test]
fn every_solvable_row_of_the_reference_is_solved_and_no_other() {
    for (limb, count) in [(Limb::Left, 400), (Limb::Right, 200)] {
        let (_, rows) = table(&format!("ik_targets_{limb}.csv"));
        assert_eq!(rows.len(), count);
        for row in rows {
            let n = numbers(&row[1..]);
            let target = pose(&n[..7]);
            let solvable = n[7] == 1.0;
            let plain = arm(limb).chain.inverse(&target, None);
            let near = arm(limb).chain.inverse(&target, Some(&joints(&n[8..15])));
            for answer in [plain, near] {
                assert_eq!(answer.is_ok(), solvable, "{limb} {row:?}: {answer:?}");
                if let Ok(answer) = answer {
                    verify(limb, &target, &answer);
                }
            }
        }
    }
}

#[test]
fn random_postures_are_found_again() {
    let seed = 11;
    let mut random = Random::seeded(seed);
    for _ in 0..1500 {
        let (limb, q) = (random.limb(), random.posture());
        let target = arm(limb).chain.forward(&q);
        let answer = arm(limb).chain.inverse(&target, None);
        verify(limb, &target, &answer.unwrap_or_else(|e| panic!("seed {seed}: {q:?}: {e}")));
    }
}

/// Postures that lose a direction, or lie where branches meet: the stretched elbow, the straight
/// wrist, joints at their limits, and the rare ones that a coarse sweep over s0 steps across.
#[test]
fn hard_postures_are_found_again() {
    let rare = include_str!("hard_postures.csv")
        .lines()
        .skip(1)
        .map(|row| joints(&numbers(&row.split(',').map(str::to_owned).collect::<Vec<_>>())));
    let ends = [0.0, 1.0].map(|share| full().position.at(&[share; 7]));
    for q in rare.chain([[0.0; 7]]).chain(ends) {
        for limb in Limb::BOTH {
            let target = arm(limb).chain.forward(&q);
            let answer = arm(limb).chain.inverse(&target, None);
            verify(limb, &target, &answer.unwrap_or_else(|e| panic!("{limb} {q:?}: {e}")));
        }
    }
}

#[test]
fn inverse_kinematics_is_independent_of_earlier_calls() {
    let target = arm(Limb::Left).chain.forward(&[0.3, -0.4, 0.2, 1.0, -0.5, 0.8, 0.1]);
    let first = arm(Limb::Left).chain.inverse(&target, None).unwrap();
    let far = Isometry3::translation(9.0, 0.0, 0.0);
    assert!(arm(Limb::Left).chain.inverse(&far, None).is_err());
    assert_eq!(arm(Limb::Left).chain.inverse(&target, None).unwrap(), first);
}

#[test]
fn inverse_kinematics_reports_the_nearest_posture_out_of_reach() {
    let chain = &arm(Limb::Left).chain;
    // 2 m along +x of the shoulder: the best that the arm can do is to stretch towards it.
    let shoulder = chain.shoulder();
    let down = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 1.3);
    let target = Isometry3::from_parts(Translation3::from(shoulder + Vector3::x() * 2.0), down);
    let missed = chain.inverse(&target, None).unwrap_err();
    assert!(full().position.within(&missed.nearest));
    let reached = chain.forward(&missed.nearest);
    let gap = (reached.translation.vector - target.translation.vector).norm();
    assert!((gap - missed.position_error_m).abs() < 1e-12);
    // Nothing can come nearer than the 1.2 m reach leaves; the steps end within a hand of it.
    assert!(missed.position_error_m > 0.79 && missed.position_error_m < 1.1, "{missed}");
    assert!(missed.to_string().contains("mm"));
    assert!(chain.solutions(&target).is_empty());
}

#[test]
fn inverse_kinematics_rejects_an_invalid_pose() {
    for x in [f64::NAN, f64::INFINITY, 1e200] {
        let target = Isometry3::translation(x, 0.0, 0.0);
        let missed = arm(Limb::Left).chain.inverse(&target, None).unwrap_err();
        assert!(full().position.within(&missed.nearest));
        assert!(arm(Limb::Left).chain.solutions(&target).is_empty());
    }
    let target = arm(Limb::Left).chain.forward(&[0.0; 7]);
    let seed = [f64::NAN; 7];
    verify(Limb::Left, &target, &arm(Limb::Left).chain.inverse(&target, Some(&seed)).unwrap());
}

#[test]
fn nearest_solution_is_nearest_of_all_sampled_branches() {
    let seed = 13;
    let mut random = Random::seeded(seed);
    for _ in 0..60 {
        let limb = random.limb();
        let (q, present) = (random.posture(), random.posture());
        let target = arm(limb).chain.forward(&q);
        let answer = arm(limb).chain.inverse(&target, Some(&present)).unwrap();
        verify(limb, &target, &answer);
        let found = distance(&answer.q, &present);
        for other in arm(limb).chain.solutions(&target) {
            assert!(found <= distance(&other, &present) + 1e-9, "seed {seed}: {q:?} {present:?}");
        }
    }
}

#[test]
fn nearest_to_a_solution_is_that_solution() {
    let mut random = Random::seeded(14);
    for _ in 0..60 {
        let (limb, q) = (random.limb(), random.posture());
        let answer = arm(limb).chain.inverse(&arm(limb).chain.forward(&q), Some(&q)).unwrap();
        assert!(distance(&answer.q, &q) < 1e-3, "{q:?} {:?}", answer.q);
    }
}

#[test]
fn all_solutions_are_solutions_and_differ() {
    let chain = &arm(Limb::Left).chain;
    let target = chain.forward(&[0.2, -0.6, 0.1, 1.1, 0.3, 1.0, 0.4]);
    let all = chain.solutions(&target);
    assert!(all.len() > 20, "{}", all.len());
    for (i, q) in all.iter().enumerate() {
        assert!(full().position.within(q));
        let reached = chain.forward(q);
        assert!((reached.translation.vector - target.translation.vector).norm() < TOLERANCE_M);
        assert!(all[..i].iter().all(|other| distance(other, q) > 1e-6));
    }
}

#[test]
fn tracking_stays_on_the_branch() {
    let chain = &arm(Limb::Right).chain;
    let mut q = [0.2, -0.6, 0.1, 1.1, 0.3, 1.0, 0.4];
    for _ in 0..100 {
        let target = Translation3::new(0.0, 0.001, -0.001) * chain.forward(&q);
        let next = chain.track(&target, &q).unwrap().q;
        assert!(distance(&next, &q) < 0.02);
        q = next;
    }
}
