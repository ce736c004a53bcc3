//! Beginning to hold, goals, and what is on the bus.

use super::*;

#[test]
fn servos_begin_to_hold_where_they_stand() {
    let seed = servo_bus::seed();
    let mut rng = vocabulary::Rng::new(seed);
    for _ in 0..20 {
        let mut rig = Rig::new();
        for (place, (_, _, least, most)) in SERVOS.iter().enumerate() {
            let span = (f64::from(*least) + 5.0, f64::from(*most) - 5.0);
            let mut bus = rig.bus.borrow_mut();
            bus.servos[place].stand_at(rng.between(span));
            // A goal from long ago, far away.
            bus.servos[place].set_byte(42, rng.below(256) as u8);
            bus.servos[place].set_byte(43, 8);
        }
        let stood: Vec<f64> = (0..7).map(|place| rig.steps(place)).collect();
        rig.until_ready(3.0);
        for (place, stood) in stood.iter().enumerate() {
            assert!(
                (rig.steps(place) - stood).abs() < 3.0,
                "seed {seed}, servo {place}: {stood} {}",
                rig.steps(place)
            );
            assert!(rig.bus.borrow().servos[place].holds());
        }
        assert!(rig.faults.is_empty(), "seed {seed}: {:?}", rig.faults);
    }
}

#[test]
fn torque_grows_in_half_a_second() {
    let mut rig = Rig::new();
    let mut limits = Vec::new();
    while rig.driver.inhibit() != MotionInhibit::None {
        rig.pass(None);
        let bus = rig.bus.borrow();
        limits.extend(bus.servos[0].holds().then(|| bus.servos[0].word(48)));
    }
    let [first, .., last] = limits[..] else { panic!("{limits:?}") };
    // The last figures of a limit are the number of the exchange.
    assert!((185..=200).contains(&first) && last > 950, "{limits:?}");
    let grows = |two: &[u16]| two[0] <= two[1] + 16 && two[1] < two[0] + 60;
    assert!(limits.windows(2).all(grows) && limits.len() > 40, "{limits:?}");
}

#[test]
fn joint_outside_of_its_range_is_named_and_nothing_holds() {
    let mut rig = Rig::new();
    rig.bus.borrow_mut().servos[1].stand_at(700.0);
    rig.rest(1.2);
    let text = rig.driver.fault().map(|fault| fault.to_string());
    assert_eq!((rig.driver.inhibit(), text), (MotionInhibit::Unheard, None));
    assert!((0..7).all(|place| !rig.bus.borrow().servos[place].holds()));
    rig.bus.borrow_mut().servos[1].stand_at(900.0);
    rig.until_ready(4.0);
}

/// The bus has no watchdog: a servo goes on to its latest goal.
#[test]
fn goals_lie_no_further_ahead_than_a_tenth_of_a_second_and_death_means_rest() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    let lead = 0.1 * 1.5 * 4096.0 / std::f64::consts::TAU + 1.0;
    let mut furthest: f64 = 0.0;
    for n in 0..200 {
        let mut command = rig.swing(Fingers::Stay);
        if n == 100 {
            command.q[0] += 2.0;
        }
        rig.pass(Some(command));
        let bus = rig.bus.borrow();
        let ahead =
            bus.servos.iter().map(|servo| (f64::from(servo.word(42)) - servo.shown()).abs());
        furthest = ahead.fold(furthest, f64::max);
    }
    // A cycle of motion lies between the measurement and this look.
    assert!(furthest <= lead + 12.0, "{furthest} of {lead} steps");
    let died_s = rig.now_s();
    let mut bus = rig.bus.borrow_mut();
    while bus.servos.iter().any(|servo| servo.speed.abs() > 33.0) {
        let next_s = bus.now_s() + 0.001;
        bus.advance_to(next_s);
    }
    let rest_s = bus.now_s() - died_s;
    println!(
        "without a program: at rest after {rest_s:.3} s, goals at most {furthest:.0} steps ahead"
    );
    assert!(rest_s < 0.15, "{rest_s}");
}

#[test]
fn arm_that_is_pushed_at_rest_stays_where_it_was_put() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    let pushed = rig.steps(0) + 200.0;
    for step in 0..200 {
        let mut bus = rig.bus.borrow_mut();
        let at = pushed - 200.0 + f64::from(step);
        bus.servos[0].stand_at(at);
        drop(bus);
        rig.pass(None);
    }
    rig.rest(1.0);
    assert!((rig.steps(0) - pushed).abs() < 120.0, "{} {pushed}", rig.steps(0));
    assert!(rig.faults.is_empty(), "{:?}", rig.faults);
}

#[test]
fn program_that_dies_leaves_servos_that_the_next_one_takes_over() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    let goals: Vec<u16> = rig.bus.borrow().servos.iter().map(|servo| servo.word(42)).collect();
    let bus = rig.bus.borrow().clone();
    let mut next = Rig::on(bus);
    let began_s = next.now_s();
    next.until_ready(1.0);
    assert!(next.now_s() - began_s < 0.2, "it need not begin softly");
    next.rest(0.5);
    for (servo, goal) in next.bus.borrow().servos.iter().zip(goals) {
        assert!(servo.holds() && servo.word(48) >= 385 && servo.word(42).abs_diff(goal) < 4);
    }
}

