//! Publication: contents, rate, and order relative to the journal.

use super::*;
use crate::state::Cause;

#[test]
fn idle_arm_publishes_joints_at_10_hz_and_journals_nothing() {
    let mut machine = Machine::new(config());
    machine.run(0.5);
    let (journal, joints) = (machine.journal.len(), machine.joints.len());
    let (statuses, worlds) = (machine.statuses.len(), machine.worlds.len());
    machine.run(10.0);
    let close = |count: usize, want: usize| count.abs_diff(want) <= 1 + want / 100;
    assert!(close(machine.joints.len() - joints, 100), "{}", machine.joints.len() - joints);
    // Every 250 ms, and then with the next joint states.
    assert!(close(machine.statuses.len() - statuses, 33));
    assert!(close(machine.worlds.len() - worlds, 10));
    assert_eq!(machine.journal.len(), journal);
    let last = machine.joints.last().unwrap();
    assert_eq!(last.velocity, [0.0; 17]);
    assert_eq!(last.gripper_percent, [100.0; 2]);
}

#[test]
fn other_rates_are_kept_too() {
    for (rate_hz, at_rest_hz) in [(1.0, 1), (25.0, 10), (400.0, 10)] {
        let mut config = config();
        config.arm.joint_rate_hz = rate_hz;
        let mut machine = Machine::new(config);
        let in_2_s = |machine: &mut Machine| {
            machine.joints.clear();
            machine.run(2.0);
            machine.joints.len()
        };
        let at_rest = in_2_s(&mut machine);
        assert!(at_rest.abs_diff(2 * at_rest_hz) <= 1, "{at_rest} at {rate_hz} Hz");
        machine.act(pick(1, 1));
        let busy = in_2_s(&mut machine);
        let wanted = (2.0 * rate_hz) as usize;
        assert!(busy.abs_diff(wanted) <= 1 + wanted / 100, "{busy} at {rate_hz} Hz");
        machine.delivers(1, 1);
    }
}

#[test]
fn order_ends_the_lower_rate_of_an_arm_at_rest_at_once() {
    // Wherever in the interval of the resting arm the order arrives.
    for after_ms in (0..120).step_by(7) {
        let mut machine = Machine::new(config_at(20.0));
        machine.run(0.5 + f64::from(after_ms) / 1e3);
        machine.act(pick(1, 1));
        let (ordered, published) = (machine.now, machine.joints.len());
        machine.run_until("delivered and at rest", |machine| {
            machine.outcome() == PickOutcome::Delivered && machine.rests()
        });
        // The first one that shows the rest belongs to the motion.
        machine.run(0.011);
        let times = machine.joints[published..].iter().map(|states| states.at_ns);
        let times: Vec<u64> = std::iter::once(ordered.ns()).chain(times).collect();
        let longest = times.windows(2).map(|pair| pair[1] - pair[0]).max();
        assert!(longest <= Some(Span::from_ms(11).0), "{longest:?} ns, {after_ms} ms");
        let velocity = machine.joints.last().unwrap().velocity;
        assert!(velocity.iter().all(|v| v.abs() < 1e-9), "{velocity:?}");
    }
}

#[test]
fn moving_arm_publishes_the_world_at_10_hz_and_journals_at_5_hz() {
    let mut machine = Machine::picking(config(), 0, PickPhase::Moving);
    machine.run(0.1);
    let (worlds, records) = (machine.worlds.len(), machine.journal.len());
    machine.run(2.0);
    assert_eq!(machine.phase(), PickPhase::Moving);
    assert!((19..=21).contains(&(machine.worlds.len() - worlds)));
    let hints = &machine.journal[records..];
    assert!((9..=10).contains(&hints.len()), "{} records in 2 s", hints.len());
    assert!(hints.iter().all(|record| record.cause == Cause::Moved));
}

#[test]
fn phases_are_durable_in_order_before_they_are_seen() {
    let mut machine = Machine::new(config_at(20.0));
    machine.act(pick(1, 5));
    let mut seen = Vec::new();
    while !machine.rests() || machine.outcome() != PickOutcome::Delivered {
        machine.go(None);
        let durable = machine.journal.last().unwrap().state.pick.unwrap().phase;
        let published = machine.status().phase.get();
        assert!(published <= durable);
        if seen.last() != Some(&published) {
            seen.push(published);
        }
    }
    assert_eq!(seen.last(), Some(&PickPhase::Done));
    let mut phases: Vec<PickPhase> =
        machine.journal.iter().map(|r| r.state.pick.unwrap().phase).collect();
    phases.dedup();
    use PickPhase::{Accepted, Closing, Done, Holding, Moving};
    assert_eq!(phases, [Accepted, Moving, Closing, Holding, Done]);
    let mut causes: Vec<Cause> = machine.journal.iter().map(|record| record.cause).collect();
    causes.dedup();
    causes.retain(|cause| *cause != Cause::Moved);
    assert_eq!((causes[0], causes.last()), (Cause::Ordered, Some(&Cause::Rested)));
}

#[test]
fn journal_is_compacted_only_at_rest() {
    let mut machine = Machine::picking(config_at(20.0), 5, PickPhase::Holding);
    assert_eq!(machine.node.snapshot(), None);
    machine.run_until("at rest", Machine::rests);
    machine.run(0.1);
    let snapshot = machine.node.snapshot().unwrap();
    let [record] = &snapshot[..] else { panic!("one record") };
    let last = &machine.journal.last().unwrap().state;
    assert_eq!((record.cause, &record.state), (Cause::Snapshot, last));
    machine.journal = snapshot;
    machine.restart_from_journal();
    machine.run(1.0);
    assert_eq!(machine.outcome(), PickOutcome::Delivered, "not done again");
    assert_eq!(machine.robot.grasps(), 0);
}

#[test]
fn arm_rejects_a_journal_with_joints_outside_their_limits() {
    let mut machine = Machine::new(config_at(20.0));
    machine.act(pick(1, 5));
    machine.run(0.1);
    let mut records = machine.journal.clone();
    records.last_mut().unwrap().state.posture.joints[1][3] = 4.0;
    let error = ArmNode::recover(machine.config.clone(), records).err().unwrap();
    assert!(error.what.contains("outside its joint limits"), "{error}");
    assert!(ArmNode::recover(machine.config.clone(), machine.journal).is_ok());
}
