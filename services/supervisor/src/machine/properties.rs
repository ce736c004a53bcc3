//! The machine's invariants under any sequence of events, with a process that it controls.

use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::configuration::RestartLimits;
use crate::group::tests::{LIMITS, seeded, service};

const RESTART_LIMITS: RestartLimits = RestartLimits {
    exits_max: 4,
    window: Duration::from_secs(20),
    backoff_max: Duration::from_secs(2),
    backoff_reset: Duration::from_secs(5),
    ..LIMITS
};

fn machine() -> Machine {
    Machine::new(Limits::of(&service("any", &[]), RESTART_LIMITS))
}

/// Any external event: requests of an operator, and notifications and exits of a process.
fn any_event() -> impl Strategy<Value = Event> {
    prop_oneof![
        Just(Event::Start),
        Just(Event::Admit),
        Just(Event::Stop),
        Just(Event::Retire),
        Just(Event::Restart),
        Just(Event::Hold),
        Just(Event::Release),
        any_deed(),
        any_deed(),
        any_deed(),
    ]
}

fn any_deed() -> impl Strategy<Value = Event> {
    prop_oneof![
        3 => Just(Event::Ready),
        2 => Just(Event::Beat),
        1 => (0u64..20_000).prop_map(|ms| Event::Extend(Duration::from_millis(ms))),
        3 => (0i32..3).prop_map(|code| Event::Exited(ProcessExit::Code(code))),
        1 => Just(Event::Exited(ProcessExit::Code(78))),
        2 => any_shortage().prop_map(Event::Exited),
        1 => any::<bool>().prop_map(Event::Short),
        2 => Just(Event::Exited(ProcessExit::Signal(9))),
        4 => Just(Event::Clock),
    ]
}

fn any_shortage() -> impl Strategy<Value = ProcessExit> {
    prop_oneof![
        Just(ProcessExit::Code(74)),
        Just(ProcessExit::Signal(7)),
        Just(ProcessExit::NotStarted),
    ]
}

/// A machine beside the process that it believes to run.
struct World {
    machine: Machine,
    now: Time,
    lives: bool,
    /// When it was started, and whether a shortage had been waited out.
    starts: Vec<(Time, bool)>,
}

impl World {
    fn new() -> Self {
        Self { machine: machine(), now: Time::ZERO, lives: false, starts: Vec::new() }
    }

    /// One event, if it can happen: a process that does not live does nothing.
    fn give(&mut self, event: Event, after_ms: u64) -> Result<(), TestCaseError> {
        self.now += Duration::from_millis(after_ms);
        let is_deed =
            matches!(event, Event::Ready | Event::Beat | Event::Extend(_) | Event::Short(_));
        let was_short = self.machine.state() == ServiceState::Short;
        if !self.lives && (is_deed || matches!(event, Event::Exited(_))) {
            return Ok(());
        }
        if let Event::Exited(_) = event {
            self.lives = false;
        }
        match self.machine.on(event, self.now) {
            Some(Effect::Spawn) => {
                prop_assert!(!self.lives, "two incarnations at once");
                self.lives = true;
                self.starts.push((self.now, was_short));
            }
            Some(Effect::Terminate | Effect::Abort | Effect::Kill) => {
                prop_assert!(self.lives, "a signal without a process");
            }
            None => {}
        }
        self.check()
    }

    fn check(&self) -> Result<(), TestCaseError> {
        let machine = &self.machine;
        prop_assert_eq!(machine.is_live(), self.lives);
        let owes = match machine.actual() {
            Actual::Starting | Actual::Ready | Actual::Stopping | Actual::Backoff => true,
            Actual::Down | Actual::Held => false,
        };
        prop_assert_eq!(machine.deadline().is_some(), owes, "{:?}", machine.actual());
        prop_assert_eq!(machine.incarnation() as usize, self.starts.len());
        Ok(())
    }
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn one_incarnation_and_always_a_deadline(
        events in prop::collection::vec((any_event(), 0u64..4_000), 0..200),
    ) {
        let mut world = World::new();
        for (event, after_ms) in events {
            world.give(event, after_ms)?;
        }
    }

