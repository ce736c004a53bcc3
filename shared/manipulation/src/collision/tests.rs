use super::*;
use crate::samples::{Random, arm, joints, named, neutral, numbers, robot, table};

/// The table of the reference.
const TABLE: Cuboid = Cuboid::aligned([0.9, 0.0, -0.2], [0.6, 1.4, 0.04]);

#[test]
fn clearances_equal_the_reference() {
    let (_, rows) = table("clearance_reference.csv");
    assert_eq!(rows.len(), 100);
    for row in rows {
        let n = numbers(&row[..23]);
        let found = Clearance::of(robot(), &[joints(&n[..7]), joints(&n[7..14])], &[TABLE]);
        let pairs = [found.body, found.own, found.surroundings];
        let groups = std::iter::once(found.arms).chain(pairs.into_iter().flatten());
        for (group, expected) in groups.zip(&n[14..21]) {
            assert!((group.distance_m - expected).abs() < 1e-6, "{group:?} {expected}");
        }
        if found.robot().distance_m.abs() > 1e-4 {
            assert_eq!(found.robot().distance_m < 0.0, n[21] == 1.0, "{row:?}");
        }
    }
}

#[test]
fn collision_pairs_omit_only_permanent_overlaps() {
    let arm = arm(Limb::Left);
    let count = arm.enclosures.len();
    let left_out: Vec<(usize, usize)> = (0..count)
        .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
        .filter(|(i, j)| arm.enclosures[*j].joint >= arm.enclosures[*i].joint + 2)
        .filter(|pair| !arm.pairs.contains(pair))
        .collect();
    assert_eq!(left_out, [(0, 3), (4, 7)]);
}

#[test]
fn clearance_bound_is_exact_below_and_truncates_above() {
    let mut random = Random::seeded(41);
    for _ in 0..300 {
        let limb = random.limb();
        let [own, other] = [limb, limb.other().unwrap()].map(|limb| robot().arm(limb));
        let arm = ArmShape::at(own, &random.posture());
        let other = ArmShape::at(other, &random.posture());
        let asks: [&dyn Fn(f64) -> Gap; 4] = [
            &|within| arm.to_itself(within),
            &|within| arm.to_trunk(within),
            &|within| arm.to_arm(&other, within),
            &|within| arm.to_cuboid("table", &TABLE, within),
        ];
        for ask in asks {
            let whole = ask(f64::INFINITY);
            assert!(whole.is_some());
            for within in [-0.05, 0.0, 0.01, 0.2] {
                let bounded = ask(within);
                if whole.distance_m < within {
                    assert_eq!(bounded, whole);
                } else {
                    assert_eq!(bounded, Gap::none(within));
                }
            }
        }
    }
}

#[test]
fn named_postures_are_clear_except_the_tuck() {
    let clear = |q: [Joints; 2]| Clearance::of(robot(), &q, &[]).robot().distance_m;
    assert!(clear([neutral(); 2]) > 0.06);
    assert!(clear(Limb::BOTH.map(|limb| named(limb, "untuck"))) > 0.02);
    assert!(clear(Limb::BOTH.map(|limb| named(limb, "tuck"))) < -0.07);
}
