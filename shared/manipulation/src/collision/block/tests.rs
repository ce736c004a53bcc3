use nalgebra::{Translation3, UnitQuaternion};

use super::*;
use crate::samples::Random;

fn random_block(random: &mut Random) -> Block {
    let mut number = |low, high| random.between(low, high);
    let turn =
        UnitQuaternion::from_euler_angles(number(-3.0, 3.0), number(-1.5, 1.5), number(-3.0, 3.0));
    let place = Translation3::new(number(-0.3, 0.3), number(-0.3, 0.3), number(-0.3, 0.3));
    let half = Vector3::new(number(0.01, 0.15), number(0.01, 0.15), number(0.01, 0.15));
    Block { pose: Isometry3::from_parts(place, turn), half }
}

/// Returns the least distance of points on a grid through a block from `outside`.
fn sampled(block: &Block, outside: impl Fn(&Vector3<f64>) -> f64) -> f64 {
    let axes = block.axes();
    let mut least = f64::INFINITY;
    let share = |k: i32| f64::from(k) / 8.0 - 1.0;
    for i in 0..=16 {
        for j in 0..=16 {
            for k in 0..=16 {
                let p = axes[0] * (share(i) * block.half.x)
                    + axes[1] * (share(j) * block.half.y)
                    + axes[2] * (share(k) * block.half.z);
                least = least.min(outside(&(block.centre() + p)));
            }
        }
    }
    least
}

fn outside(cuboid: &Cuboid, p: &Vector3<f64>) -> f64 {
    let p = p - Vector3::from(cuboid.centre);
    let axes = axes_of(cuboid);
    let beyond = Vector3::from_fn(|i, _| (axes[i].dot(&p).abs() - 0.5 * cuboid.size[i]).max(0.0));
    beyond.norm()
}

#[test]
fn box_overlap_agrees_with_sampled_points() {
    let seed = 41;
    let mut random = Random::seeded(seed);
    let (mut apart, mut overlapping) = (0, 0);
    for round in 0..3000 {
        let block = random_block(&mut random);
        let cuboid = Cuboid {
            centre: [random.between(-0.3, 0.3), random.between(-0.3, 0.3), 0.0],
            size: [0.05, 0.05, 0.05].map(|low| random.between(low, 0.4)),
            yaw: random.between(-3.0, 3.0),
        };
        let gap = block.to_cuboid(&cuboid);
        let least = sampled(&block, |p| outside(&cuboid, p));
        let grid_m = block.half.norm() / 8.0;
        let what = format!("seed {seed} round {round}: {gap} {least}");
        // Never more than the distance, and no overlap missed.
        assert!(gap <= least + 1e-9, "{what}");
        if least > grid_m {
            apart += 1;
            assert!(gap > 0.0, "{what}");
        } else if least == 0.0 {
            overlapping += 1;
            assert!(gap <= 0.0, "{what}");
        }
    }
    assert!(apart > 500 && overlapping > 500, "{apart} {overlapping}");
}

#[test]
fn box_distance_of_parallel_faces_is_exact() {
    let block = Block {
        pose: Isometry3::translation(0.0, 0.0, 0.10),
        half: Vector3::new(0.05, 0.04, 0.03),
    };
    let table = Cuboid::aligned([0.0, 0.0, -0.25], [2.0, 2.0, 0.5]);
    assert!((block.to_cuboid(&table) - 0.07).abs() < 1e-12);
    let sunk = Block { pose: Isometry3::translation(0.0, 0.0, 0.028), ..block };
    assert!((sunk.to_cuboid(&table) + 0.002).abs() < 1e-12);
    let turned = Cuboid { yaw: 0.7, ..table };
    assert!((block.to_cuboid(&turned) - 0.07).abs() < 1e-12);
    let far = Cuboid::aligned([5.0, 0.0, 0.0], [0.1; 3]);
    assert!(block.to_cuboid(&far) > 4.5);
}

#[test]
fn capsule_distance_is_that_of_its_nearest_point() {
    let seed = 42;
    let mut random = Random::seeded(seed);
    for round in 0..500 {
        let block = random_block(&mut random);
        let mut end = || Vector3::from_fn(|_, _| random.between(-0.4, 0.4));
        let capsule = Capsule { a: end(), b: end(), radius: 0.05 };
        let distance = block.to_capsule(&capsule);
        let least = sampled(&block, |p| {
            let along = capsule.b - capsule.a;
            let t = ((p - capsule.a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (capsule.a + along * t - p).norm() - capsule.radius
        });
        let what = format!("seed {seed} round {round}: {distance} {least}");
        assert!(distance <= least + 1e-9, "{what}");
        assert!(distance < -0.05 || distance > least - block.half.norm() / 8.0, "{what}");
    }
}

#[test]
fn box_corners_are_the_extremes() {
    let block = random_block(&mut Random::seeded(43));
    let corners = block.corners();
    let mean = corners.iter().sum::<Vector3<f64>>() / 8.0;
    assert!((mean - block.centre()).norm() < 1e-12);
    assert!(corners.iter().all(|c| ((c - mean).norm() - block.half.norm()).abs() < 1e-12));
}
