//! Faults in the middle of a dialogue.

use crate::kind::Kind;
use crate::machine::Machine;
use crate::person::Client;
use crate::tally::Tally;
use messages::Service;
use rustix::process::{Pid, Signal, kill_process};
use rustix::time::{ClockId, Timespec, clock_gettime, clock_settime};
use std::time::{Duration, Instant};
use vocabulary::Rng;
use whichone_tests::shortage::{NoDescriptors, SmallDisk};
use whichone_tests::{Group, wait_for};

/// Timeout for a group to be whole after a fault, seconds.
const WHOLE_S: f64 = 60.0;
/// Most that the clock is stepped, seconds.
const STEP_S: usize = 7200;

/// Injects one fault and undoes what can be undone.
pub(crate) fn inject(
    kind: Kind,
    machine: &Machine,
    client: &Client,
    rng: &mut Rng,
    tally: &mut Tally,
) {
    let group = &machine.group;
    let service = Service::BUILT_IN[rng.below(Service::BUILT_IN.len())].name();
    match kind {
        Kind::Kill => {
            group.signal(service, Signal::KILL);
            tally.killed(service);
        }
        Kind::Pause => {
            group.signal(service, Signal::STOP);
            std::thread::sleep(Duration::from_millis(100));
            group.signal(service, Signal::CONT);
        }
        Kind::Restart => {
            // Refused while the service is being restarted already.
            let _ = group.call(&["restart", service]);
        }
        Kind::ClientKill => client.kill(),
        Kind::SupervisorKill => kill_supervisor(group, tally),
        Kind::FullLogs | Kind::FullHome | Kind::FullMemory => {
            full(kind, machine.disk(kind), group, rng, tally);
        }
        Kind::Descriptors => no_descriptors(group, service, rng, tally),
        Kind::ClockStep => step_clock(rng),
        Kind::HostileUser | Kind::JournalLoss => unreachable!("between dialogues"),
    }
}

/// Kills the supervisor and starts the group again: its services end by themselves.
fn kill_supervisor(group: &Group, tally: &mut Tally) {
    let since = Instant::now();
    kill_process(supervisor(group), Signal::KILL).expect("the supervisor runs");
    let ended = group.start_again(&["arm.time_scale=20.0"]);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    tally.recovered(Kind::SupervisorKill, since.elapsed());
}

/// Fills a file system for a while: the robot can be stopped meanwhile, and a service killed; the
/// group is whole again by itself afterwards.
fn full(kind: Kind, disk: &SmallDisk, group: &Group, rng: &mut Rng, tally: &mut Tally) {
    // An arm that was killed a moment ago cannot be asked to stop.
    wait_until_whole(group);
    disk.fill();
    std::thread::sleep(Duration::from_millis(rng.below(1500) as u64));
    let stopped = rng.below(2) == 0;
    if stopped {
        group.must(&["stop-motion"]);
        tally.stops += 1;
    }
    if rng.below(2) == 0 {
        let service = Service::BUILT_IN[rng.below(Service::BUILT_IN.len())].name();
        group.signal(service, Signal::KILL);
        tally.killed(service);
        std::thread::sleep(Duration::from_millis(rng.below(3000) as u64));
    }
    disk.free();
    let since = Instant::now();
    wait_until_whole(group);
    tally.recovered(kind, since.elapsed());
    if stopped {
        resume(group);
    }
}

/// Lifts the motion stop, which is still latched.
fn resume(group: &Group) {
    assert_eq!(group.arm()["stopped"], true, "the stop is latched\n{}", group.logs());
    group.release_stop();
}

/// Takes all further descriptors from a service and the supervisor for a while.
fn no_descriptors(group: &Group, service: &str, rng: &mut Rng, tally: &mut Tally) {
    let held = [supervisor(group), group.pid(service)].map(NoDescriptors::of);
    std::thread::sleep(Duration::from_millis(500 + rng.below(1500) as u64));
    drop(held);
    let since = Instant::now();
    wait_until_whole(group);
    tally.recovered(Kind::Descriptors, since.elapsed());
}

fn supervisor(group: &Group) -> Pid {
    let pid = group.status()["supervisor_pid"].as_i64().expect("a running supervisor");
    Pid::from_raw(i32::try_from(pid).expect("a process id")).expect("a process id")
}

/// Steps the wall clock for half a second, forth or back, and corrects it again.
fn step_clock(rng: &mut Rng) {
    let step = rng.below(2 * STEP_S) as i64 - STEP_S as i64;
    let shift = |by: i64| {
        let now = clock_gettime(ClockId::Realtime);
        clock_settime(ClockId::Realtime, Timespec { tv_sec: now.tv_sec + by, ..now })
            .expect("root may set the clock");
    };
    shift(step);
    std::thread::sleep(Duration::from_millis(500));
    shift(-step);
}

/// Waits until every service is ready, without anybody's help.
pub(crate) fn wait_until_whole(group: &Group) {
    wait_for("a whole group", WHOLE_S, || {
        let status = group.call(&["status", "--json"]);
        let status: serde_json::Value = serde_json::from_str(&status.stdout).ok()?;
        let services = status["services"].as_array()?;
        services.iter().all(|service| service["actual"] == "ready").then_some(())
    });
}
