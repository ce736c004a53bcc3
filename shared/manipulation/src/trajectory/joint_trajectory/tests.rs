use super::*;
use crate::kinematics::limits::PositionLimits;
use crate::samples::{Random, fixture, full, named, neutral, numbers, table};

/// Returns the same without a bound on jerk.
fn jerky() -> MotionLimits {
    MotionLimits { jerk: [f64::INFINITY; 7], ..full() }
}

/// Bounds of a motion stop, which is not checked between two of its steps.
fn stopping() -> MotionLimits {
    MotionLimits { acceleration: full().stop.map(|a| a * (1.0 + 1e-5)), ..jerky() }
}

/// Samples at 1 kHz: every limit kept, each derivative that of what it belongs to.
fn assert_keeps(trajectory: &Trajectory, limits: &MotionLimits, what: &str) {
    let steps = (trajectory.duration_s() * 1e3).ceil() as usize;
    let mut before = trajectory.state(0.0);
    for k in 0..=steps {
        let t = k as f64 * 1e-3;
        let State { q, qd, qdd } = trajectory.state(t);
        let dt = if k == 0 { 0.0 } else { t.min(trajectory.duration_s()) - (t - 1e-3) };
        assert!(limits.position.within(&q), "{what} at {t}: {q:?}");
        for j in 0..7 {
            let velocity = limits.velocity[j] * (1.0 + 1e-9);
            let acceleration = limits.acceleration[j] * (1.0 + 1e-9);
            assert!(qd[j].abs() <= velocity, "{what} at {t}: {qd:?}");
            assert!(qdd[j].abs() <= acceleration, "{what} at {t}: joint {j} {qdd:?}");
            let jerk = limits.jerk[j] * dt.max(1e-9) + 1e-6;
            let change = (qdd[j] - before.qdd[j]).abs();
            assert!(change <= jerk, "{what} at {t}: joint {j} jerks by {change}");
            // Within a millisecond velocity changes by no more than the acceleration allows.
            let change = (qd[j] - before.qd[j]).abs();
            assert!(change <= acceleration * dt + 1e-9, "{what} at {t}: joint {j} {change}");
            let moved = q[j] - before.q[j];
            let mean = 0.5 * (qd[j] + before.qd[j]) * dt;
            assert!((moved - mean).abs() < 1e-5, "{what} at {t}: joint {j} {moved} {mean}");
        }
        before = State { q, qd, qdd };
    }
}

fn assert_rests(trajectory: &Trajectory, what: &str) {
    let (_, qd) = trajectory.sample(trajectory.duration_s());
    assert!(qd.iter().all(|v| v.abs() < 1e-6), "{what} ends at {qd:?}");
}

#[test]
fn random_trajectories_keep_every_limit_and_stop_at_no_corner() {
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
        assert_rests(&trajectory, &what);
        assert_eq!(trajectory.start(), waypoints[0], "{what}");
        assert_eq!(trajectory.end(), waypoints[count - 1], "{what}");
        for k in 1..50 {
            let (_, qd) = trajectory.sample(trajectory.duration_s() * f64::from(k) / 50.0);
            assert!(qd.iter().any(|v| v.abs() > 1e-4), "{what} stops on the way");
        }
        let jerky = MotionLimits { jerk: [f64::INFINITY; 7], ..limits };
        let sharp = Trajectory::through(&waypoints, blend, &jerky).unwrap();
        let longer = trajectory.duration_s() - sharp.duration_s();
        assert!((0.0..0.2005).contains(&longer), "{what} takes {longer} s longer");
        for k in 0..=200 {
            let t = sharp.duration_s() * f64::from(k) / 200.0;
            let passed = trajectory.sample(t + 0.5 * longer).0;
            let there = sharp.sample(t).0;
            let off = there.iter().zip(&passed).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off <= 2.0 * 0.2 * 0.2 / 24.0 + 1e-6 || count == 2, "{what}: {off} rad off");
        }
    }
}

