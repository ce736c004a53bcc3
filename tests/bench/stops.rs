//! From the command to stop to joints that stand, with everything at hand and in each shortage, and
//! the time until the group is whole again once a shortage ends.

use crate::report::{Report, percentile};
use messages::MotionOrder;
use rustix::process::{Pid, Signal, kill_process};
use service::clock;
use service::stop_socket::{StopClient, StopOrder, StopState};
use std::time::{Duration, Instant};
use whichone_tests::shortage::{
    BusyDisk, JointWatch, NoDescriptors, SmallDisk, SmallGroup, has_private_mounts,
};
use whichone_tests::{Group, wait_for};

/// Stops in one pick: all of them in its first motion. One of an arm that stands does not count.
const STOPS: u32 = 3;
/// Picks in each situation.
const PICKS: u32 = 4;
/// Orders to stop whose answers are timed.
const ANSWERS: usize = 100;

/// A group in which one pick after another is stopped several times.
struct Stopped<'a> {
    name: &'a str,
    group: &'a Group,
    picks: u32,
    /// True if the arm's service is killed before the shortage ends.
    kills_arm: bool,
}

pub(crate) fn measure(report: &mut Report, quick: bool) {
    let picks = if quick { 1 } else { PICKS };
    let settings = ["arm.time_scale=1.0"];
    let group = Group::up(&settings);
    let stopped = |name| Stopped { name, group: &group, picks, kills_arm: false };
    stopped("nothing is short").measure(report, || (), |()| {});
    add_answers(report, "nothing is short", &group);
    let busy_disk = "another process writes and syncs";
    stopped(busy_disk).measure(report, || BusyDisk::beside(&group), drop);
    let busy = BusyDisk::beside(&group);
    add_answers(report, busy_disk, &group);
    drop(busy);
    let hang = |pid: Pid| kill_process(pid, Signal::STOP).map(|()| pid).expect("a process of ours");
    // The supervisor may have ended a service that hung for so long.
    let go_on = |pid| {
        let _ = kill_process(pid, Signal::CONT);
    };
    stopped("hung supervisor").measure(report, || hang(supervisor(&group)), go_on);
    stopped("stopped policy").measure(report, || hang(group.pid("policy")), go_on);
    let arm = || NoDescriptors::of(group.pid("arm"));
    stopped("no free descriptor").measure(report, arm, drop);
    if has_private_mounts() {
        let shared_memory = SmallDisk::shared_memory();
        let stopped = stopped("full shared memory");
        stopped.measure(report, || shared_memory.fill(), |()| shared_memory.free());
    }
    group.down();
    if !has_private_mounts() {
        return crate::report::print("without root: stops on a full disk are left out");
    }
    // On a disk as small as this one nothing would ever be recorded, and a service without its recording is not whole.
    let settings =
        ["arm.time_scale=1.0", "group.recorder.free_min_mib=0", "group.flight.free_min_mib=0"];
    for (name, kills_arm) in [("full disk", false), ("full disk, then the arm killed", true)] {
        let SmallGroup { group, disk } = SmallGroup::up(&settings);
        let stopped = Stopped { name, group: &group, picks, kills_arm };
        stopped.measure(report, || disk.fill(), |()| disk.free());
        group.down();
    }
}

impl Stopped<'_> {
    fn measure<T>(&self, report: &mut Report, begin: impl Fn() -> T, end: impl Fn(T)) {
        let joints = JointWatch::open(self.group);
        let (mut stops_ms, mut recoveries_s) = (Vec::new(), Vec::new());
        for pick in 0..self.picks {
            let outcome = self.group.fetch_while("the clear bowl", "clear", || {
                joints.wait_moving();
                let shortage = begin();
                for n in 0..STOPS {
                    joints.wait_moving();
                    std::thread::sleep(Duration::from_millis(u64::from((pick + n) % 4) * 40));
                    stops_ms.extend(joints.stop(self.group));
                    if n + 1 < STOPS {
                        self.group.release_stop();
                    }
                }
                if self.kills_arm {
                    self.group.signal("arm", Signal::KILL);
                }
                end(shortage);
                let ended = Instant::now();
                wait_for("the whole group", 60.0, || self.is_whole().then_some(()));
                recoveries_s.push(ended.elapsed().as_secs_f64());
                self.group.release_stop();
            });
            assert_eq!(outcome["outcome"], "delivered", "{outcome}");
        }
        let name = self.name;
        let note = format!("max {:.1} ms; bar: 100 ms of motion", percentile(&stops_ms, 1.0));
        report.add(&format!("stop to rest: {name}"), "ms", &stops_ms, &note);
        report.add(&format!("whole again after: {name}"), "s", &recoveries_s, "");
    }

    /// Returns whether every service is ready and in want of nothing.
    fn is_whole(&self) -> bool {
        let status = self.group.status();
        let services = status["services"].as_array();
        services.is_some_and(|rows| {
            rows.iter().all(|row| row["state"] == "ready" && row["why"].is_null())
        })
    }
}

/// Adds the time from a stop order to the arm's answer: what its main loop adds to the motion.
fn add_answers(report: &mut Report, situation: &str, group: &Group) {
    let client = StopClient::open(group.paths()).expect("a socket");
    let stop = || {
        std::thread::sleep(Duration::from_millis(20));
        answer_ms(&client)
    };
    let answers_ms: Vec<f64> = (0..ANSWERS).map(|_| stop()).collect();
    group.release_stop();
    let note = format!("max {:.2} ms", percentile(&answers_ms, 1.0));
    report.add(&format!("stop order to the arm's answer: {situation}"), "ms", &answers_ms, &note);
}

/// Gives a stop and returns the milliseconds until it is answered.
fn answer_ms(client: &StopClient) -> f64 {
    let (begun, given) = (Instant::now(), clock::now());
    client.send(&StopOrder::new(MotionOrder::Stop, given)).expect("a running arm");
    let is_answer = |state: StopState| state.given_ns == given.ns();
    while !client.take().is_some_and(is_answer) {
        assert!(begun.elapsed() < Duration::from_secs(30), "no answer");
        std::thread::sleep(Duration::from_micros(50));
    }
    begun.elapsed().as_secs_f64() * 1e3
}

fn supervisor(group: &Group) -> Pid {
    let pid = group.status()["supervisor_pid"].as_i64().expect("its pid");
    Pid::from_raw(i32::try_from(pid).expect("a number of a process")).expect("not zero")
}
