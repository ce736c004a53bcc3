use std::time::Duration;

use super::*;
use crate::group::tests::{LIMITS, service};

/// One machine with a clock, driven by short names.
struct Bench {
    machine: Machine,
    now: Time,
}

const CRASH: Event = Event::Exited(ProcessExit::Signal(9));
const STOPPED: Event = Event::Exited(ProcessExit::Code(0));
const REFUSED: Event = Event::Exited(ProcessExit::Code(78));

impl Bench {
    fn new() -> Self {
        let limits = Limits::of(&service("arm", &[]), LIMITS);
        Self { machine: Machine::new(limits), now: Duration::from_secs(100) }
    }

    fn starting() -> Self {
        let mut bench = Self::new();
        assert_eq!(bench.on(Event::Start), None);
        assert_eq!(bench.on(Event::Admit), Some(Effect::Spawn));
        bench
    }

    fn ready() -> Self {
        let mut bench = Self::starting();
        assert_eq!(bench.on(Event::Ready), None);
        bench
    }

    fn on(&mut self, event: Event) -> Option<Effect> {
        self.machine.on(event, self.now)
    }

    /// Lets time pass and asks what the clock says.
    fn after_ms(&mut self, ms: u64) -> Option<Effect> {
        self.now += Duration::from_millis(ms);
        self.on(Event::Clock)
    }

    #[track_caller]
    fn is(&self, wanted: Wanted, actual: Actual) {
        assert_eq!((self.machine.wanted(), self.machine.actual()), (wanted, actual));
    }
}

#[test]
fn machine_waits_for_admission() {
    let mut bench = Bench::new();
    assert_eq!(bench.on(Event::Admit), None, "not wanted yet");
    assert_eq!(bench.on(Event::Start), None);
    bench.is(Wanted::Up, Actual::Down);
    assert_eq!(bench.on(Event::Admit), Some(Effect::Spawn));
    assert_eq!(bench.on(Event::Admit), None, "once");
}

#[test]
fn ignored_stop_request_escalates_to_kill() {
    let mut bench = Bench::ready();
    bench.on(Event::Stop);
    assert_eq!(bench.after_ms(4_999), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Kill));
    assert_eq!(bench.after_ms(1_000), Some(Effect::Kill));
    bench.on(CRASH);
    bench.is(Wanted::Down, Actual::Down);
}

#[test]
fn start_without_readiness_is_stopped_and_backs_off() {
    let mut bench = Bench::starting();
    assert_eq!(bench.after_ms(10_000), Some(Effect::Terminate));
    assert_eq!(bench.machine.failure(), Some(Failure::NotReady));
    assert_eq!(bench.after_ms(500), Some(Effect::Kill));
    assert_eq!(bench.on(CRASH), None);
    bench.is(Wanted::Up, Actual::Backoff);
    assert_eq!(bench.after_ms(99), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Spawn));
    assert_eq!(bench.machine.incarnation(), 2);
}

/// Else services of a busy machine would be killed at the same moment again and again.
#[test]
fn each_late_start_doubles_the_time_of_the_next_one() {
    let mut bench = Bench::starting();
    let late = |bench: &mut Bench, start_ms: u64| {
        assert_eq!(bench.after_ms(start_ms - 1), None, "{start_ms}");
        assert_eq!(bench.after_ms(1), Some(Effect::Terminate), "{start_ms}");
        bench.on(CRASH);
        if bench.machine.actual() == Actual::Backoff {
            assert_eq!(bench.after_ms(60_000), Some(Effect::Spawn));
        }
    };
    for start_ms in [10_000, 20_000] {
        late(&mut bench, start_ms);
    }
    bench.on(Event::Ready);
    assert_eq!(bench.on(CRASH), Some(Effect::Spawn), "it was ready meanwhile");
    for start_ms in [10_000, 20_000] {
        late(&mut bench, start_ms);
    }
    bench.on(Event::Restart);
    assert_eq!(bench.on(STOPPED), Some(Effect::Spawn), "a new attempt");
    for start_ms in [10_000, 20_000, 40_000, 80_000, 80_000] {
        bench.is(Wanted::Up, Actual::Starting);
        late(&mut bench, start_ms);
    }
    assert_eq!(bench.machine.held_because(), Some(HeldBecause::NeverReady(5)));
}

#[test]
fn silence_is_answered_with_abort_then_kill() {
    let mut bench = Bench::ready();
    assert_eq!(bench.after_ms(2_900), None);
    bench.on(Event::Beat);
    assert_eq!(bench.after_ms(2_999), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Abort));
    assert_eq!(bench.machine.failure(), Some(Failure::NoBeat));
    assert_eq!(bench.after_ms(500), Some(Effect::Kill));
    assert_eq!(bench.on(CRASH), Some(Effect::Spawn), "it had been ready");
}

