//! From nothing to ready, and from a kill to ready.

use crate::peers::SPAWN;
use crate::report::Report;
use rustix::process::Signal;
use std::time::Instant;
use whichone_tests::Group;

pub(crate) fn measure(report: &mut Report) {
    let once = |_| {
        let mut group = Group::new();
        let started = Instant::now();
        let ended = group.start(&[]);
        let took = started.elapsed().as_secs_f64() * 1e3;
        assert_eq!(ended.code, Some(0), "{ended:?}");
        group.down();
        took
    };
    let starts: Vec<f64> = (0..10).map(once).collect();
    report.add_beside("group start to all ready", "ms", &starts, SPAWN, "bar: 1000 ms");

    let group = Group::up(&["group.restart.backoff_first_ms=1", "group.restart.backoff_max_ms=2"]);
    for service in ["speech", "grounding", "policy", "arm"] {
        let samples: Vec<f64> = (0..15).map(|_| restart(&group, service)).collect();
        let what = format!("kill -9 of {service} to ready again");
        report.add_beside(&what, "ms", &samples, SPAWN, "bar: 500 ms; seen through `status`");
    }
    group.down();
}

fn restart(group: &Group, service: &str) -> f64 {
    let before = group.incarnation(service);
    group.signal(service, Signal::KILL);
    let killed = Instant::now();
    group.wait_for_restart(service, before);
    killed.elapsed().as_secs_f64() * 1e3
}