    /// Left to itself, a service is never started more than `exits_max` times in any window.
    #[test]
    fn starts_are_bounded(
        events in prop::collection::vec((any_deed(), 0u64..4_000), 0..400),
    ) {
        let mut world = World::new();
        world.give(Event::Start, 0)?;
        world.give(Event::Admit, 0)?;
        for (event, after_ms) in events {
            world.give(event, after_ms)?;
        }
        // A shortage does not count: only its pauses bound the starts after it.
        let starts: Vec<Time> =
            world.starts.iter().filter(|(_, was_short)| !was_short).map(|&(at, _)| at).collect();
        for (first, &from) in starts.iter().enumerate() {
            let within = starts[first..].iter().filter(|&&at| at - from < RESTART_LIMITS.window);
            prop_assert!(within.count() <= RESTART_LIMITS.exits_max as usize, "{:?}", world.starts);
        }
    }

    /// Whatever happened before, a stop ends the service: within the stop deadline if the process
    /// obeys, and by a kill that is due at a bounded time if it does not.
    #[test]
    fn a_stop_always_ends(
        events in prop::collection::vec((any_event(), 0u64..4_000), 0..60),
        obeys in any::<bool>(),
    ) {
        let mut world = World::new();
        for (event, after_ms) in events {
            world.give(event, after_ms)?;
        }
        let asked_at = world.now;
        world.give(Event::Stop, 0)?;
        if world.lives && !obeys {
            let due = world.machine.deadline().expect("a live service has a deadline");
            let latest = asked_at + world.machine.limits.stop * EXTENSIONS_MAX;
            prop_assert!(due <= latest);
            world.now = due;
            prop_assert_eq!(world.machine.on(Event::Clock, due), Some(Effect::Kill));
        }
        world.give(Event::Exited(ProcessExit::Signal(9)), 1)?;
        prop_assert_eq!(world.machine.actual(), Actual::Down);
        world.give(Event::Clock, 3_600_000)?;
        prop_assert!(!world.lives);
    }

    /// However often a service ends for want of a resource, it is never given up: it is started
    /// again after a pause that is neither shorter than the first nor longer than the longest, and
    /// the exits that count are as if the shortage had not been.
    #[test]
    fn a_shortage_is_waited_out(
        exits in prop::collection::vec((any_shortage(), any::<bool>(), 0u64..8_000), 1..60),
    ) {
        let mut world = World::new();
        world.give(Event::Start, 0)?;
        world.give(Event::Admit, 0)?;
        for (exit, becomes_ready, ready_ms) in exits {
            if becomes_ready {
                world.give(Event::Ready, 10)?;
                for _ in 0..ready_ms / 2_000 {
                    world.give(Event::Beat, 2_000)?;
                }
            }
            world.give(Event::Exited(exit), 10)?;
            prop_assert_eq!(world.machine.state(), ServiceState::Short);
            let due = world.machine.deadline().expect("it is retried");
            let pause = due - world.now;
            prop_assert!(pause >= RESTART_LIMITS.backoff_first);
            prop_assert!(pause <= RESTART_LIMITS.backoff_max);
            world.give(Event::Clock, u64::try_from(pause.as_millis()).expect("short"))?;
            prop_assert!(world.lives);
        }
        for exit in 1..=RESTART_LIMITS.exits_max {
            world.give(Event::Exited(ProcessExit::Code(1)), 10)?;
            let is_last = exit == RESTART_LIMITS.exits_max;
            prop_assert_eq!(world.machine.state() == ServiceState::Failed, is_last);
            world.give(Event::Clock, 2_000)?;
        }
    }

    /// A pause is waited out before a service that never became ready is started again.
    #[test]
    fn a_start_that_never_was_ready_waits(code in 0i32..64, exits in 1u32..4) {
        let mut world = World::new();
        world.give(Event::Start, 0)?;
        world.give(Event::Admit, 0)?;
        for exit in 0..exits {
            world.give(Event::Exited(ProcessExit::Code(code)), 10)?;
            let pause = RESTART_LIMITS.backoff_first * 2u32.pow(exit);
            if exit + 1 == RESTART_LIMITS.exits_max {
                prop_assert_eq!(world.machine.actual(), Actual::Held);
                break;
            }
            prop_assert_eq!(world.machine.deadline(), Some(world.now + pause));
            let ms = u64::try_from(pause.as_millis()).expect("short");
            world.give(Event::Clock, ms - 1)?;
            prop_assert!(!world.lives);
            world.give(Event::Clock, 1)?;
            prop_assert!(world.lives);
        }
    }
}
