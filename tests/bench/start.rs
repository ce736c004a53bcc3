//! From nothing to ready, and from a kill to ready.

use crate::peers::SPAWN;
use crate::report::Report;
use rustix::process::Signal;
use service::control::{Reply, Request, call};
use service::status::{Actual, ServiceStatus};
use std::time::{Duration, Instant};
use whichone_tests::Group;

/// Groups that are started, each for the first time and then again.
const STARTS: usize = 10;
/// Kills of each service.
const KILLS: usize = 15;
/// Interval at which the supervisor is asked for a service's readiness.
const ASK_EVERY: Duration = Duration::from_millis(1);
/// Timeout of its answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// Time that a service has been ready before it is killed.
const REST: Duration = Duration::from_millis(200);

pub(crate) fn measure(report: &mut Report) {
    let (first, again): (Vec<f64>, Vec<f64>) = (0..STARTS).map(|_| starts()).unzip();
    let note = "`whichone up --wait ready`, from its start to its end; nothing on the disk yet";
    report.add_beside("first start of a group to all ready", "ms", &first, SPAWN, note);
    let note = "the same with journals and cached decisions; bar: 150 ms";
    report.add_beside("later start of a group to all ready", "ms", &again, SPAWN, note);

    let group = Group::up(&[
        "group.restart.backoff_first_ms=1",
        "group.restart.backoff_max_ms=2",
        "group.restart.exits_max=1000",
    ]);
    for service in ["speech", "grounding", "policy", "arm"] {
        let samples: Vec<f64> = (0..KILLS).map(|_| restart(&group, service)).collect();
        let what = format!("kill -9 of {service} to ready again");
        let note = "the supervisor is asked every millisecond; bar: 35 ms";
        report.add_beside(&what, "ms", &samples, SPAWN, note);
    }
    verbs(&group, report);
    group.down();
}

/// Starts a group for the first time, and again. Returns both durations, milliseconds.
fn starts() -> (f64, f64) {
    let mut group = Group::new();
    let mut start = || {
        let started = Instant::now();
        let ended = group.start(&[]);
        let took_ms = started.elapsed().as_secs_f64() * 1e3;
        assert_eq!(ended.code, Some(0), "{ended:?}");
        group.must(&["down"]);
        took_ms
    };
    (start(), start())
}

/// Kills a service and returns the milliseconds until it is ready again.
pub(crate) fn restart(group: &Group, service: &str) -> f64 {
    std::thread::sleep(REST);
    let before = status(group, service).incarnation;
    let process = group.pid(service);
    let killed = Instant::now();
    rustix::process::kill_process(process, Signal::KILL).expect("a process of ours");
    loop {
        let now = status(group, service);
        if now.incarnation > before && now.actual == Actual::Ready {
            return killed.elapsed().as_secs_f64() * 1e3;
        }
        std::thread::sleep(ASK_EVERY);
    }
}

fn status(group: &Group, service: &str) -> ServiceStatus {
    let reply = call(&group.paths().control_socket(), &Request::Status, PATIENCE);
    let Ok(Reply::Status(status)) = reply else { panic!("no status: {reply:?}") };
    let found = status.services.into_iter().find(|status| status.name == service);
    found.expect("a service of the group")
}

/// Verbs that operators and scripts wait for.
fn verbs(group: &Group, report: &mut Report) {
    let all: [(&[&str], &str); 4] = [
        (&["status"], "bar: 10 ms"),
        (&["status", "--json"], "bar: 10 ms"),
        (&["watch", "--once", "--json"], "bar: 10 ms"),
        (&["say", "start over"], "bar: 6 ms"),
    ];
    for (words, bar) in all {
        let once = |_| {
            let started = Instant::now();
            let ended = group.command(words).output().expect("a built program");
            let took_ms = started.elapsed().as_secs_f64() * 1e3;
            assert!(ended.status.success(), "{ended:?}");
            took_ms
        };
        let samples: Vec<f64> = (0..40).map(once).collect();
        report.add_beside(&format!("whichone {}", words.join(" ")), "ms", &samples, SPAWN, bar);
    }
}