#[test]
fn permanent_exit_holds_the_service() {
    for exit in [ProcessExit::Code(78), ProcessExit::Code(64), ProcessExit::NotStartable] {
        let mut bench = Bench::starting();
        assert_eq!(bench.on(Event::Exited(exit)), None);
        assert_eq!(bench.machine.held_because(), Some(HeldBecause::Permanent(exit)));
        assert_eq!(bench.on(Event::Restart), Some(Effect::Spawn));
    }
}

#[test]
fn reported_shortage_turns_any_exit_into_a_wait() {
    for exit in [CRASH, STOPPED, REFUSED] {
        let mut bench = Bench::ready();
        assert_eq!(bench.on(Event::Short(true)), None);
        bench.is(Wanted::Up, Actual::Ready);
        assert_eq!(bench.on(exit), None);
        assert_eq!(bench.machine.state(), ServiceState::Short);
        assert_eq!(bench.after_ms(100), Some(Effect::Spawn));
        bench.on(Event::Ready);
        assert_eq!(bench.on(REFUSED), None, "the successor has not said so");
        assert_eq!(bench.machine.state(), ServiceState::Failed);
    }
    let mut bench = Bench::ready();
    bench.on(Event::Short(true));
    bench.on(Event::Short(false));
    bench.on(REFUSED);
    assert_eq!(bench.machine.state(), ServiceState::Failed);
}

#[test]
fn service_that_is_never_restarted_is_not_retried_after_a_shortage_either() {
    let mut bench = Bench::ready();
    bench.machine.limits.restart = Restart::Never;
    bench.on(Event::Exited(ProcessExit::Code(74)));
    assert_eq!(bench.machine.state(), ServiceState::Failed);
}

#[test]
fn restart_policies_differ_in_what_follows_an_exit() {
    let after = |restart, exit| {
        let mut bench = Bench::ready();
        bench.machine.limits.restart = restart;
        bench.on(exit);
        (bench.machine.wanted(), bench.machine.actual())
    };
    let (up, down) = (Wanted::Up, Wanted::Down);
    assert_eq!(after(Restart::Always, STOPPED), (up, Actual::Starting));
    assert_eq!(after(Restart::OnFailure, CRASH), (up, Actual::Starting));
    assert_eq!(after(Restart::OnFailure, STOPPED), (down, Actual::Down));
    assert_eq!(after(Restart::Never, STOPPED), (down, Actual::Down));
    assert_eq!(after(Restart::Never, CRASH), (up, Actual::Held));
}

#[test]
fn requested_restart_does_not_count_as_a_failure() {
    let mut bench = Bench::ready();
    for _ in 0..20 {
        assert_eq!(bench.on(Event::Restart), Some(Effect::Terminate));
        assert_eq!(bench.on(STOPPED), Some(Effect::Spawn));
        bench.on(Event::Ready);
    }
    bench.is(Wanted::Up, Actual::Ready);
    assert_eq!(bench.on(CRASH), Some(Effect::Spawn));
}

#[test]
fn hold_can_be_lifted_while_the_service_stops() {
    let mut bench = Bench::ready();
    bench.on(Event::Hold);
    bench.on(Event::Release);
    assert_eq!(bench.on(STOPPED), Some(Effect::Spawn));
}

#[test]
fn new_request_during_a_stop_applies_at_its_end() {
    let mut bench = Bench::ready();
    bench.on(Event::Stop);
    bench.on(Event::Start);
    assert_eq!(bench.on(STOPPED), Some(Effect::Spawn));
    bench.on(Event::Restart);
    bench.on(Event::Stop);
    assert_eq!(bench.on(STOPPED), None);
    bench.is(Wanted::Down, Actual::Down);
}

#[test]
fn permanent_exit_while_stopping_does_not_hold_the_service() {
    let mut bench = Bench::ready();
    bench.on(Event::Restart);
    assert_eq!(bench.on(REFUSED), Some(Effect::Spawn));
}

#[test]
fn time_can_be_asked_for_but_not_for_ever() {
    let mut bench = Bench::starting();
    bench.on(Event::Extend(Duration::from_secs(3_600)));
    assert_eq!(bench.after_ms(39_999), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Terminate));

    let mut bench = Bench::ready();
    bench.on(Event::Extend(Duration::from_secs(6)));
    bench.on(Event::Beat);
    assert_eq!(bench.after_ms(5_999), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Abort));
    bench.on(Event::Extend(Duration::from_secs(6)));
    assert_eq!(bench.after_ms(500), Some(Effect::Kill), "a stuck service gets no more");

    let mut bench = Bench::ready();
    bench.on(Event::Stop);
    bench.on(Event::Extend(Duration::from_secs(12)));
    assert_eq!(bench.after_ms(11_999), None);
    bench.on(Event::Extend(Duration::from_secs(3_600)));
    assert_eq!(bench.after_ms(8_000), None);
    assert_eq!(bench.after_ms(1), Some(Effect::Kill));
}

#[test]
fn without_a_watchdog_silence_is_fine() {
    let mut bench = Bench::starting();
    bench.machine.limits.watchdog = None;
    bench.on(Event::Ready);
    assert_eq!(bench.machine.deadline(), None);
    assert_eq!(bench.after_ms(3_600_000), None);
}
