use super::*;
use crate::samples::{Random, fixture, full, named, neutral};

/// Samples at 1 kHz: limits kept, velocity the derivative of position, ends at rest.
fn assert_keeps(trajectory: &Trajectory, limits: &MotionLimits, what: &str) {
    let steps = (trajectory.duration_s() * 1e3).ceil() as usize;
    let mut before = trajectory.sample(0.0);
    for k in 0..=steps {
        let t = k as f64 * 1e-3;
        let (q, qd) = trajectory.sample(t);
        let qdd = trajectory.acceleration(t);
        assert!(full().position.within(&q), "{what} at {t}: {q:?}");
        for j in 0..7 {
            assert!(qd[j].abs() <= limits.velocity[j] * (1.0 + 1e-9), "{what} at {t}: {qd:?}");
            let bound = limits.acceleration[j] * (1.0 + 1e-9);
            assert!(qdd[j].abs() <= bound, "{what} at {t}: joint {j} {qdd:?}");
            // Within a millisecond velocity changes by no more than the acceleration allows.
            let change = (qd[j] - before.1[j]).abs();
            assert!(change <= bound * 1e-3 + 1e-9, "{what} at {t}: joint {j} jumps by {change}");
            let mean = 0.5 * (qd[j] + before.1[j]) * if k == 0 { 0.0 } else { 1e-3 };
            let moved = q[j] - before.0[j];
            assert!((moved - mean).abs() < 1e-5, "{what} at {t}: joint {j} {moved} {mean}");
        }
        before = (q, qd);
    }
    assert!(before.1.iter().all(|v| v.abs() < 1e-6), "{what} ends at {:?}", before.1);
}

#[test]
fn random_ways_keep_every_limit_and_pass_no_corner_at_rest() {
    let seed = 31;
    let mut random = Random::seeded(seed);
    for round in 0..25 {
        let count = 2 + (random.unit() * 4.0) as usize;
        let waypoints: Vec<Joints> = (0..count).map(|_| random.posture()).collect();
        let limits = full().at_speed_ratio(random.between(0.1, 1.0));
        let blend = random.between(0.02, 0.5);
        let trajectory = Trajectory::through(&waypoints, blend, &limits).unwrap();
        let what = format!("seed {seed} round {round}");
        assert_keeps(&trajectory, &limits, &what);
        assert_eq!(trajectory.start(), waypoints[0], "{what}");
        assert_eq!(trajectory.end(), waypoints[count - 1], "{what}");
        for k in 1..50 {
            let (_, qd) = trajectory.sample(trajectory.duration_s() * f64::from(k) / 50.0);
            assert!(qd.iter().any(|v| v.abs() > 1e-4), "{what} stops on the way");
        }
    }
}

#[test]
fn one_joint_alone_takes_the_trapezoids_time() {
    let mut far = [0.0; 7];
    far[0] = 1.5;
    let trajectory = Trajectory::through(&[[0.0; 7], far], 0.1, &full()).unwrap();
    // 0.75 s up to 1.5 rad/s over 0.5625 rad, the same down, the rest at full speed.
    let expected = 1.5 + (1.5 - 1.125) / 1.5;
    assert!((trajectory.duration_s() - expected).abs() < 1e-6, "{}", trajectory.duration_s());
    let (q, qd) = trajectory.sample(expected / 2.0);
    assert!((q[0] - 0.75).abs() < 1e-6 && (qd[0] - 1.5).abs() < 1e-6);
}

#[test]
fn spline_timing_is_as_short_as_the_reference() {
    let reference: serde_json::Value =
        serde_json::from_str(&fixture("topp_reference.json")).unwrap();
    let paths = reference["paths"].as_array().unwrap();
    assert_eq!(paths.len(), 25);
    for (i, path) in paths.iter().enumerate() {
        let waypoints: Vec<Joints> = serde_json::from_value(path["waypoints"].clone()).unwrap();
        let fine = path["duration_grid_1000"].as_f64().unwrap();
        let coarse = Trajectory::along(Path::spline(&waypoints), &full(), 200);
        assert!(coarse.duration_s() < 1.015 * fine, "path {i}: {}", coarse.duration_s() / fine);
        // One path in six on the fine grid: the rest would only take time.
        if i % 6 == 0 {
            let timed = Trajectory::along(Path::spline(&waypoints), &full(), 4000);
            assert!(timed.duration_s() <= 1.001 * fine, "path {i}: {}", timed.duration_s() / fine);
            assert!(timed.duration_s() > 0.998 * fine, "path {i} is too good to be true");
        }
    }
}

#[test]
fn waypoints_outside_the_limits_are_refused() {
    let mut q = [0.0; 7];
    q[3] = 2.7;
    let error = Trajectory::through(&[[0.0; 7], q], 0.1, &full()).unwrap_err();
    assert!(matches!(error, TrajectoryError::OutsideLimits { joint: "e1", .. }));
    assert!(error.to_string().contains("e1") && error.to_string().contains("2.618"));
}

#[test]
fn going_nowhere_takes_no_time() {
    let q = neutral();
    let still = Trajectory::through(&[q, q], 0.1, &full()).unwrap();
    assert_eq!((still.duration_s(), still.sample(1.0)), (0.0, (q, [0.0; 7])));
    let held = Trajectory::hold(&q, 2.0, &full());
    assert_eq!((held.duration_s(), held.sample(1.0)), (2.0, (q, [0.0; 7])));
}

