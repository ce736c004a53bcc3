//! Every motion begins where the arm stands, also where a person moved it.

use super::*;

/// Returns the joints of a limb, at rest but for one.
fn moved(machine: &Machine, limb: Limb, joint: usize, q_rad: f64) -> Joints {
    let mut q = machine.joints_of(limb);
    q[joint] = q_rad;
    q
}

#[test]
fn pick_begins_where_a_person_left_the_limb() {
    for limb in Limb::BOTH {
        let mut machine = Machine::new(config_at(10.0));
        machine.robot.push(limb, 0.25);
        machine.act(pick(1, 2));
        machine.delivers(1, 2);
    }
}

#[test]
fn pick_begins_with_a_joint_outside_its_limits() {
    let mut machine = Machine::new(config_at(10.0));
    let (_, upper) = machine.config.setup.robot.arm(Limb::Left).limits.position.0[5];
    let q = moved(&machine, Limb::Left, 5, upper + 0.1);
    machine.robot.place(Limb::Left, q);
    machine.act(pick(1, 2));
    machine.delivers(1, 2);
    machine.run_until("at rest", Machine::rests);
}

#[test]
fn arm_killed_with_a_joint_outside_its_limits_starts_again() {
    let mut machine = Machine::new(config_at(10.0));
    let (_, upper) = machine.config.setup.robot.arm(Limb::Left).limits.position.0[5];
    machine.motion(MotionOrder::Stop);
    machine.go(None);
    let q = moved(&machine, Limb::Left, 5, upper + 0.1);
    machine.robot.place(Limb::Left, q);
    machine.act(pick(1, 3));
    machine.run(0.5);
    machine.restart_from_journal();
    machine.motion(MotionOrder::Resume);
    machine.delivers(1, 3);
}

#[test]
fn pick_begins_with_the_limb_in_collision() {
    let mut machine = Machine::new(config_at(10.0));
    // The elbow hangs into the table.
    let arm = machine.config.setup.robot.arm(Limb::Left).clone();
    let table = manipulation::Cuboid::aligned([0.9, 0.0, -0.405], [1.3, 4.0, 0.5]);
    let hits = |q: &Joints| {
        let shape = manipulation::ArmShape::at(&arm, q);
        shape.to_cuboid("table", &table, -0.01).is_some()
    };
    let lowered = (0..100).map(|k| moved(&machine, Limb::Left, 1, f64::from(k) * 0.01));
    let q = lowered.into_iter().find(hits).expect("a posture in the table");
    machine.robot.place(Limb::Left, q);
    machine.act(pick(1, 2));
    machine.delivers(1, 2);
}

#[test]
fn pick_ends_with_an_error_where_the_limits_are_in_doubt_and_goes_on_once_they_are_not() {
    let mut machine = Machine::new(config_at(10.0));
    let rest = machine.joints_of(Limb::Left);
    let (_, upper) = machine.config.setup.robot.arm(Limb::Left).limits.position.0[5];
    let q = moved(&machine, Limb::Left, 5, upper + 1.0);
    machine.robot.place(Limb::Left, q);
    machine.act(pick(1, 2));
    machine.run_until("refused", |m| m.outcome() == PickOutcome::Unreachable);
    assert_eq!(machine.joints_of(Limb::Left), q, "nothing moved");
    machine.robot.place(Limb::Left, rest);
    machine.act(pick(2, 2));
    machine.delivers(2, 2);
}
