//! The states of a group in which stops are given: how each begins, and how it ends beside the stop.

use super::Trial;
use super::ways::{Report, Way};
use rustix::process::{Pid, Signal, kill_process};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};
use whichone_tests::{program, wait_for};

/// Length of an outage after the stop was given, unless the way ends before.
const OUTAGE: Duration = Duration::from_millis(1_500);

/// State of the group while a stop is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum During {
    Nothing,
    ArmKilled,
    ArmRestarted,
    ArmHeld,
    ArmSwapped,
    ArmInBackoff,
    SupervisorKilled,
    /// A process does not run, and continues later.
    Suspended(&'static str),
    FullDisk,
    /// A second stop and a release come at the same time.
    Race,
}

pub(super) const STATES: [During; 12] = [
    During::Nothing,
    During::ArmKilled,
    During::ArmRestarted,
    During::ArmHeld,
    During::ArmSwapped,
    During::ArmInBackoff,
    During::SupervisorKilled,
    During::Suspended("policy"),
    During::Suspended("speech"),
    During::Suspended("console"),
    During::FullDisk,
    During::Race,
];

impl Trial {
    /// Gives the stop in that state of the group, which ends soon after.
    pub(super) fn give(&self, way: Way, during: During) -> Report {
        self.enter(during);
        let report = thread::scope(|scope| {
            let giving = scope.spawn(|| self.givers.give(way, &self.group));
            self.pass(during, &giving);
            joined(giving)
        });
        match during {
            During::ArmSwapped => {
                self.group.must(&["restart", "arm", "--original"]);
                report
            }
            // Which order was the latest is chance, and an overruled one says so.
            During::Race => Report { is_accepted: true, ..report },
            _ => report,
        }
    }

    /// Brings what is there before the stop.
    pub(super) fn enter(&self, during: During) {
        let group = &self.group;
        match during {
            During::ArmKilled => group.signal("arm", Signal::KILL),
            During::ArmHeld => _ = group.must(&["hold", "arm"]),
            During::ArmInBackoff => (0..4).for_each(|_| self.kill_ready_arm()),
            During::SupervisorKilled => kill_process(self.supervisor(), Signal::KILL).unwrap(),
            During::Suspended(service) => group.signal(service, Signal::STOP),
            During::FullDisk => self.disk.as_ref().expect("a small disk").fill(),
            During::Nothing | During::ArmRestarted | During::ArmSwapped | During::Race => {}
        }
    }

    /// Brings what happens while the stop is given, and the state's end.
    fn pass(&self, during: During, giving: &ScopedJoinHandle<'_, Report>) {
        let group = &self.group;
        match during {
            During::ArmRestarted => drop(group.call(&["restart", "arm"])),
            During::ArmHeld => {
                outage(giving);
                group.must(&["release", "arm"]);
            }
            During::ArmSwapped => {
                let arm = program("whichone-arm").display().to_string();
                drop(group.call(&["swap", "arm", "--", &arm]));
            }
            During::SupervisorKilled => self.start_again(),
            During::Suspended(service) => {
                outage(giving);
                group.signal(service, Signal::CONT);
            }
            During::FullDisk => {
                outage(giving);
                self.disk.as_ref().expect("a small disk").free();
            }
            During::Race => thread::scope(|scope| {
                scope.spawn(|| group.call(&["resume-motion"]));
                scope.spawn(|| group.call(&["stop-motion"]));
            }),
            During::Nothing | During::ArmKilled | During::ArmInBackoff => {}
        }
    }

    pub(super) fn start_again(&self) {
        let ended = self.group.start_again(&self.givers.settings());
        assert_eq!(ended.code, Some(0), "{ended:?}\n{}", self.group.logs());
    }

    pub(super) fn supervisor(&self) -> Pid {
        let pid = self.group.status()["supervisor_pid"].as_i64().expect("its pid");
        Pid::from_raw(i32::try_from(pid).unwrap()).unwrap()
    }

    fn kill_ready_arm(&self) {
        wait_for("a ready arm", 10.0, || {
            let arm = self.group.service("arm");
            let pid = arm["pid"].as_i64().filter(|_| arm["state"] == "ready")?;
            kill_process(Pid::from_raw(i32::try_from(pid).ok()?)?, Signal::KILL).ok()
        });
    }
}

/// Waits until the way has ended, or the outage is over.
fn outage(giving: &ScopedJoinHandle<'_, Report>) {
    let until = Instant::now() + OUTAGE;
    while !giving.is_finished() && Instant::now() < until {
        thread::sleep(Duration::from_millis(20));
    }
}

fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
