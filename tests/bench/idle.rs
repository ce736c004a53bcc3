//! Cost of an idle group: processor time and memory.

use crate::report::Report;
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
    for (name, kib) in memory(&group) {
        report.add(&format!("memory of {name}"), "MiB", &[kib / 1024.0], "resident");
    }
    group.down();
}

/// Processor seconds of each process, from the kernel's own account (user and system).
fn cpu_s(group: &Group) -> Vec<(String, f64)> {
    pids(group).into_iter().map(|(name, pid)| (name, process_cpu_s(pid))).collect()
}

fn process_cpu_s(pid: i64) -> f64 {
    let runtime = std::fs::read_to_string(format!("/proc/{pid}/schedstat")).unwrap_or_default();
    let tasks = std::fs::read_dir(format!("/proc/{pid}/task"));
    let of = |text: String| {
        text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e9
    };
    let Ok(tasks) = tasks else { return of(runtime) };
    let files = tasks.filter_map(Result::ok).map(|task| task.path().join("schedstat"));
    files.map(|path| of(std::fs::read_to_string(path).unwrap_or_default())).sum()
}

fn pids(group: &Group) -> Vec<(String, i64)> {
    let status = group.status();
    let services = status["services"].as_array().expect("services");
    let supervisor = status["supervisor_pid"].as_i64().expect("a supervisor");
    let of = |row: &serde_json::Value| {
        (row["name"].as_str().expect("a name").to_owned(), row["pid"].as_i64().expect("a pid"))
    };
    std::iter::once(("supervisor".to_owned(), supervisor)).chain(services.iter().map(of)).collect()
}

fn memory(group: &Group) -> Vec<(String, f64)> {
    let resident = |pid: i64| {
        let text = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        let line = text.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
        line.split_whitespace().nth(1).and_then(|kib| kib.parse().ok()).unwrap_or(0.0)
    };
    pids(group).into_iter().map(|(name, pid)| (name, resident(pid))).collect()
}