#[test]
fn wrong_servos_are_named() {
    let begun = |change: &dyn Fn(&mut Bus)| {
        let rig = Rig::new();
        let mut bus = rig.bus.borrow().clone();
        change(&mut bus);
        Rig::session(&Rc::new(RefCell::new(bus)))
            .err()
            .map(|Ended(reason)| reason)
            .unwrap_or_default()
    };
    assert_eq!(begun(&|_| {}), "");
    let missing = begun(&|bus| bus.servos[2].dead = true);
    assert!(missing.starts_with("no answer of servo 3 (elbow_joint); help:"), "{missing}");
    let silent = begun(&|bus| bus.servos.iter_mut().for_each(|servo| servo.set_byte(6, 4)));
    assert!(silent.starts_with("no servo answers; help:") && silent.contains("baud"), "{silent}");
    let model = begun(&|bus| bus.servos[3].set_byte(3, 10));
    assert!(model.contains("servo 4 is of model 778, expected 777"), "{model}");
    let mode = begun(&|bus| bus.servos[3].set_byte(33, 1));
    assert!(mode.contains("servo 4 is in mode 1"), "{mode}");
    let other = begun(&|bus| bus.servos[0].calibrate(-57, (751, 3470)));
    assert!(
        other.contains("servo 1 (shoulder_pan_joint) has range_max 3470, the file 3471"),
        "{other}"
    );
}

#[test]
fn joints_without_a_servo_and_joints_that_move_further_are_named() {
    let mut calibration = calibration();
    let elbow = calibration.servos.remove("elbow_joint").unwrap();
    calibration.servos.insert("elbow-joint".to_owned(), elbow);
    calibration.servos.get_mut("wrist_1_joint").unwrap().range_max = 2500;
    let problems = Layout::new(&settings(), &robot(), &calibration).unwrap_err();
    let texts: Vec<String> = problems.iter().map(ToString::to_string).collect();
    let [elbow, wrist] = &texts[..] else { panic!("{texts:?}") };
    assert!(
        elbow.contains("joint elbow_joint has no servo")
            && elbow.contains("servo = \"elbow-joint\""),
        "{elbow}"
    );
    assert!(wrist.contains("joint wrist_1_joint may move from -1.500 to 1.500 rad"), "{wrist}");
}

/// Joints and their servos.
type Pairs<'a> = &'a [(&'a str, &'a str)];

#[test]
fn entries_of_no_joint_and_servos_of_two_are_named() {
    let problems = |pairs: Pairs, gripper: &str| -> Vec<String> {
        let mut own = settings();
        own.gripper = gripper.to_owned();
        own.joints.extend(pairs.iter().map(|(joint, servo)| crate::settings::JointEntry {
            joint: (*joint).to_owned(),
            servo: (*servo).to_owned(),
            zero_rad: 0.0,
            reversed: false,
        }));
        let problems = Layout::new(&own, &robot(), &calibration()).err().unwrap_or_default();
        problems.iter().map(ToString::to_string).collect()
    };
    let own = ("elbow_joint", "elbow_joint");
    assert_eq!(problems(&[own], "gripper"), Vec::<String>::new());
    let cases: [(Pairs, &str, &str); 4] = [
        (&[("elbow_jiont", "elbow_joint")], "gripper", "write `joint = \"elbow_joint\"`"),
        (&[own, own], "gripper", "joint `elbow_joint` has two entries; help: remove one"),
        (&[("elbow_joint", "wrist_1_joint")], "gripper", "elbow_joint and wrist_1_joint have the"),
        (&[], "elbow_joint", "elbow_joint and elbow_joint have the servo 3"),
    ];
    for (pairs, gripper, words) in cases {
        let found = problems(pairs, gripper);
        let [problem] = &found[..] else { panic!("{words}: {found:?}") };
        assert!(problem.contains("arm.feetech.joints") && problem.contains(words), "{problem}");
    }
}

#[test]
fn servos_of_other_names_zeros_and_directions_are_mapped() {
    let mut own = settings();
    own.joints.push(crate::settings::JointEntry {
        joint: "elbow_joint".to_owned(),
        servo: "elbow_flex".to_owned(),
        zero_rad: 0.25,
        reversed: true,
    });
    let mut calibration = calibration();
    let elbow = calibration.servos.remove("elbow_joint").unwrap();
    calibration
        .servos
        .insert("elbow_flex".to_owned(), Calibrated { range_min: 700, range_max: 3300, ..elbow });
    let layout = Layout::new(&own, &robot(), &calibration).unwrap();
    let member = &layout.members[2];
    assert_eq!((member.value(2000), member.steps(0.25)), (0.25, 2000));
    assert!(member.value(2100) < 0.25 && member.speed(100) < 0.0);
    assert_eq!(member.steps(member.value(1234)), 1234);
}
