//! Cost of the recorder: processor, memory and disk, idle and busy, and latencies with and without it.

use crate::idle::{of_process, pids};
use crate::latency::Taps;
use crate::peers::resident_mib;
use crate::report::Report;
use recording::list::{Entry, entries};
use std::time::{Duration, Instant};
use whichone_tests::{Group, wait_for};

/// Utterances measured with the recorder, and as many without.
const UTTERANCES: usize = 200;
/// Rounds in which both are measured in turn, so that a machine that gets busier disturbs both.
const ROUNDS: usize = 4;
const WITHOUT: &str = "utterance in to decision out without the recorder";

pub(crate) fn measure(report: &mut Report, quick: bool) {
    let group = Group::up(&["arm.time_scale=1.0", "group.recorder.free_min_mib=0"]);
    start(&group);
    std::thread::sleep(Duration::from_secs(3));
    let watched = Duration::from_secs(if quick { 5 } else { 60 });
    let idle = cost(&group, || std::thread::sleep(watched));
    let dialogues = if quick { 1 } else { 4 };
    let busy = cost(&group, || {
        for object in ["white2", "clear", "metal2", "white3"].iter().cycle().take(dialogues) {
            group.fetch("get me the bowl", object);
        }
    });
    for (what, cost) in [("idle", &idle), ("in dialogues", &busy)] {
        let note = format!("{:.0} wake-ups a second", cost.wakes);
        report.add(&format!("recorder, CPU {what}"), "% of a core", &[cost.cpu_percent], &note);
        let note = format!("over {:.0} s", cost.seconds);
        report.add(&format!("recorder, disk {what}"), "MiB/h", &[cost.mib_per_hour], &note);
    }
    let mib = pid(&group).and_then(resident_mib).unwrap_or(f64::NAN);
    report.add("recorder, memory", "MiB", &[mib], "resident");
    group.down();
    latencies(report, if quick { UTTERANCES / 4 } else { UTTERANCES });
}

/// End-to-end latencies of the same group with and without the recorder, in turn.
fn latencies(report: &mut Report, utterances: usize) {
    let group = Group::up(&["dialogue.turns.questions_max=1000", "group.recorder.free_min_mib=0"]);
    let client = service::client::Client::join(group.paths()).expect("a running group");
    let mut taps = Taps::open(&client);
    let (mut with, mut without) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        for (verb, samples) in [("stop", &mut without), ("start", &mut with)] {
            group.must(&["record", verb]);
            if verb == "start" {
                start(&group);
            }
            let more = (0..utterances / ROUNDS).map(|n| {
                let moments = taps.utter(n);
                moments[6].saturating_sub(moments[0]) as f64 / 1e6
            });
            samples.extend(more);
        }
    }
    report.add(WITHOUT, "ms", &without, "");
    let what = "utterance in to decision out with the recorder";
    report.add_beside(what, "ms", &with, WITHOUT, "the same group, in turn");
    drop(taps);
    drop(client);
    group.down();
}

fn start(group: &Group) {
    wait_for("a recording", 30.0, || {
        let files = entries(&group.paths().recordings());
        (pid(group).is_some() && files.iter().any(Entry::is_being_written)).then_some(())
    });
}

fn pid(group: &Group) -> Option<i32> {
    pids(group).into_iter().find(|(name, _)| name == "recorder").map(|(_, pid)| pid)
}

struct Cost {
    cpu_percent: f64,
    wakes: f64,
    mib_per_hour: f64,
    seconds: f64,
}

fn cost(group: &Group, act: impl FnOnce()) -> Cost {
    let pid = pid(group).expect("a running recorder");
    let bytes =
        || -> u64 { entries(&group.paths().recordings()).iter().map(|file| file.bytes).sum() };
    let (used, written, began) = (of_process(pid), bytes(), Instant::now());
    act();
    let seconds = began.elapsed().as_secs_f64();
    let more = of_process(pid);
    let grown = bytes().saturating_sub(written) as f64 / f64::from(1 << 20);
    Cost {
        cpu_percent: 100.0 * (more.cpu_s - used.cpu_s) / seconds,
        wakes: (more.wakes - used.wakes) / seconds,
        mib_per_hour: grown / seconds * 3600.0,
        seconds,
    }
}
