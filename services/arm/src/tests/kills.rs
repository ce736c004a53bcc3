//! Killed at any point, any number of times, the arm brings the ordered object once.

use super::*;

impl Machine {
    /// Runs until that is so, with up to six deaths in between, one in `often` passes, and now and then a motion stop.
    pub(super) fn endures(
        &mut self,
        (seed, random, often): (u64, &mut Rng, usize),
        restart: fn(&mut Self),
        is_over: impl Fn(&Self) -> bool,
    ) {
        let (mut left, mut stopped) = (6, false);
        let until = self.now + Span::from_s(60.0);
        while !is_over(self) {
            assert!(self.now < until, "seed {seed}: stuck; {:?}", self.node.state());
            if random.below(if stopped { 30 } else { 150 }) == 0 {
                stopped = !stopped;
                self.motion(if stopped { MotionOrder::Stop } else { MotionOrder::Resume });
            }
            if left > 0 && random.below(often) == 0 {
                left -= 1;
                self.go(Some([Death::Unsynced, Death::Unseen, Death::Seen][random.below(3)]));
                // A command that was dropped with the process is given again by who gave it.
                stopped = self.journal.last().is_some_and(|record| record.state.stopped);
                self.now = self.now + Span::from_ms(200);
                restart(self);
            } else {
                self.go(None);
            }
        }
    }
}

/// A pick with deaths anywhere in it, and now and then a motion stop.
fn story(seed: u64, restart: fn(&mut Machine)) {
    let mut random = Rng::new(seed);
    let object = random.below(OBJECTS.into()) as u16;
    let mut machine = Machine::new(config_at(10.0));
    machine.robot.expect_only_picks();
    machine.act(pick(1, object));
    let is_over = |m: &Machine| m.outcome() == PickOutcome::Delivered && m.rests();
    machine.endures((seed, &mut random, 30), restart, is_over);
    machine.assert_delivered(1, object);
    for pair in machine.journal.windows(2) {
        let phases = [&pair[0], &pair[1]].map(|r| r.state.pick.map(|pick| pick.phase));
        assert!(phases[0] <= phases[1], "seed {seed}: a phase was taken back");
    }
}

#[test]
fn on_the_model_that_the_journal_describes() {
    for seed in 0..24 {
        story(seed, Machine::restart_from_journal);
    }
}

#[test]
fn on_a_robot_that_stands_where_it_was() {
    for seed in 100..124 {
        story(seed, |machine| {
            let grasps = machine.robot.grasps();
            assert!(grasps <= 1, "{grasps} grasps");
            machine.restart();
        });
    }
}

#[test]
fn without_a_sensor_an_interrupted_grasp_is_left_to_a_person() {
    let mut machine = Machine::new(config_at(5.0));
    machine.robot.lose_feeling();
    machine.act(pick(1, 1));
    machine.reaches(PickPhase::Closing);
    machine.restart();
    machine.reaches(PickPhase::Done);
    assert_eq!(machine.outcome(), PickOutcome::Interrupted);
    let posture = machine.robot.posture();
    machine.run(2.0);
    assert_eq!(machine.robot.posture(), posture, "it holds still");
    machine.restart();
    machine.run(1.0);
    assert_eq!(machine.robot.posture(), posture, "so it does after another restart");
    machine.act(RobotAct { attempt: 2, act: 11, ..pick(1, 1) });
    machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
    machine.robot.assert_well_behaved();
}

#[test]
fn without_a_sensor_an_uninterrupted_grasp_is_trusted() {
    let mut machine = Machine::new(config_at(20.0));
    machine.robot.lose_feeling();
    machine.act(pick(1, 3));
    machine.delivers(1, 3);
}

#[test]
fn fingers_that_close_on_nothing_are_no_grasp() {
    let mut machine = Machine::new(config_at(20.0));
    machine.robot.miss(u32::MAX);
    machine.act(pick(1, 3));
    machine.reaches(PickPhase::Done);
    assert_eq!(machine.outcome(), PickOutcome::Missed);
    assert_eq!(machine.node.state().misses, machine.config.arm.grasp.attempts);
    assert_eq!((machine.node.state().held, machine.robot.grasps()), (None, 0));
    machine.run_until("it returns to rest with an empty gripper", Machine::rests);
    machine.robot.miss(0);
    machine.act(pick(2, 3));
    machine.delivers(2, 3);
}

#[test]
fn another_scene_ends_what_was_under_way() {
    for (phase, outcome) in [
        (PickPhase::Moving, PickOutcome::Cancelled),
        (PickPhase::Closing, PickOutcome::Interrupted),
        (PickPhase::Holding, PickOutcome::Interrupted),
    ] {
        let mut machine = Machine::picking(config_at(10.0), 2, phase);
        machine.act = None;
        machine.config.scene = markers();
        machine.restart_from_journal();
        assert_eq!((machine.phase(), machine.outcome()), (PickPhase::Done, outcome));
        assert_eq!(machine.journal.last().unwrap().state.scene_key, machine.config.scene.key());
        machine.run_until("at rest", Machine::rests);
        assert_eq!(machine.node.state().held, None);
        machine.act(pick(2, 1));
        machine.run_until("delivered", |m| m.outcome() == PickOutcome::Delivered);
        machine.robot.assert_well_behaved();
    }
}

#[test]
fn arm_halts_and_journals_its_posture_on_shutdown() {
    for phase in [PickPhase::Moving, PickPhase::Closing, PickPhase::Holding] {
        let mut machine = Machine::picking(config(), 0, phase);
        machine.run(0.4);
        let asked = machine.now;
        machine.pass(vec![Event::Shutdown], None);
        while !machine.exited {
            machine.go(None);
        }
        assert!(machine.now.since(asked).s() < 0.15);
        assert_eq!(machine.joints.last().unwrap().velocity, [0.0; 17], "the last ones show it");
        assert_eq!(machine.journal.last().unwrap().state.posture, machine.robot.posture());
        machine.restart_from_journal();
        machine.delivers(1, 0);
    }
}
