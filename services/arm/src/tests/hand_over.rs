//! A user may hold what was handed over between the open fingers: the gripper withdraws from it along
//! its fingers, whatever comes meanwhile.

use super::*;

/// Height of the white bowls' rims above the fingertips that hold them, metres: the fingers are clear of
/// them above it.
const DEPTH_M: f64 = 0.02;
/// Distance from where it handed an object over within which the gripper may still surround it, metres.
const NEAR_M: f64 = 0.1;
/// Distance from where it handed an object over at which the gripper may wait, metres. Nearer, a user may
/// take it to be asking for the object.
const AWAY_M: f64 = 0.05;
/// Largest motion across the fingers while the object is between them, metres and radians.
const ASIDE: (f64, f64) = (0.002, 0.01);

/// What happens just after the fingers have opened.
type Then = fn(&mut Machine);

/// Returns a machine that has just delivered object 0, with a planner as slow as on a busy computer, and
/// the limb that did.
fn delivered() -> (Machine, Limb) {
    let mut machine = Machine::picking(config(), 0, PickPhase::Holding);
    machine.planning_time = Span::from_ms(1_200);
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    let limb = machine.node.state().limb.unwrap();
    (machine, limb)
}

/// Lets `then` happen after `after_s`, and watches the gripper, which has an object between its open
/// fingers, until it is away from there. Returns how long it has stood there since.
fn withdraws((mut machine, limb): (Machine, Limb), after_s: f64, then: Then) -> f64 {
    let released = machine.tip(limb);
    let (until, deadline) = (machine.now + Span::from_s(after_s), machine.now + Span::from_s(40.0));
    let (mut happened, mut waited_s, mut far_m) = (false, 0.0, 0.0);
    while !happened || far_m < NEAR_M {
        assert!(machine.now < deadline, "{after_s} s: {:?}", machine.node.state());
        if machine.now >= until && !happened {
            happened = true;
            then(&mut machine);
        }
        let before = (machine.now, machine.tip(limb).translation.vector);
        machine.go(None);
        let off = released.inverse() * machine.tip(limb);
        let back_m = -off.translation.z;
        far_m = off.translation.vector.norm();
        if back_m < DEPTH_M {
            let (aside_m, turned) = (off.translation.vector.xy().norm(), off.rotation.angle());
            assert!(
                aside_m < ASIDE.0 && turned < ASIDE.1,
                "{after_s} s: {aside_m} m aside and turned by {turned} after {back_m} m back"
            );
        }
        let moved_m = (machine.tip(limb).translation.vector - before.1).norm();
        if far_m < AWAY_M && moved_m < 1e-6 {
            waited_s += machine.now.since(before.0).s();
        }
    }
    machine.run_until("at rest", Machine::rests);
    machine.robot.assert_well_behaved();
    waited_s
}

#[test]
fn the_gripper_withdraws_along_its_fingers_though_another_pick_is_ordered() {
    let orders: [Then; 2] = [|machine| machine.act(pick(2, 1)), |machine| machine.act(pick(2, 5))];
    for after_s in [0.0, 0.1, 0.2, 0.3, 0.5, 0.8] {
        for order in orders {
            let waited_s = withdraws(delivered(), after_s, order);
            assert!(waited_s < 0.5, "{after_s} s: it has waited there for {waited_s} s");
        }
    }
}

#[test]
fn the_gripper_withdraws_along_its_fingers_after_a_stop_and_after_a_restart() {
    for after_s in [0.0, 0.1, 0.2, 0.3] {
        withdraws(delivered(), after_s, |machine| {
            machine.motion(MotionOrder::Stop);
            machine.run(1.5);
            machine.motion(MotionOrder::Resume);
        });
        withdraws(delivered(), after_s, Machine::restart);
        withdraws(delivered(), after_s, |machine| {
            machine.act(point(20, 5));
            machine.run(1.0);
            machine.act(say(21));
        });
    }
}

/// "Keep it", while the user holds it between the fingers.
#[test]
fn the_gripper_withdraws_along_its_fingers_when_putting_back_is_called_off() {
    let (mut machine, limb) = delivered();
    let released = machine.tip(limb).translation.vector;
    machine.run(1.5);
    let put_back = RobotAct { act: 15, kind: ActKind::PutBack.code(), attempt: 2, ..pick(1, 0) };
    machine.act(put_back);
    machine.run_until("it is there again", |m| {
        (m.tip(limb).translation.vector - released).norm() < 0.001
    });
    machine.run(0.5);
    assert_eq!(machine.phase(), PickPhase::Moving);
    machine.act(RobotAct { act: 16, kind: ActKind::Cancel.code(), ..put_back });
    withdraws((machine, limb), 0.0, |_| {});
}
