//! A lost journal, of the arm itself or of another service.

use service::SetAside;

use super::*;

const OVER: u64 = service::journal_set::NUMBERS_SKIPPED;

fn set_aside(machine: &mut Machine, is_own: bool) {
    machine.pass(vec![Event::SetAside(SetAside { over: OVER, is_own })], None);
}

#[test]
fn arm_without_memory_waits_for_a_person() {
    let mut machine = Machine::new(config_at(20.0));
    set_aside(&mut machine, true);
    machine.act(pick(OVER + 1, 4));
    machine.run(3.0);
    assert_eq!(machine.phase(), PickPhase::Accepted);
    assert_eq!(machine.robot.grasps(), 0);
    // The latch is durable.
    machine.restart();
    set_aside(&mut machine, false);
    assert!(machine.node.state().stopped);
    machine.motion(MotionOrder::Resume);
    machine.delivers(OVER + 1, 4);
}

#[test]
fn pick_whose_interaction_is_over_is_left_before_the_grasp_and_brought_after_it() {
    for (phase, outcome) in [
        (PickPhase::Moving, PickOutcome::Cancelled),
        (PickPhase::Closing, PickOutcome::Delivered),
        (PickPhase::Holding, PickOutcome::Delivered),
    ] {
        let mut machine = Machine::picking(config_at(5.0), 4, phase);
        machine.act = None;
        machine.restart();
        set_aside(&mut machine, false);
        machine.run_until("the end", |m| m.phase() == PickPhase::Done);
        assert_eq!(machine.outcome(), outcome, "{phase:?}");
        machine.robot.assert_well_behaved();
    }
}
