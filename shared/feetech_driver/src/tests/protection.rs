//! Servos that protect themselves, lose their supply or restart.

use super::*;

/// A name, and what befalls a servo.
type Case<'a> = (&'a str, &'a dyn Fn(&mut servo_bus::Servo));

/// Longest time from the fault of one servo to the rest of the others, seconds.
const REST_MAX_S: f64 = 0.1;

/// Swings, lets something happen to one servo, and returns how long the others took to hold, seconds, with the fault.
fn others_hold(place: usize, happen: impl FnOnce(&mut servo_bus::Servo)) -> (f64, Fault, Rig) {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    while rig.now_s() - rig.began_s < 1.0 {
        let swing = rig.swing(Fingers::Stay);
        rig.pass(Some(swing));
    }
    while rig.speeds()[usize::from(place == 0)].abs() < 300.0 {
        let swing = rig.swing(Fingers::Stay);
        rig.pass(Some(swing));
    }
    happen(&mut rig.bus.borrow_mut().servos[place]);
    let mut begun_s = None;
    loop {
        if begun_s.is_none() && rig.bus.borrow().servos[place].errors() != 0 {
            begun_s = Some(rig.now_s());
        }
        assert!(rig.now_s() - rig.began_s < 8.0, "no fault: {:?}", rig.driver.inhibit());
        // The arm drops its program at a fault.
        let swing = rig.faults.is_empty().then(|| rig.swing(Fingers::Stay));
        rig.pass(swing);
        let rests = rig
            .speeds()
            .iter()
            .enumerate()
            .all(|(other, speed)| other == place || speed.abs() < 30.0);
        if let (Some(begun_s), Some((_, fault)), true) = (begun_s, rig.faults.first(), rests) {
            return (rig.now_s() - begun_s, fault.clone(), rig);
        }
    }
}

#[test]
fn each_overloaded_hot_or_underfed_servo_is_named_and_the_others_hold_within_a_tenth_of_a_second() {
    let mut longest_s: f64 = 0.0;
    for (place, (joint, ..)) in SERVOS.iter().enumerate() {
        let overload = |servo: &mut servo_bus::Servo| {
            // It comes soon where the joint is blocked; a swing leaves the blocked place within two seconds.
            servo.set_byte(35, 5);
            servo.set_byte(36, 2);
            servo.blocked = (servo.actual - 1.0, servo.actual + 1.0);
        };
        let heat = |servo: &mut servo_bus::Servo| servo.celsius = 75.0;
        let dip = |servo: &mut servo_bus::Servo| servo.volts = 3.6;
        let cases: [Case; 3] = [("overload", &overload), ("overheated", &heat), ("voltage", &dip)];
        // The jaw does not swing, and is not overloaded by standing still.
        for (reason, happen) in
            cases.into_iter().filter(|(reason, _)| place != JAW || *reason != "overload")
        {
            let (took_s, fault, rig) = others_hold(place, happen);
            let text = fault.to_string();
            assert!(
                matches!(fault, Fault::Part { .. })
                    && text.starts_with(joint)
                    && text.contains(reason),
                "{text}"
            );
            assert!(took_s <= REST_MAX_S, "{joint}, {reason}: {took_s:.3} s");
            assert_eq!(rig.driver.inhibit(), MotionInhibit::Error);
            for other in (0..7).filter(|other| *other != place) {
                assert!(
                    rig.bus.borrow().servos[other].holds(),
                    "{other} holds after {reason} of {joint}"
                );
            }
            longest_s = longest_s.max(took_s);
        }
    }
    println!("20 faults of single servos: the others at rest after {longest_s:.3} s at most");
}

#[test]
fn hot_servo_holds_again_where_it_stands_once_it_is_cool_and_not_before() {
    let (_, _, mut rig) = others_hold(1, |servo| (servo.celsius, servo.sag) = (75.0, -60.0));
    rig.rest(1.0);
    assert!(!rig.bus.borrow().servos[1].holds());
    rig.bus.borrow_mut().servos[1].celsius = 65.0;
    rig.rest(2.5);
    assert!(!rig.bus.borrow().servos[1].holds(), "still warm");
    rig.bus.borrow_mut().servos[1].celsius = 55.0;
    rig.until_ready(3.0);
    let fallen = rig.steps(1);
    rig.rest(1.0);
    assert!((rig.steps(1) - fallen).abs() < 6.0, "{fallen} {}", rig.steps(1));
    assert_eq!(
        rig.faults.iter().filter(|(_, fault)| matches!(fault, Fault::Part { .. })).count(),
        1
    );
}

/// The session that begins then has told no servo to hold.
#[test]
fn joint_that_is_limp_when_the_port_is_opened_anew_stays_where_it_is_put() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    rig.bus.borrow_mut().servos[1].celsius = 75.0;
    rig.rest(0.2);
    assert!(!rig.bus.borrow().servos[1].holds());
    rig.session = Err(Ended("unplugged".to_owned()));
    rig.rest(1.5);
    assert!(rig.session.is_ok());
    for _ in 0..100 {
        let at = rig.steps(1) + 1.0;
        rig.bus.borrow_mut().servos[1].stand_at(at);
        rig.pass(None);
    }
    let put = rig.steps(1);
    rig.bus.borrow_mut().servos[1].celsius = 55.0;
    rig.until_ready(4.0);
    rig.rest(1.0);
    assert!((rig.steps(1) - put).abs() < 6.0, "{put} {}", rig.steps(1));
}

/// lerobot notices nothing, and reads 97 degrees where the joint stands at 0.
#[test]
fn power_dip_is_noticed_and_a_servo_that_has_lost_its_calibration_is_refused() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    for _ in 0..50 {
        let swing = rig.swing(Fingers::Stay);
        rig.pass(Some(swing));
    }
    rig.bus.borrow_mut().servos.iter_mut().for_each(servo_bus::Servo::power_on);
    rig.rest(0.1);
    let (_, fault) = rig.faults.first().expect("a fault");
    assert!(fault.to_string().contains("restarted"), "{fault}");
    assert_eq!(rig.driver.inhibit(), MotionInhibit::Error);
    rig.until_ready(4.0);
    // Calibrated while the lock was closed, as lerobot may leave it: the values are lost.
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    {
        let mut bus = rig.bus.borrow_mut();
        let mut new = servo_bus::Servo::new(2);
        new.stand_at(2048.0);
        bus.servos[1] = new;
    }
    rig.rest(3.0);
    let text = rig.session.as_ref().err().map(ToString::to_string).unwrap_or_default();
    assert!(
        text.contains("servo 2 (shoulder_lift_joint) has homing_offset 0, the file 1105"),
        "{text}"
    );
    assert!(text.contains("whichone robot servos --write-calibration"), "{text}");
    assert_eq!(rig.driver.inhibit(), MotionInhibit::Unheard);
}
