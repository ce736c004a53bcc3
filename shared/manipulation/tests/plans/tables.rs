//! Random tables, and the checker itself.

use manipulation::{MotionLimits, plan_pick, plan_point};

use super::robot;
use super::support::checker::{Checker, broken_limit};
use super::support::scenes;
use super::support::tables::{Bench, TABLE_Z_M, Tally, all_but, settings, try_table};
use super::support::ur5e;

/// `WHICHONE_TABLES=N` tries N tables instead of a few, `WHICHONE_SEED=S` others.
#[test]
fn plans_on_random_tables_touch_nothing() {
    let number = |key: &str| std::env::var(key).ok().and_then(|value| value.parse::<u64>().ok());
    let (count, seed) =
        (number("WHICHONE_TABLES").unwrap_or(4), number("WHICHONE_SEED").unwrap_or(1));
    println!("seed {seed}, {count} tables");
    let single = ur5e();
    for (robot, bench, checker) in [
        (robot(), Bench::baxter(), Checker::new(robot())),
        (&single, Bench::ur5e(), Checker::described(&single)),
    ] {
        let mut tally = Tally::default();
        for k in 0..count {
            tally.add(try_table(robot, &bench, &checker, seed * 1_000_000 + k));
        }
        assert_eq!(tally.violations, Vec::<String>::new(), "seed {seed}");
        let holdable = tally.objects - tally.too_wide - tally.refused_alone;
        let name = robot.description().name();
        println!("{name}: {} picked, {holdable} of {} in reach", tally.picked, tally.objects);
        assert!(tally.picked * 10 > holdable * 7, "{name}, seed {seed}: {tally:?}");
    }
}

#[test]
fn blocks_are_fetched_and_pointed_at_by_the_single_arm() {
    let (robot, bench) = (ur5e(), Bench::ur5e());
    let checker = Checker::described(&robot);
    let (names, poses): (Vec<String>, Vec<_>) = scenes::read("blocks").into_iter().unzip();
    let all: Vec<_> = poses.iter().map(manipulation::ObjectPose::cuboid).collect();
    let (neutral, settings) = (robot.neutral(), bench.settings);
    for (i, name) in names.iter().enumerate() {
        let others = all_but(&poses, i);
        let pick = plan_pick(&robot, &poses[i], None, &neutral, &others, &settings)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let limits = robot.arm(pick.limb()).limits.at_speed_ratio(settings.speed_ratio);
        assert!(broken_limit(&pick, &limits).is_none(), "{name}");
        let touched = checker.violation(&pick, &poses[i], &others, settings.table_z_m);
        assert!(touched.is_none(), "{name}: {touched:?}");
        assert_eq!(pick.at(1e9).q, robot.arm(pick.limb()).neutral, "{name}");
        let point = plan_point(&robot, poses[i].xyz_m, None, &neutral, &all, &settings)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(pick.duration_s() < 14.0 && point.duration_s() < 8.0, "{name}");
    }
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
