use super::*;
use crate::samples::Random;

fn point(random: &mut Random, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.between(-size, size))
}

fn capsule(random: &mut Random) -> Capsule {
    Capsule { a: point(random, 1.0), b: point(random, 1.0), radius: random.between(0.0, 0.2) }
}

/// Points along a capsule's axis, close together.
fn along(capsule: &Capsule) -> impl Iterator<Item = Vector3<f64>> + '_ {
    (0..=400).map(|k| capsule.a.lerp(&capsule.b, f64::from(k) / 400.0))
}

#[test]
fn capsule_distances_agree_with_sampling() {
    let mut random = Random::seeded(51);
    for _ in 0..100 {
        let (p, q) = (capsule(&mut random), capsule(&mut random));
        let sampled = along(&p)
            .flat_map(|x| along(&q).step_by(8).map(move |y| (x - y).norm()))
            .fold(f64::INFINITY, f64::min);
        let found = p.to_capsule(&q) + p.radius + q.radius;
        assert!(found <= sampled + 1e-12 && found > sampled - 0.04, "{found} {sampled}");
        assert!((p.to_capsule(&q) - q.to_capsule(&p)).abs() < 1e-12);
    }
}

#[test]
fn parallel_and_pointlike_capsules_have_distances() {
    let at = |y: f64| Capsule {
        a: Vector3::new(0.0, y, 0.0),
        b: Vector3::new(1.0, y, 0.0),
        radius: 0.1,
    };
    assert!((at(0.0).to_capsule(&at(0.5)) - 0.3).abs() < 1e-12);
    let dot =
        Capsule { a: Vector3::new(3.0, 0.0, 0.0), b: Vector3::new(3.0, 0.0, 0.0), radius: 0.1 };
    assert!((dot.to_capsule(&at(0.0)) - 1.8).abs() < 1e-9);
    assert!((at(0.0).to_capsule(&dot) - 1.8).abs() < 1e-9);
}

#[test]
fn box_distances_agree_with_sampling_outside() {
    let mut random = Random::seeded(52);
    for _ in 0..500 {
        let p = capsule(&mut random);
        let cuboid = Cuboid {
            centre: point(&mut random, 0.5).into(),
            size: std::array::from_fn(|_| random.between(0.1, 0.8)),
            yaw: random.between(-3.0, 3.0),
        };
        let half = Vector3::from(cuboid.size) * 0.5;
        let sampled = along(&p)
            .map(|x| {
                let x = cuboid.local(&x);
                (x - Vector3::from_fn(|i, _| x[i].clamp(-half[i], half[i]))).norm()
            })
            .fold(f64::INFINITY, f64::min);
        let found = p.to_cuboid(&cuboid) + p.radius;
        if sampled > 0.0 && found > 0.0 {
            assert!(found <= sampled + 1e-12 && found > sampled - 0.01, "{found} {sampled}");
        } else {
            assert!(found <= 1e-2, "{found} {sampled}");
        }
    }
}

/// Moved out of the box by its depth, and no less, a segment that met it touches it no more.
#[test]
fn depth_in_a_box_is_the_shortest_way_out() {
    let mut random = Random::seeded(53);
    let half = Vector3::new(0.3, 0.2, 0.5);
    let cuboid = Cuboid::aligned([0.0; 3], (half * 2.0).into());
    let mut met = 0;
    for _ in 0..300 {
        let p = Capsule { radius: 0.0, ..capsule(&mut random) };
        let depth = -p.to_cuboid(&cuboid);
        if depth <= 1e-6 {
            continue;
        }
        met += 1;
        let mut freed = false;
        for _ in 0..400 {
            let way = point(&mut random, 1.0).normalize();
            let moved = |by: f64| Capsule { a: p.a + way * by, b: p.b + way * by, ..p };
            assert!(moved(depth * 0.99).to_cuboid(&cuboid) <= 1e-12, "{p:?} {way:?}");
            freed |= moved(depth * 1.3).to_cuboid(&cuboid) > 0.0;
        }
        assert!(freed, "{p:?} {depth}");
    }
    assert!(met > 50);
}
