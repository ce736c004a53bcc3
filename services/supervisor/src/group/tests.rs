use std::time::Duration;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::configuration::{Log, Restart, RestartLimits, ServiceSpec};
use service::exit::ProcessExit;

/// The same cases in every run, and no files.
pub(crate) fn seeded() -> ProptestConfig {
    ProptestConfig {
        cases: 512,
        rng_seed: RngSeed::Fixed(20_260_821),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A service that differs from others by its name and place only.
pub(crate) fn service(name: &str, after: &[&str]) -> ServiceSpec {
    ServiceSpec {
        name: name.into(),
        command: vec!["true".into()],
        is_shipped: false,
        after: after.iter().map(|&name| name.into()).collect(),
        critical: false,
        observer: false,
        start_deadline: Duration::from_secs(10),
        watchdog: Some(Duration::from_secs(3)),
        stop_deadline: Duration::from_secs(5),
        nice: 0,
        restart: Restart::Always,
        fingerprint: String::new(),
    }
}

/// The limits that groups have by default.
pub(crate) const LIMITS: RestartLimits = RestartLimits {
    exits_max: 5,
    window: Duration::from_secs(60),
    backoff_first: Duration::from_millis(100),
    backoff_max: Duration::from_secs(5),
    backoff_reset: Duration::from_secs(30),
};

fn group_of(services: Vec<ServiceSpec>) -> Group {
    let log = Log { level: "info".into(), json: false, file_bytes_max: 1 << 20, files_kept: 1 };
    Group::new(&GroupSpec { services, restart: LIMITS, log }).unwrap()
}

fn group(services: &[(&str, &[&str])]) -> Group {
    group_of(services.iter().map(|(name, after)| service(name, after)).collect())
}

const NOW: Time = Duration::from_secs(1);

fn settle(group: &mut Group) -> Vec<(usize, Effect)> {
    std::iter::from_fn(|| group.settle(NOW)).collect()
}

fn up(group: &mut Group) {
    group.start(NOW);
    while let Some((service, effect)) = group.settle(NOW) {
        assert_eq!(effect, Effect::Spawn);
        group.on(service, Event::Ready, NOW);
    }
    assert_eq!(group.state(), GroupState::Ready);
}

const CHAIN: &[(&str, &[&str])] = &[("c", &["b"]), ("a", &[]), ("b", &["a"])];
const CRASH: Event = Event::Exited(ProcessExit::Signal(9));

#[test]
fn restart_does_not_affect_dependent_services() {
    let mut group = group(CHAIN);
    up(&mut group);
    assert_eq!(group.on(1, CRASH, NOW), Some(Effect::Spawn));
    assert_eq!(settle(&mut group), []);
    assert_eq!(group.state(), GroupState::Degraded);
    group.on(1, Event::Ready, NOW);
    assert_eq!(group.state(), GroupState::Ready);
}

#[test]
fn group_is_degraded_while_a_running_service_is_short_of_a_resource() {
    let mut group = group(CHAIN);
    up(&mut group);
    group.on(1, Event::Short(true), NOW);
    assert_eq!(group.machine(1).state(), ServiceState::Short);
    assert_eq!(group.machine(1).actual(), Actual::Ready);
    assert_eq!(group.state(), GroupState::Degraded);
    assert!(group.is_whole(), "it runs: what waits for it goes on");
    group.on(1, Event::Short(false), NOW);
    assert_eq!(group.state(), GroupState::Ready);
}

#[test]
fn observer_neither_delays_nor_degrades_its_group() {
    let mut services: Vec<_> = CHAIN.iter().map(|(name, after)| service(name, after)).collect();
    services.push(ServiceSpec { observer: true, ..service("eye", &[]) });
    let mut group = group_of(services);
    group.start(NOW);
    while let Some((service, effect)) = group.settle(NOW) {
        assert_eq!(effect, Effect::Spawn);
        if service < CHAIN.len() {
            group.on(service, Event::Ready, NOW);
        }
    }
    assert_eq!(group.state(), GroupState::Ready, "the observer is not ready yet");
    group.on(3, Event::Ready, NOW);
    group.on(3, Event::Short(true), NOW);
    assert_eq!(group.state(), GroupState::Ready);
    for _ in 0..LIMITS.exits_max {
        group.on(3, CRASH, NOW);
        settle(&mut group);
    }
    assert!(!group.is_given_up() && group.state() == GroupState::Ready);
    group.on(1, CRASH, NOW);
    settle(&mut group);
    assert_eq!(group.state(), GroupState::Degraded, "the others count as before");
}

#[test]
fn service_that_crashes_while_stopping_is_not_restarted() {
    let mut group = group(CHAIN);
    up(&mut group);
    group.stop(NOW);
    assert_eq!(group.on(1, CRASH, NOW), None);
    assert_eq!(settle(&mut group), [(0, Effect::Terminate)]);
}

#[test]
fn only_a_critical_service_that_was_given_up_loses_the_group() {
    let mut group = group(CHAIN);
    up(&mut group);
    group.critical[2] = true;
    group.on(0, Event::Exited(ProcessExit::Code(78)), NOW);
    assert_eq!(group.lost(), None);
    group.on(2, Event::Hold, NOW);
    group.on(2, Event::Exited(ProcessExit::Code(0)), NOW);
    assert_eq!(group.lost(), None);
    group.on(2, Event::Start, NOW);
    assert_eq!(settle(&mut group), [(2, Effect::Spawn)]);
    group.on(2, Event::Exited(ProcessExit::Code(78)), NOW);
    assert_eq!(group.lost(), Some((2, HeldBecause::Permanent(ProcessExit::Code(78)))));
}

proptest! {
    #![proptest_config(seeded())]

    /// Whatever order readiness and crashes come in, no service starts for the first time before
    /// those that it comes after are ready, none is stopped before those behind it are at rest, and
    /// a stopped group is still.
    #[test]
    fn order_holds_under_any_interleaving(
        steps in prop::collection::vec((0usize..4, 0u8..4), 0..60),
        stop_at in 0usize..60,
    ) {
        const DIAMOND: &[(&str, &[&str])] =
            &[("d", &["b", "c"]), ("b", &["a"]), ("c", &["a"]), ("a", &[])];
        let mut group = group(DIAMOND);
        let mut now = NOW;
        group.start(now);
        for (step, (service, event)) in steps.into_iter().enumerate() {
            now += Duration::from_millis(37);
            if step == stop_at {
                group.stop(now);
            }
            let event = match event {
                0 | 1 => Event::Ready,
                2 => CRASH,
                _ => Event::Exited(ProcessExit::Code(0)),
            };
            if group.machine(service).is_live() {
                group.on(service, event, now);
            }
            while let Some((service, effect)) = group.settle(now) {
                let schedule = group.schedule.clone();
                if effect == Effect::Spawn && group.machine(service).incarnation() == 1 {
                    for &other in schedule.before(service) {
                        prop_assert_eq!(group.machine(other).actual(), Actual::Ready);
                    }
                }
                if group.is_stopping() && effect == Effect::Terminate {
                    for &other in schedule.behind(service) {
                        prop_assert!(!group.machine(other).is_live());
                    }
                }
            }
        }
        group.stop(now);
        for _ in 0..group.order().len() {
            while group.settle(now).is_some() {}
            for service in 0..group.order().len() {
                let machine = group.machine(service);
                if machine.actual() == Actual::Stopping {
                    group.on(service, Event::Exited(ProcessExit::Signal(15)), now);
                }
            }
        }
        prop_assert!(group.is_stopped());
        prop_assert_eq!(group.settle(now + Duration::from_secs(3600)), None);
    }
}