#[test]
fn one_joint_alone_takes_the_shortest_time() {
    let mut far = [0.0; 7];
    far[0] = 1.5;
    // 0.75 s up to 1.5 rad/s over 0.5625 rad, the same down, the rest at full speed.
    let trapezoid = 1.5 + (1.5 - 1.125) / 1.5;
    let jerky = Trajectory::through(&[[0.0; 7], far], 0.1, &jerky()).unwrap();
    assert!((jerky.duration_s() - trapezoid).abs() < 1e-6, "{}", jerky.duration_s());
    // Building the acceleration up and down takes 0.1 s each way.
    let smooth = Trajectory::through(&[[0.0; 7], far], 0.1, &full()).unwrap();
    assert!((smooth.duration_s() - trapezoid - 0.1).abs() < 1e-6, "{}", smooth.duration_s());
    let (q, qd) = smooth.sample(0.5 * smooth.duration_s());
    assert!((q[0] - 0.75).abs() < 1e-6 && (qd[0] - 1.5).abs() < 1e-6);
    assert_keeps(&smooth, &full(), "one joint");
    // On a line through a waypoint the average is as good where full speed is held for a while.
    let mut half = [0.0; 7];
    half[0] = 0.7;
    half[1] = 1e-6;
    let averaged = Trajectory::through(&[[0.0; 7], half, far], 0.1, &full()).unwrap();
    assert!((averaged.duration_s() - trapezoid - 0.1).abs() < 1e-3, "{}", averaged.duration_s());
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
        let coarse = Trajectory::along(Path::spline(&waypoints), &jerky(), 200);
        assert!(coarse.duration_s() < 1.015 * fine, "path {i}: {}", coarse.duration_s() / fine);
        let timed = Trajectory::along(Path::spline(&waypoints), &jerky(), 4000);
        assert!(timed.duration_s() <= 1.001 * fine, "path {i}: {}", timed.duration_s() / fine);
        assert!(timed.duration_s() > 0.998 * fine, "path {i} is too good to be true");
        // A spline may leave the position limits; everything else is kept.
        let anywhere = PositionLimits([(-9.0, 9.0); 7]);
        let jerky = MotionLimits { position: anywhere, ..jerky() };
        assert_keeps(&Trajectory::along(Path::spline(&waypoints), &jerky, 4000), &jerky, "spline");
        let full = MotionLimits { position: anywhere, ..full() };
        let smooth = Trajectory::along(Path::spline(&waypoints), &full, 1000);
        assert_keeps(&smooth, &full, &format!("smooth spline {i}"));
        assert!(smooth.duration_s() < 1.002 * fine + 0.2005, "path {i}");
    }
}

#[test]
fn moves_between_states_take_as_long_as_the_reference() {
    let (names, rows) = table("jerk_limited_reference.csv");
    assert_eq!((names.len(), rows.len()), (37, 100));
    let mut refused = 0;
    for (i, row) in rows.iter().enumerate() {
        let n = numbers(row);
        let seven = |at: usize| -> Joints { n[at..at + 7].try_into().unwrap() };
        let from = State { q: seven(0), qd: seven(7), qdd: seven(14) };
        let to = State::at_rest(&seven(21));
        let stays = n[29] == 1.0;
        let free = MotionLimits { position: PositionLimits([(-9.0, 9.0); 7]), ..full() };
        let unbound = Trajectory::between(&from, &to, &free).unwrap();
        assert!((unbound.duration_s() - n[28]).abs() < 1e-6, "row {i}");
        let kept = Trajectory::between(&from, &to, &full());
        let Ok(kept) = kept else {
            // One row says that it stays within the limits, and no motion does.
            assert!((0..7).any(|j| cannot_stop(&from, j)), "row {i}: {kept:?}");
            refused += usize::from(stays);
            continue;
        };
        assert_keeps(&kept, &full(), &format!("row {i}"));
        assert_rests(&kept, &format!("row {i}"));
        assert_eq!((kept.start(), kept.end()), (from.q, to.q), "row {i}");
        let longer = kept.duration_s() - n[28];
        assert!(longer.abs() < 1e-6 || !stays && longer > 0.0, "row {i}: {longer}");
    }
    assert!(refused <= 1, "{refused} of 98 refused");
}

/// Returns whether joint `j` passes its position limit even if it brakes as hard as it may.
fn cannot_stop(from: &State, j: usize) -> bool {
    let side = from.qd[j].signum();
    let (mut q, mut qd, mut qdd) = (side * from.q[j], side * from.qd[j], side * from.qdd[j]);
    let dt = 1e-5;
    while qd > 0.0 {
        qdd = (qdd - full().jerk[j] * dt).max(-full().acceleration[j]);
        q += qd * dt;
        qd += qdd * dt;
    }
    let (lower, upper) = full().position.0[j];
    q > if side > 0.0 { upper } else { -lower }
}

