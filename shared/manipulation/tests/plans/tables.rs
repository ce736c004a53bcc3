//! Random tables, and the checker itself.

use manipulation::{MotionLimits, plan_pick};

use super::robot;
use super::support::checker::{Checker, broken_limit};
use super::support::scenes;
use super::support::tables::{TABLE_Z_M, Tally, all_but, settings, try_table};

/// `WHICHONE_TABLES=N` tries N tables instead of a few, `WHICHONE_SEED=S` others.
#[test]
fn plans_on_random_tables_touch_nothing() {
    let number = |key: &str| std::env::var(key).ok().and_then(|value| value.parse::<u64>().ok());
    let (count, seed) =
        (number("WHICHONE_TABLES").unwrap_or(4), number("WHICHONE_SEED").unwrap_or(1));
    println!("seed {seed}, {count} tables");
    let robot = robot();
    let checker = Checker::new(robot);
    let mut tally = Tally::default();
    for k in 0..count {
        tally.add(try_table(robot, &checker, seed * 1_000_000 + k));
    }
    assert_eq!(tally.violations, Vec::<String>::new(), "seed {seed}");
    let holdable = tally.objects - tally.too_wide - tally.refused_alone;
    println!("{} picked of {} objects, {holdable} of them in reach", tally.picked, tally.objects);
    assert!(tally.picked * 10 > holdable * 7, "seed {seed}: {tally:?}");
}

/// A plan that is bent out of shape is found out.
#[test]
fn collision_checker_detects_contact() {
    let robot = robot();
    let checker = Checker::new(robot);
    let poses: Vec<_> = scenes::read("bowls").into_iter().map(|(_, pose)| pose).collect();
    let others = all_but(&poses, 1);
    let plan = plan_pick(robot, &poses[1], None, &robot.neutral(), &others, &settings()).unwrap();
    assert!(checker.violation(&plan, &poses[1], &others, TABLE_Z_M).is_none());
    // The table a little higher, or something in the way, and the same plan touches it.
    let high = checker.violation(&plan, &poses[1], &others, TABLE_Z_M + 0.01);
    assert!(high.is_some_and(|wrong| wrong.what.contains("the table")));
    let mut more = others.clone();
    let mut post = poses[1].cuboid();
    let end = robot.arm(plan.limb()).chain.forward(&plan.at(0.7 * plan.duration_s()).q);
    (post.centre, post.size) = (end.translation.vector.into(), [0.03; 3]);
    more.push(post);
    assert!(checker.violation(&plan, &poses[1], &more, TABLE_Z_M).is_some());
    let limits = robot.arm(plan.limb()).limits;
    for wrong in [
        MotionLimits { velocity: [0.05; 7], ..limits },
        MotionLimits { acceleration: [0.5; 7], ..limits },
        MotionLimits { jerk: [2.0; 7], ..limits },
    ] {
        assert!(broken_limit(&plan, &wrong).is_some());
    }
}
