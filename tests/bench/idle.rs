//! Cost of an idle group: processor time and memory.

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
    let before = cpu_s(&group);
    std::thread::sleep(WATCHED);
    let after = cpu_s(&group);
    let mut total = 0.0;
    for ((name, before), (_, after)) in before.iter().zip(&after) {
        let percent = 100.0 * (after - before) / WATCHED.as_secs_f64();
        total += percent;
        report.add(&format!("idle CPU of {name}"), "% of a core", &[percent], "");
    }
    report.add("idle CPU of the group", "% of a core", &[total], "bar: 2 %");
    for (name, pid) in pids(&group) {
        let mib = resident_mib(pid).unwrap_or(0.0);
        report.add(&format!("memory of {name}"), "MiB", &[mib], "resident");
    }
    group.down();
}

/// Processor seconds of each process, from the kernel's own account (user and system).
fn cpu_s(group: &Group) -> Vec<(String, f64)> {
    pids(group).into_iter().map(|(name, pid)| (name, process_cpu_s(pid))).collect()
}

fn process_cpu_s(pid: i32) -> f64 {
    let runtime = std::fs::read_to_string(format!("/proc/{pid}/schedstat")).unwrap_or_default();
    let tasks = std::fs::read_dir(format!("/proc/{pid}/task"));
    let of = |text: String| {
        text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e9
    };
    let Ok(tasks) = tasks else { return of(runtime) };
    let files = tasks.filter_map(Result::ok).map(|task| task.path().join("schedstat"));
    files.map(|path| of(std::fs::read_to_string(path).unwrap_or_default())).sum()
}

fn pids(group: &Group) -> Vec<(String, i32)> {
    let status = group.status();
    let services = status["services"].as_array().expect("services");
    let pid = |pid: &Json| pid.as_i64().and_then(|pid| pid.try_into().ok()).expect("a pid");
    let of = |row: &Json| (row["name"].as_str().expect("a name").to_owned(), pid(&row["pid"]));
    let supervisor = ("supervisor".to_owned(), pid(&status["supervisor_pid"]));
    std::iter::once(supervisor).chain(services.iter().map(of)).collect()
}
