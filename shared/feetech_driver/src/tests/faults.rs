//! Faults of answers, and stops among them.

use super::*;

/// Longest time in which a stop has to be in every servo among such faults, seconds. Without them it takes a cycle.
const STOP_MAX_S: f64 = 0.3;

/// Counts of a run.
#[derive(Debug, Default)]
struct Counts {
    readings: u32,
    wrong: u32,
    stops: u32,
    missed: u32,
    longest_s: f64,
    longest_stop_s: f64,
}

/// Swings with stops in between, with every fault at this chance, and compares each accepted position with that of the
/// servo when it was read.
fn run(cycles: u32, chance: f64, seed: u64) -> Counts {
    let mut rig = Rig::new();
    rig.bus.borrow_mut().faults = servo_bus::Faults::each(0.0, seed);
    rig.until_ready(3.0);
    rig.bus.borrow_mut().faults.set_all(chance);
    let layout = Layout::new(&settings(), &robot(), &calibration()).unwrap();
    let (mut counts, mut accepted_s) = (Counts::default(), rig.now_s());
    let mut stop: Option<f64> = None;
    for cycle in 0..cycles {
        rig.reading = None;
        // Every second cycle of half a second is a stop: the driver drops its commands and holds what it measures.
        let (n, of) = (cycle / 50, cycle % 50);
        if n % 2 == 1 && of == 0 {
            rig.driver.hold_here();
            (stop, counts.stops) = (Some(rig.now_s()), counts.stops + 1);
            rig.pass(None);
        } else if n % 2 == 1 {
            rig.pass(None);
        } else {
            if of == 0 {
                (rig.from, rig.began_s) = (rig.driver.measured().posture.joints[0], rig.now_s());
            }
            let swing = rig.swing(Fingers::Stay);
            rig.pass(Some(swing));
        }
        if let Some(reading) = rig.reading.as_ref().filter(|reading| reading.is_plausible) {
            counts.readings += 1;
            counts.longest_s = counts.longest_s.max(rig.now_s() - accepted_s);
            accepted_s = rig.now_s();
            counts.wrong += u32::from(!is_true(reading, &rig, &layout));
        }
        let Some(since_s) = stop else { continue };
        let took_s = rig.now_s() - since_s;
        if has_goals(&rig, &layout) {
            counts.longest_stop_s = counts.longest_stop_s.max(took_s);
            stop = None;
        } else if took_s > STOP_MAX_S {
            (counts.missed, stop) = (counts.missed + 1, None);
        }
    }
    assert!(rig.faults.is_empty() || chance > 0.0, "{:?}", rig.faults);
    counts
}

/// Returns whether the positions are those of the servos when they were read last, to the step.
fn is_true(reading: &Reading, rig: &Rig, layout: &Layout) -> bool {
    let bus = rig.bus.borrow();
    let truths = layout.members.iter().zip(&bus.sampled);
    let truths = truths.map(|(member, steps)| member.value(i32::from(*steps)));
    reading.servos.iter().zip(truths).all(|(servo, truth)| servo.value == truth)
}

/// Returns whether every servo has the goal that the driver wants.
fn has_goals(rig: &Rig, layout: &Layout) -> bool {
    let bus = rig.bus.borrow();
    let wanted =
        layout.members.iter().zip(&rig.told.goals).map(|(member, goal)| member.steps(*goal));
    bus.servos.iter().zip(wanted).all(|(servo, steps)| servo.word(42) == steps)
}

#[test]
fn no_wrong_position_is_accepted_and_no_stop_is_missed_among_faults_of_answers() {
    let seed = servo_bus::seed();
    let cycles =
        std::env::var("WHICHONE_CYCLES").ok().and_then(|n| n.parse().ok()).unwrap_or(10_000);
    let counts = run(cycles, 0.02, seed);
    println!(
        "{cycles} cycles, 2 % of each of 7 faults an answer and 2 % deaf servos a request, seed {seed}: {counts:?}"
    );
    assert_eq!((counts.wrong, counts.missed), (0, 0), "seed {seed}: {counts:?}");
    assert!(counts.readings > cycles / 8 && counts.stops > 90, "seed {seed}: {counts:?}");
}

#[test]
fn each_reading_of_a_sound_bus_is_accepted() {
    let counts = run(1_000, 0.0, 1);
    assert_eq!((counts.readings, counts.wrong, counts.missed), (1_000, 0, 0), "{counts:?}");
}

/// The table of what lerobot does on such a bus has this row: "the next read returns the old value".
#[test]
fn late_answer_is_not_taken_for_the_next_one() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    let before = rig.driver.measured().posture.joints[0][0];
    rig.bus.borrow_mut().faults.set("late", 1.0).unwrap();
    rig.pass(None);
    rig.bus.borrow_mut().faults.set("late", 0.0).unwrap();
    {
        // The joint is held 60 steps from where it was.
        let mut bus = rig.bus.borrow_mut();
        let jammed = bus.servos[0].actual + 60.0;
        (bus.servos[0].actual, bus.servos[0].blocked) = (jammed, (jammed, jammed));
    }
    for _ in 0..20 {
        rig.reading = None;
        rig.pass(None);
        let found = rig.reading.as_ref().filter(|reading| reading.is_plausible);
        assert!(
            found.is_none_or(|reading| reading.servos[0].value > before + 0.05),
            "an old position"
        );
    }
    assert!(rig.driver.measured().posture.joints[0][0] > before + 0.05);
}

/// Readings are rejected as a whole: nothing that is not every answer in its order moves the driver.
#[test]
fn silent_bus_makes_the_readings_stale_and_a_missing_servo_is_named() {
    let mut rig = Rig::new();
    rig.until_ready(3.0);
    rig.bus.borrow_mut().servos[2].dead = true;
    rig.rest(0.3);
    assert!(matches!(rig.driver.inhibit(), MotionInhibit::Stale | MotionInhibit::Unheard));
    rig.rest(2.0);
    let (_, fault) = rig.faults.first().expect("a fault");
    assert!(fault.to_string().contains("servo 3 (elbow_joint)"), "{fault}");
    rig.bus.borrow_mut().servos[2].dead = false;
    rig.until_ready(3.0);
}