#[test]
fn sampling_beyond_the_ends_gives_the_ends() {
    let waypoints = [[0.0; 7], neutral()];
    let trajectory = Trajectory::through(&waypoints, 0.1, &full()).unwrap();
    assert_eq!(trajectory.sample(-1.0), trajectory.sample(0.0));
    assert_eq!(trajectory.sample(1e9), trajectory.sample(trajectory.duration_s()));
    assert_eq!(trajectory.sample(f64::NAN), trajectory.sample(0.0));
}

#[test]
fn a_split_motion_is_the_whole() {
    let waypoints = [[0.0; 7], neutral(), named(crate::Limb::Left, "untuck")];
    let whole = Trajectory::through(&waypoints, 0.2, &full()).unwrap();
    let cut = whole.time_nearest(&waypoints[1]);
    let (first, second) = whole.split(cut);
    assert!((first.duration_s() + second.duration_s() - whole.duration_s()).abs() < 1e-12);
    assert_eq!(first.end(), second.start());
    assert!(first.sample(cut).1.iter().any(|v| v.abs() > 0.05), "the cut is not a stop");
    for k in 0..100 {
        let t = whole.duration_s() * f64::from(k) / 100.0;
        let part = if t < cut { first.sample(t) } else { second.sample(t - cut) };
        for j in 0..7 {
            assert!((part.0[j] - whole.sample(t).0[j]).abs() < 1e-9);
        }
    }
}

#[test]
fn a_halt_stops_within_a_tenth_of_a_second_and_the_limits() {
    let seed = 32;
    let mut random = Random::seeded(seed);
    for round in 0..300 {
        let q = random.posture();
        let qd: Joints = full().velocity.map(|v| random.between(-v, v));
        let halt = Trajectory::halt(&q, &qd, &full());
        let what = format!("seed {seed} round {round}");
        assert!(halt.duration_s() <= 0.1 + 1e-12, "{what}");
        let (start, speed) = halt.sample(0.0);
        assert_eq!(start, q, "{what}");
        if halt.duration_s() > 0.0 {
            assert!(speed.iter().zip(&qd).all(|(a, b)| (a - b).abs() < 1e-9), "{what}");
        }
        for k in 0..=50 {
            let (q, qd) = halt.sample(halt.duration_s() * f64::from(k) / 50.0);
            assert!(full().position.within(&q), "{what}");
            assert!(k < 50 || qd.iter().all(|v| v.abs() < 1e-9), "{what}");
        }
        let room = (0..7).all(|j| {
            let way = 0.5 * qd[j].abs() * 0.1;
            let (lower, upper) = full().position.0[j];
            q[j] - way > lower && q[j] + way < upper
        });
        let full = MotionLimits { acceleration: full().stop, ..full() };
        if room {
            assert_keeps(&halt, &full, &what);
        }
    }
}

#[test]
fn a_halt_on_the_path_stays_on_it() {
    let seed = 33;
    let mut random = Random::seeded(seed);
    for round in 0..20 {
        let waypoints: Vec<Joints> = (0..4).map(|_| random.posture()).collect();
        let whole = Trajectory::through(&waypoints, 0.2, &full()).unwrap();
        for _ in 0..5 {
            let t = random.between(0.0, whole.duration_s());
            let halt = whole.halted_at(t);
            let what = format!("seed {seed} round {round} at {t}");
            let (q, qd) = halt.sample(0.0);
            let (there, speed) = whole.sample(t);
            assert!(halt.duration_s() <= 0.1 + 1e-9, "{what}: {}", halt.duration_s());
            for j in 0..7 {
                assert!((q[j] - there[j]).abs() < 1e-9, "{what}");
                assert!((qd[j] - speed[j]).abs() < 1e-6, "{what}");
            }
            let full = MotionLimits { acceleration: full().stop, ..full() };
            assert_keeps(&halt, &full, &what);
            // Every point of the halt lies on the whole's path.
            for k in 0..=10 {
                let (q, _) = halt.sample(halt.duration_s() * f64::from(k) / 10.0);
                let at = |t: f64| {
                    let (p, _) = whole.sample(t);
                    p.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
                };
                let nearest = (0..=400).map(|i| at(t + 0.1 * f64::from(i) / 400.0));
                assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-3, "{what}");
            }
        }
    }
}

#[test]
fn a_halt_at_rest_stays_there() {
    let still = Trajectory::hold(&neutral(), 1.0, &full());
    assert_eq!(still.halted_at(0.5).sample(0.0).0, neutral());
    assert_eq!(still.halted_at(0.5).duration_s(), 0.0);
    let moved = Trajectory::through(&[[0.0; 7], neutral()], 0.1, &full()).unwrap();
    assert_eq!(moved.halted_at(99.0).sample(9.0).0, moved.end());
    assert_eq!(Trajectory::halt(&neutral(), &[0.0; 7], &full()).duration_s(), 0.0);
    assert_eq!(Trajectory::halt(&neutral(), &[f64::NAN; 7], &full()).end(), neutral());
}
