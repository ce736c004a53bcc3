//! The jaw: grasps, holds for minutes, notices what it loses.

use super::*;

/// Opens, closes and waits until the command is completed. The object stops the jaw at this share, percent.
fn grasped(object_percent: Option<f64>) -> Rig {
    let mut rig = Rig::new();
    // As lerobot sets the jaw's servo: overload after 2 s at a quarter of its torque.
    rig.bus.borrow_mut().servos[JAW].set_byte(36, 25);
    rig.until_ready(3.0);
    command(&mut rig, Fingers::Open(0.04));
    if let Some(percent) = object_percent {
        let mut bus = rig.bus.borrow_mut();
        let jaw = &mut bus.servos[JAW];
        jaw.blocked.0 = jaw.actual - jaw.shown() + 2033.0 + 14.57 * percent;
    }
    command(&mut rig, GRIP);
    rig
}

fn command(rig: &mut Rig, fingers: Fingers) {
    let began_s = rig.now_s();
    loop {
        let stay = rig.stay(fingers);
        rig.pass(Some(stay));
        if rig.driver.has_arrived(&stay, rig.now_s() - began_s).unwrap() {
            break;
        }
    }
    rig.pass(None);
}

fn holding(rig: &mut Rig) -> Option<bool> {
    rig.pass(None);
    rig.driver.measured().holding[0]
}

#[test]
fn object_is_held_for_five_minutes_without_overload() {
    let mut rig = grasped(Some(40.0));
    assert_eq!(holding(&mut rig), Some(true));
    rig.rest(300.0);
    assert_eq!(holding(&mut rig), Some(true));
    assert!(rig.faults.is_empty(), "{:?}", rig.faults);
    let bus = rig.bus.borrow();
    assert_eq!(bus.servos[JAW].errors(), 0);
    assert!((185..=200).contains(&bus.servos[JAW].word(48)));
    let squeeze = bus.servos[JAW].shown() - f64::from(bus.servos[JAW].word(42));
    assert!((20.0..60.0).contains(&squeeze), "{squeeze} steps below the object");
}

#[test]
fn closed_jaw_holds_nothing() {
    let mut rig = grasped(None);
    assert_eq!(holding(&mut rig), Some(false));
    assert!(rig.driver.measured().posture.width_m[0] < 0.005);
    command(&mut rig, Fingers::Open(0.04));
    assert_eq!(holding(&mut rig), Some(false));
    assert!((rig.driver.measured().posture.width_m[0] - 0.04).abs() < 0.003);
}

/// The motion stop's commands leave the fingers as they are, and are no fault.
#[test]
fn stop_keeps_a_closing_jaw_where_it_is() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    command(&mut rig, Fingers::Open(0.04));
    let [closing, stay] = [GRIP, Fingers::Stay].map(|fingers| rig.stay(fingers));
    (0..30).for_each(|_| rig.pass(Some(closing)));
    assert!(rig.speeds()[JAW] < -300.0, "it closes: {} steps/s", rig.speeds()[JAW]);
    let stopped = rig.steps(JAW);
    (0..100).for_each(|_| rig.pass(Some(stay)));
    let goal = f64::from(rig.bus.borrow().servos[JAW].word(42));
    // It brakes within 0.1 s of its motion, and moves back no further than that.
    assert!((goal - stopped).abs() < 90.0, "goal {goal}, stopped at {stopped}");
    assert!((rig.steps(JAW) - stopped).abs() < 90.0, "{} {stopped}", rig.steps(JAW));
    // Once it may move, it closes.
    command(&mut rig, GRIP);
    assert_eq!(holding(&mut rig), Some(false));
    assert!(rig.driver.measured().posture.width_m[0] < 0.005);
}

#[test]
fn lost_object_is_noticed_and_a_stop_keeps_hold() {
    let mut rig = grasped(Some(40.0));
    let stay = rig.stay(Fingers::Stay);
    (0..100).for_each(|_| rig.pass(Some(stay)));
    assert_eq!(holding(&mut rig), Some(true), "after a command to stay");
    rig.driver.hold_here();
    rig.rest(2.0);
    assert_eq!(holding(&mut rig), Some(true), "after a stop");
    let goal = rig.bus.borrow().servos[JAW].word(42);
    assert!(f64::from(goal) < rig.steps(JAW) - 20.0, "it still presses");
    rig.bus.borrow_mut().servos[JAW].blocked.0 = f64::NEG_INFINITY;
    rig.rest(2.0);
    assert_eq!(holding(&mut rig), Some(false));
}

#[test]
fn restarted_program_feels_what_the_jaw_holds() {
    let mut rig = grasped(Some(40.0));
    rig.rest(1.0);
    let bus = rig.bus.borrow().clone();
    let mut next = Rig::on(bus);
    next.until_ready(1.0);
    for _ in 0..200 {
        assert_eq!(holding(&mut next), Some(true));
    }
    let goal = next.bus.borrow().servos[JAW].word(42);
    assert!(f64::from(goal) < next.steps(JAW) - 20.0, "it still presses");
}

/// lerobot's single read raises after 2.19 s, and its reading of all servos never.
#[test]
fn jaw_that_is_blocked_by_force_ends_in_an_overload_that_is_named() {
    let mut rig = grasped(Some(40.0));
    {
        let mut bus = rig.bus.borrow_mut();
        bus.servos[JAW].set_byte(36, 10);
        bus.servos[JAW].set_byte(35, 50);
    }
    rig.rest(2.0);
    let (_, fault) = rig.faults.first().expect("a fault");
    assert!(fault.to_string().starts_with("gripper: overload"), "{fault}");
}
