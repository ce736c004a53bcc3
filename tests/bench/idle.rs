//! Cost of an idle group: processor time, wake-ups and memory.

use crate::peers::resident_mib;
use crate::report::Report;
use serde_json::Value as Json;
use std::time::Duration;
use whichone_tests::Group;

/// Duration of the measurement.
const WATCHED: Duration = Duration::from_secs(10);

pub(crate) fn measure(report: &mut Report) {
    let group = Group::up(&["arm.time_scale=1.0"]);
    std::thread::sleep(Duration::from_secs(3));
    let before = used(&group);
    std::thread::sleep(WATCHED);
    let after = used(&group);
    let mut total = Used::default();
    for ((name, before), (_, after)) in before.iter().zip(&after) {
        let percent = 100.0 * (after.cpu_s - before.cpu_s) / WATCHED.as_secs_f64();
        let wakes = (after.wakes - before.wakes) / WATCHED.as_secs_f64();
        total = Used { cpu_s: total.cpu_s + percent, wakes: total.wakes + wakes };
        let note = format!("{wakes:.0} wake-ups a second");
        report.add(&format!("idle CPU of {name}"), "% of a core", &[percent], &note);
    }
    report.add("idle CPU of the group", "% of a core", &[total.cpu_s], "bar: 1 %");
    report.add("idle wake-ups of the group", "1/s", &[total.wakes], "voluntary context switches");
    for (name, pid) in pids(&group) {
        let mib = resident_mib(pid).unwrap_or(0.0);
        report.add(&format!("memory of {name}"), "MiB", &[mib], "resident");
    }
    group.down();
}

/// What a process has used so far.
#[derive(Clone, Copy, Default)]
pub(crate) struct Used {
    /// Processor time by the kernel's own account (user and system), seconds.
    pub(crate) cpu_s: f64,
    /// How often its threads have gone to sleep.
    pub(crate) wakes: f64,
}

fn used(group: &Group) -> Vec<(String, Used)> {
    pids(group).into_iter().map(|(name, pid)| (name, of_process(pid))).collect()
}

/// Sums up the threads of a process.
pub(crate) fn of_process(pid: i32) -> Used {
    let tasks = std::fs::read_dir(format!("/proc/{pid}/task"));
    let tasks = tasks.into_iter().flatten().filter_map(Result::ok).map(|task| task.path());
    let read = |path: std::path::PathBuf| std::fs::read_to_string(path).unwrap_or_default();
    let number = |text: Option<&str>| text.and_then(|it| it.trim().parse::<f64>().ok());
    tasks.fold(Used::default(), |sum, task| {
        let ran_ns = number(read(task.join("schedstat")).split(' ').next());
        let status = read(task.join("status"));
        let slept = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
        Used {
            cpu_s: sum.cpu_s + ran_ns.unwrap_or(0.0) / 1e9,
            wakes: sum.wakes + number(slept).unwrap_or(0.0),
        }
    })
}

pub(crate) fn pids(group: &Group) -> Vec<(String, i32)> {
    let status = group.status();
    let services = status["services"].as_array().expect("services");
    let pid = |pid: &Json| pid.as_i64().and_then(|pid| pid.try_into().ok());
    // One that is stopped has no process.
    let of =
        |row: &Json| Some((row["name"].as_str().expect("a name").to_owned(), pid(&row["pid"])?));
    let supervisor = ("supervisor".to_owned(), pid(&status["supervisor_pid"]).expect("a pid"));
    std::iter::once(supervisor).chain(services.iter().filter_map(of)).collect()
}
