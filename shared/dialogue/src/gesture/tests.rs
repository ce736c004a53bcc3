use super::*;
use crate::Belief;
use std::f64::consts::PI;
use vocabulary::Rng;

/// Somewhere in a box of two metres round the origin.
fn point(rng: &mut Rng) -> [f64; 3] {
    std::array::from_fn(|_| 4.0 * rng.uniform() - 2.0)
}

fn direction(rng: &mut Rng) -> Direction {
    loop {
        if let Some(direction) = Direction::between([0.0; 3], point(rng)) {
            return direction;
        }
    }
}

fn gestures(rng: &mut Rng) -> Gestures {
    Gestures {
        p_g: 0.05 + 0.9 * rng.uniform(),
        std_theta_rad: 0.02 + 0.9 * rng.uniform(),
        stray: 0.001 + 0.5 * rng.uniform(),
    }
}

fn cases() -> impl Iterator<Item = (u64, Rng)> {
    (0..200).map(|seed| (seed, Rng::new(seed)))
}

#[test]
fn the_density_is_one_of_angles() {
    for (seed, mut rng) in cases().take(20) {
        let gestures = gestures(&mut rng);
        const STEPS: usize = 20_000;
        let width = PI / STEPS as f64;
        let sum: f64 =
            (0..STEPS).map(|i| density(&gestures, (i as f64 + 0.5) * width) * width).sum();
        assert!((0.998..1.0 + 1e-6).contains(&sum), "seed {seed}: {gestures:?} sums to {sum}");
    }
}

#[test]
fn the_nearer_the_ray_the_likelier_the_object() {
    for (seed, mut rng) in cases() {
        let gestures = gestures(&mut rng);
        let ray = direction(&mut rng);
        let objects: Vec<_> = (0..8).map(|_| Some(direction(&mut rng))).collect();
        let log = log_likelihood(&gestures, Some(ray), &objects);
        for (i, a) in objects.iter().flatten().enumerate() {
            for (j, b) in objects.iter().flatten().enumerate() {
                if ray.angle(*a) < ray.angle(*b) {
                    assert!(log[i] >= log[j], "seed {seed}: {i} {j} {log:?}");
                }
            }
        }
    }
}

#[test]
fn no_gesture_and_no_direction_say_nothing() {
    for (seed, mut rng) in cases() {
        let gestures = gestures(&mut rng);
        let objects: Vec<_> = (0..5).map(|_| Some(direction(&mut rng))).collect();
        let mut belief = Belief::from_probabilities(&[0.1, 0.2, 0.3, 0.15, 0.25]).unwrap();
        let before = belief.clone();
        belief.weigh(&log_likelihood(&gestures, None, &objects));
        assert_eq!(belief, before, "seed {seed}");
        belief.weigh(&log_likelihood(&gestures, Some(direction(&mut rng)), &[None; 5]));
        assert_eq!(belief, before, "seed {seed}");
    }
}

/// However far off, a gesture leaves an object within reach of honest words: its weight against
/// another is bounded as stated at the head of the file.
#[test]
fn no_gesture_rules_an_object_out_for_ever() {
    for (seed, mut rng) in cases() {
        let gestures = gestures(&mut rng);
        let objects: Vec<_> = (0..8).map(|_| Some(direction(&mut rng))).collect();
        let log = log_likelihood(&gestures, Some(direction(&mut rng)), &objects);
        let (lambda, sigma) = (gestures.stray, gestures.std_theta_rad);
        let most = 1.0 + (1.0 - lambda) / lambda * (2.0 * PI).sqrt() / sigma;
        let largest = log.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = log.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least.is_finite() && (largest - least).exp() <= most * (1.0 + 1e-9), "seed {seed}");
    }
    let default = Gestures::default();
    let most = density(&default, 0.0) / density(&default, PI);
    assert!((317.0..319.0).contains(&most), "{most}");
}

/// The same bits as one multiplication in probabilities, up to rounding.
#[test]
fn an_update_is_bayes_rule() {
    for (seed, mut rng) in cases() {
        let prior: Vec<f64> = (0..6).map(|_| 0.01 + rng.uniform()).collect();
        let log: Vec<f64> = (0..6).map(|_| -8.0 * rng.uniform()).collect();
        let mut belief = Belief::from_probabilities(&prior).unwrap();
        belief.weigh(&log);
        let weights: Vec<f64> = prior.iter().zip(&log).map(|(p, l)| p * l.exp()).collect();
        let expected = Belief::from_probabilities(&weights).unwrap();
        for (a, b) in belief.probabilities().iter().zip(expected.probabilities()) {
            assert!((a - b).abs() < 1e-12, "seed {seed}: {a} {b}");
        }
    }
}

/// From farther and farther away the angle between two objects vanishes, and so does a gesture's
/// information about them; from near by, the object pointed at wins.
#[test]
fn pointing_at_an_object_finds_it_if_it_stands_apart() {
    let (here, there) = ([0.6, 0.3, 0.0], [0.6, -0.3, 0.0]);
    let posterior = |person| {
        let direction = |to| Direction::between(person, to);
        let objects = [direction(here), direction(there)];
        let mut belief = Belief::uniform(2);
        belief.weigh(&log_likelihood(&Gestures::default(), direction(here), &objects));
        belief.probabilities()[0]
    };
    assert!(posterior([1.6, 0.0, 0.4]) > 0.98);
    assert!(posterior([60.0, 0.0, 0.4]) < 0.51);
}