#[test]
fn moves_between_random_states_keep_every_limit() {
    let seed = 34;
    let mut random = Random::seeded(seed);
    let (mut found, mut refused) = (0, 0);
    for round in 0..300 {
        let limits = full().at_speed_ratio(random.between(0.1, 1.0));
        let state = |random: &mut Random| State {
            q: random.posture(),
            qd: limits.velocity.map(|v| v * random.between(-0.3, 0.3)),
            qdd: limits.acceleration.map(|a| a * random.between(-0.3, 0.3)),
        };
        let (from, to) = (state(&mut random), state(&mut random));
        let what = format!("seed {seed} round {round}");
        match Trajectory::between(&from, &to, &limits) {
            Ok(move_) => {
                found += 1;
                assert_keeps(&move_, &limits, &what);
                for (at, state) in [(0.0, &from), (move_.duration_s(), &to)] {
                    let there = move_.state(at);
                    for j in 0..7 {
                        assert!((there.q[j] - state.q[j]).abs() < 1e-9, "{what} at {at}");
                        assert!((there.qd[j] - state.qd[j]).abs() < 1e-6, "{what} at {at}");
                        assert!((there.qdd[j] - state.qdd[j]).abs() < 1e-5, "{what} at {at}");
                    }
                }
            }
            // A joint that moves towards a limit that is too near leaves no motion.
            Err(TrajectoryError::NoMotion) => refused += 1,
            Err(error) => panic!("{what}: {error}"),
        }
    }
    assert!(found > 150 && refused < 150, "seed {seed}: {found} {refused}");
}

#[test]
fn trajectory_rejects_states_outside_the_limits() {
    let rest = State::at_rest(&neutral());
    let fast = State { qd: [0.0, 0.0, 1.6, 0.0, 0.0, 0.0, 0.0], ..rest };
    let error = Trajectory::between(&fast, &rest, &full()).unwrap_err();
    assert!(matches!(error, TrajectoryError::TooFast { joint: 2, what: "velocity", .. }));
    let jolted = State { qdd: [f64::NAN; 7], ..rest };
    let error = Trajectory::between(&rest, &jolted, &full()).unwrap_err();
    assert!(matches!(error, TrajectoryError::TooFast { what: "acceleration", .. }), "{error}");
    let outside = State::at_rest(&[2.0; 7]);
    assert!(matches!(
        Trajectory::between(&outside, &rest, &full()),
        Err(TrajectoryError::OutsideLimits { .. })
    ));
    let mut edge = State::at_rest(&neutral());
    (edge.q[0], edge.qd[0]) = (full().position.0[0].1, 0.5);
    assert_eq!(Trajectory::between(&edge, &rest, &full()), Err(TrajectoryError::NoMotion));
    let none = Trajectory::between(&rest, &rest, &full()).unwrap();
    assert_eq!((none.duration_s(), none.end()), (0.0, rest.q));
}

#[test]
fn trajectory_rejects_waypoints_outside_the_limits() {
    let mut q = [0.0; 7];
    q[3] = 2.7;
    let error = Trajectory::through(&[[0.0; 7], q], 0.1, &full()).unwrap_err();
    assert!(matches!(error, TrajectoryError::OutsideLimits { joint: 3, .. }));
    assert!(
        error.to_string().contains("joint 4 from the shoulder")
            && error.to_string().contains("2.618")
    );
}

#[test]
fn trajectory_without_motion_takes_no_time() {
    let q = neutral();
    let still = Trajectory::through(&[q, q], 0.1, &full()).unwrap();
    assert_eq!((still.duration_s(), still.sample(1.0)), (0.0, (q, [0.0; 7])));
    let held = Trajectory::hold(&q, 2.0, &full());
    assert_eq!((held.duration_s(), held.sample(1.0)), (2.0, (q, [0.0; 7])));
}

#[test]
fn trajectory_sampling_is_clamped_to_the_ends() {
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
            assert!(halt.duration_s() <= 0.1005, "{what}: {}", halt.duration_s());
            for j in 0..7 {
                assert!((q[j] - there[j]).abs() < 1e-9, "{what}");
                assert!((qd[j] - speed[j]).abs() < 1e-6, "{what}");
            }
            assert_keeps(&halt, &stopping(), &what);
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
}
