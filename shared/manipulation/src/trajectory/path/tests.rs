use super::*;
use crate::samples::Random;

fn ends(path: &Path) -> (Joints, Joints) {
    let (first, last) = (path.pieces().first().unwrap(), path.pieces().last().unwrap());
    (first.position(0.0), last.position(last.length))
}

fn near(a: &Joints, b: &Joints, tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// Every piece begins where the one before ends, in position and slope.
fn assert_smooth(path: &Path) {
    for pair in path.pieces().windows(2) {
        let end = pair[0].length;
        assert!(near(&pair[0].position(end), &pair[1].position(0.0), 1e-9));
        assert!(near(&pair[0].slope(end), &pair[1].slope(0.0), 1e-9));
        assert!((pair[0].start + end - pair[1].start).abs() < 1e-12);
    }
}

#[test]
fn rounded_paths_are_smooth_and_stay_in_the_hull() {
    let seed = 21;
    let mut random = Random::seeded(seed);
    for _ in 0..200 {
        let count = 2 + (random.unit() * 6.0) as usize;
        let waypoints: Vec<Joints> = (0..count).map(|_| random.posture()).collect();
        let blend = random.between(0.0, 3.0);
        let path = Path::rounded(&waypoints, blend);
        assert_smooth(&path);
        let (start, end) = ends(&path);
        assert!(near(&start, &waypoints[0], 1e-12) && near(&end, &waypoints[count - 1], 1e-9));
        for j in 0..7 {
            let low = waypoints.iter().map(|q| q[j]).fold(f64::INFINITY, f64::min);
            let high = waypoints.iter().map(|q| q[j]).fold(f64::NEG_INFINITY, f64::max);
            for piece in path.pieces() {
                for k in 0..=20 {
                    let q = piece.position(piece.length * f64::from(k) / 20.0)[j];
                    assert!(low - 1e-9 <= q && q <= high + 1e-9, "seed {seed}");
                }
            }
        }
    }
}

#[test]
fn a_corner_is_passed_no_further_than_its_blend() {
    let corner = [0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let waypoints =
        [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], corner, [0.5, 0.5, 0.0, 1.0, 0.0, 0.0, 0.0]];
    let path = Path::rounded(&waypoints, 0.1);
    let nearest = path
        .pieces()
        .iter()
        .flat_map(|piece| (0..=50).map(|k| piece.position(piece.length * f64::from(k) / 50.0)))
        .map(|q| (q[0] - corner[0]).hypot(q[1] - corner[1]))
        .fold(f64::INFINITY, f64::min);
    // A parabola over a right angle passes its corner at blend / (2 √2).
    assert!((nearest - 0.1 / 8f64.sqrt()).abs() < 1e-3, "{nearest}");
}

#[test]
fn a_path_may_turn_back_on_itself() {
    let (a, b) = ([0.0; 7], [0.5; 7]);
    let path = Path::rounded(&[a, b, a], 0.2);
    assert_smooth(&path);
    assert_eq!(ends(&path), (a, a));
}

#[test]
fn equal_waypoints_make_no_length() {
    let q = [0.1; 7];
    for path in [Path::rounded(&[q, q, q], 0.1), Path::rounded(&[q], 0.1), Path::spline(&[q])] {
        assert_eq!(path.length(), 0.0);
        assert_eq!(ends(&path), (q, q));
    }
    assert_eq!(Path::rounded(&[], 0.1).length(), 0.0);
}

#[test]
fn splines_pass_their_waypoints_and_end_unbent() {
    let mut random = Random::seeded(22);
    for count in 2..8 {
        let waypoints: Vec<Joints> = (0..count).map(|_| random.posture()).collect();
        let path = Path::spline(&waypoints);
        assert_smooth(&path);
        assert!((path.length() - 1.0).abs() < 1e-12);
        for (piece, waypoint) in path.pieces().iter().zip(&waypoints) {
            assert!(near(&piece.position(0.0), waypoint, 1e-9));
        }
        for pair in path.pieces().windows(2) {
            assert!(near(&pair[0].bend(pair[0].length), &pair[1].bend(0.0), 1e-6));
        }
        let (first, last) = (path.pieces().first().unwrap(), path.pieces().last().unwrap());
        assert!(near(&first.bend(0.0), &[0.0; 7], 1e-9));
        assert!(near(&last.bend(last.length), &[0.0; 7], 1e-6));
    }
}
