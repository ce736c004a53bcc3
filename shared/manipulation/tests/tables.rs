//! Whole plans carried out and checked by a checker that shares no code with the planner: every
//! bowl at every place of its scene, and random tables.
#![allow(clippy::unwrap_used, reason = "a test ends at what it does not expect")]

mod support;

use manipulation::{ObjectPose, Robot, plan_pick};
use support::checker::{Checker, broken_limit};
use support::tables::{Tally, all_but, settings, try_table};
use support::{scenes, tables};

#[test]
fn every_bowl_is_picked_and_handed_over_at_every_place() {
    let robot = Robot::baxter();
    let checker = Checker::new(robot);
    let (names, poses): (Vec<String>, Vec<ObjectPose>) = scenes::read("bowls").into_iter().unzip();
    let places = scenes::attribute("bowls", "location");
    for (i, name) in names.iter().enumerate() {
        for k in 0..poses.len() {
            let objects = scenes::swapped(&poses, i, k);
            let others = all_but(&objects, i);
            let what = format!("{name} at {}'s place ({})", names[k], places[k]);
            let plan = plan_pick(robot, &objects[i], None, &robot.neutral(), &others, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            println!("{what}: {} arm, {:.2} s", plan.limb(), plan.duration_s());
            let limits = robot.arm(plan.limb()).limits.at_speed_ratio(settings().speed_ratio);
            let broken = broken_limit(&plan, &limits);
            assert!(broken.is_none(), "{what}: {broken:?}");
            // The rack is below the table's top, so the checker's table is lower there.
            let table_z_m = settings().table_z_m.min(objects[i].bottom_z_m());
            let touched = checker.violation(&plan, &objects[i], &others, table_z_m);
            assert!(touched.is_none(), "{what}: {touched:?}");
            assert!(plan.duration_s() < 16.0, "{what}: {}", plan.duration_s());
        }
    }
}

/// `WHICHONE_TABLES=N` tries N tables instead of a few, `WHICHONE_SEED=S` others.
#[test]
fn plans_on_random_tables_touch_nothing() {
    let number = |key: &str| std::env::var(key).ok().and_then(|value| value.parse::<u64>().ok());
    let (count, seed) =
        (number("WHICHONE_TABLES").unwrap_or(4), number("WHICHONE_SEED").unwrap_or(1));
    println!("seed {seed}, {count} tables");
    let robot = Robot::baxter();
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
    let robot = Robot::baxter();
    let checker = Checker::new(robot);
    let (_, poses): (Vec<String>, Vec<ObjectPose>) = scenes::read("bowls").into_iter().unzip();
    let others = all_but(&poses, 1);
    let plan = plan_pick(robot, &poses[1], None, &robot.neutral(), &others, &settings()).unwrap();
    let table_z_m = tables::TABLE_Z_M;
    assert!(checker.violation(&plan, &poses[1], &others, table_z_m).is_none());
    // The table a little higher, or something in the way, and the same plan touches it.
    let high = checker.violation(&plan, &poses[1], &others, table_z_m + 0.01);
    assert!(high.is_some_and(|wrong| wrong.what.contains("the table")));
    let mut more = others.clone();
    let mut post = poses[1].cuboid();
    let end = robot.arm(plan.limb()).chain.forward(&plan.at(0.7 * plan.duration_s()).q);
    (post.centre, post.size) = (end.translation.vector.into(), [0.03; 3]);
    more.push(post);
    assert!(checker.violation(&plan, &poses[1], &more, table_z_m).is_some());
    let limits = robot.arm(plan.limb()).limits;
    for wrong in [
        manipulation::MotionLimits { velocity: [0.05; 7], ..limits },
        manipulation::MotionLimits { acceleration: [0.5; 7], ..limits },
        manipulation::MotionLimits { jerk: [2.0; 7], ..limits },
    ] {
        assert!(broken_limit(&plan, &wrong).is_some());
    }
}
