//! Plans from postures in which an arm was halted or killed.

use manipulation::{Clearance, Cuboid, Limb, Phase, plan_delivery, plan_pick, plan_return};

use super::support::tables::{all_but, settings};
use super::support::{Random, scenes};
use super::{arms_with, assert_fetches, assert_hands_over, assert_sound, gripper, marker, robot};

#[test]
fn lifting_flows_into_the_hand_over() {
    let plan = plan_pick(robot(), &marker(), None, &robot().neutral(), &[], &settings()).unwrap();
    let (_, end) = plan.span_s(Phase::Lift).unwrap();
    assert!(plan.at(end).qd.iter().any(|v| v.abs() > 0.02), "no stop where none is needed");
}

#[test]
fn the_forced_limb_is_used_and_the_plan_repeats() {
    for limb in Limb::BOTH {
        let plan =
            || plan_pick(robot(), &marker(), Some(limb), &robot().neutral(), &[], &settings());
        let found = plan().unwrap();
        assert_eq!(found.limb(), limb);
        assert_fetches(&found, &marker(), limb.name());
        assert_eq!(plan().unwrap(), found);
    }
}

#[test]
fn a_pick_may_start_anywhere() {
    let seed = 71;
    let mut random = Random::seeded(seed);
    let table = [Cuboid::aligned([0.95, 0.0, -0.4], [1.1, 2.4, 0.5])];
    let mut planned = 0;
    while planned < 3 {
        let limits = &robot().arm(Limb::Right).limits.position;
        let arms = arms_with(Limb::Right, limits.at(&std::array::from_fn(|_| random.unit())));
        let clear = Clearance::of(robot(), &arms, &table);
        if clear.robot().distance_m < 0.03 || clear.surroundings[1].distance_m < 0.01 {
            continue;
        }
        let what = format!("seed {seed}: {arms:?}");
        let plan = plan_pick(robot(), &marker(), Some(Limb::Right), &arms, &[], &settings())
            .unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!(plan.at(0.0).q, arms[1]);
        assert_sound(&plan, &[], &what);
        planned += 1;
    }
}

#[test]
fn held_object_is_delivered_from_every_moment_of_its_path() {
    let bowls: Vec<_> = scenes::read("bowls").into_iter().map(|(_, pose)| pose).collect();
    for (i, bowl) in bowls.iter().enumerate().skip(1).take(3) {
        let others = all_but(&bowls, i);
        let neutral = robot().neutral();
        let whole = plan_pick(robot(), bowl, None, &neutral, &others, &settings()).unwrap();
        let limb = whole.limb();
        let (from, _) = whole.span_s(Phase::Lift).unwrap();
        let (_, to) = whole.span_s(Phase::HandOver).unwrap();
        let in_gripper = gripper(&whole, from).inverse() * bowl.isometry();
        for k in 0..=24 {
            let t = from + (to - from) * f64::from(k) / 24.0;
            let what = format!("bowl {i} at {t}");
            let arms = arms_with(limb, whole.halted_at(t).end());
            let rest = plan_delivery(robot(), bowl, &in_gripper, limb, &arms, &others, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(rest.at(0.0).q, arms[limb], "{what}");
            assert_eq!(rest.stages()[0].phase, Phase::Lift, "{what}");
            assert_sound(&rest, &others, &what);
            assert_hands_over(&rest, &what);
        }
    }
}

#[test]
fn arm_returns_from_every_moment_of_a_pick() {
    let bowls: Vec<_> = scenes::read("bowls").into_iter().map(|(_, pose)| pose).collect();
    let others = all_but(&bowls, 1);
    let neutral = robot().neutral();
    let whole = plan_pick(robot(), &bowls[1], None, &neutral, &others, &settings()).unwrap();
    for k in 0..8 {
        let t = whole.duration_s() * f64::from(k) / 7.0;
        let arms = arms_with(whole.limb(), whole.halted_at(t).end());
        let home = plan_return(robot(), whole.limb(), &arms, &others, &settings())
            .unwrap_or_else(|error| panic!("at {t}: {error}"));
        assert_sound(&home, &others, &format!("at {t}"));
        assert_eq!(home.stages().len(), 1);
    }
}

#[test]
fn a_plan_is_halted_on_its_path() {
    let plan = plan_pick(robot(), &marker(), None, &robot().neutral(), &[], &settings()).unwrap();
    for k in 0..20 {
        let t = plan.duration_s() * f64::from(k) / 19.0;
        let halt = plan.halted_at(t);
        assert!(halt.duration_s() <= 0.1 + 1e-9);
        let (start, there) = (halt.start(), plan.at(t).q);
        assert!((0..7).all(|j| (start[j] - there[j]).abs() < 1e-9));
        assert!(halt.sample(halt.duration_s()).1.iter().all(|v| v.abs() < 1e-6));
    }
}
