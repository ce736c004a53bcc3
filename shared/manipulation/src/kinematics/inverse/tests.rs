use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::kinematics::limb::Limb;
use crate::samples::{Random, arm, full, joints, numbers, pose, table, with_tool};

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

fn distance(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
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
    let lower = full().position.at(&[0.0; 7]);
    let upper = full().position.at(&[1.0; 7]);
    let hard = [
        [0.0; 7],
        lower,
        upper,
        [0.3, -0.5, 0.4, 0.187, 0.2, 0.6, 0.1],
        [0.3, -0.5, 0.4, 0.9, 0.2, 0.0, 0.1],
        [-1.70167993878, -0.3, 1.0, 1.5, -0.7, 1.0, 0.3],
        [
            1.6892618789628386,
            -0.73010281368,
            -0.138076874973,
            0.19916723896,
            2.28616455,
            -1.32450816,
            1.06474558,
        ],
        [
            0.1956074358674,
            0.1936391448706,
            -2.747486805064,
            0.169315702304,
            -2.14532951789,
            -0.010042974992,
            0.474633403739,
        ],
        [
            1.5268837427227,
            0.3589085586618,
            -3.009316353715,
            0.199272906218,
            -2.08501286171,
            0.031539286433,
            2.573152900133,
        ],
        [
            -0.5045105096146,
            0.8650660207436,
            -1.515621767296,
            2.409333232140,
            -0.70385684477,
            2.081885816042,
            -2.056916372819,
        ],
        [
            -1.6274588557747,
            -0.0948027216270,
            1.335247701749,
            2.615658426130,
            -0.59531029993,
            0.121441560127,
            1.903404611817,
        ],
        [
            -1.3039704979030,
            -1.9875861382211,
            -1.583389089195,
            2.586142370473,
            1.69680168459,
            1.971650489568,
            0.188171230735,
        ],
        [
            1.700490109321,
            -1.460209396507,
            1.669667489020,
            0.177168535028,
            -0.750916838270,
            1.482320105253,
            -1.048811524013,
        ],
        [
            -0.349296058032,
            -2.081692536565,
            -1.587165163972,
            2.603520548160,
            1.287442740755,
            2.059662751896,
            1.403806455485,
        ],
        [
            -0.931729369507,
            1.020143724301,
            -1.650009185834,
            2.320932006974,
            -0.564762428682,
            2.055194781312,
            -1.757778262189,
        ],
        [
            0.742151677369,
            1.030180342903,
            1.429145347027,
            2.606975434030,
            0.873734001252,
            0.685427998878,
            -3.055221474343,
        ],
        [
            1.172652744157,
            -1.731353593145,
            -2.743725100938,
            2.603023931044,
            0.920584177275,
            0.007417864827,
            0.451166552837,
        ],
        [
            -0.6016022951460207,
            -1.8305296759374912,
            1.6009135588355985,
            2.5996363642158014,
            -1.325020280091044,
            2.074206748912078,
            2.073614094864129,
        ],
        [
            1.0759656122113355,
            1.00440804918818,
            1.4947910553971484,
            1.692579827633715,
            0.15014773180256258,
            2.0738141222864046,
            -3.0209922619554512,
        ],
        [
            -0.02943109663857757,
            -1.0361990152987623,
            -2.9392571111922994,
            2.6070401055628105,
            0.577558667382855,
            0.01925205019783105,
            1.2630829162395587,
        ],
        [
            1.5256199770031134,
            0.5667735424002802,
            1.5746289610608057,
            2.242273980443294,
            1.2171389005859892,
            2.077782409110557,
            3.0240418254579753,
        ],
        [
            -0.5699546961358961,
            0.9248858859672251,
            -1.6648572430895576,
            2.6136722609767675,
            -0.7294434965108145,
            0.024550681745294956,
            -2.2241390206222507,
        ],
        [
            -0.4087368282030541,
            0.8713565934964596,
            -1.6951510877008866,
            1.4237314744629896,
            -0.2579711428419946,
            2.09147301281182,
            -3.021242519071831,
        ],
        [
            1.138919251659264,
            -0.7978257434724878,
            -2.972221482990706,
            2.6153665497539307,
            0.18212481006154846,
            0.02032513763001731,
            -2.362290517816091,
        ],
        [
            0.482623571084,
            0.660702577059,
            -1.498879451614,
            2.611826751174,
            -0.984576890305,
            0.053110561702,
            0.415028336799,
        ],
    ];
    for limb in Limb::BOTH {
        for q in hard {
            let target = arm(limb).chain.forward(&q);
            let answer = arm(limb).chain.inverse(&target, None);
            verify(limb, &target, &answer.unwrap_or_else(|e| panic!("{limb} {q:?}: {e}")));
        }
    }
}

#[test]
fn other_tool_lengths_are_solved_as_well() {
    let mut random = Random::seeded(12);
    for _ in 0..100 {
        let chain = with_tool(random.limb(), random.between(0.0, 0.4));
        let target = chain.forward(&random.posture());
        let answer = chain.inverse(&target, None).unwrap();
        let reached = chain.forward(&answer.q);
        assert!((reached.translation.vector - target.translation.vector).norm() <= TOLERANCE_M);
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
