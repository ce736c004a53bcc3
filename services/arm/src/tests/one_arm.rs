//! A robot with one limb and six joints.

use super::*;

fn single() -> Config {
    let mut config = shipped(Some("ur5e"), &[]);
    config.arm.time_scale = 10.0;
    config
}

#[test]
fn single_arm_delivers_every_block() {
    let mut machine = Machine::new(single());
    for object in 0..8 {
        machine.act(pick(u64::from(object) + 1, object));
        machine.delivers(u64::from(object) + 1, object);
    }
    machine.run_until("at rest", Machine::rests);
    assert_eq!(machine.robot.grasps(), 8);
    let measured = machine.robot.measured();
    assert_eq!(measured.posture.joints[0][6], 0.0, "there is no seventh joint");
}

#[test]
fn single_arm_points_then_picks_from_where_it_points() {
    let mut machine = Machine::new(single());
    machine.act(point(1, 3));
    machine.run_until("aimed", |m| m.status().aimed_act == 1);
    machine.act(pick(2, 6));
    machine.delivers(2, 6);
}

#[test]
fn single_arm_resumes_after_a_kill_in_every_phase() {
    for phase in [PickPhase::Moving, PickPhase::Closing, PickPhase::Holding] {
        let mut machine = Machine::picking(single(), 4, phase);
        machine.restart();
        machine.delivers(1, 4);
        assert!(machine.robot.grasps() <= 2, "{phase:?}");
    }
}
