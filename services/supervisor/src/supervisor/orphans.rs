//! Orphaned processes of services. As the nearest subreaper the supervisor inherits them.

use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{
    Pid, PidfdFlags, Signal, WaitOptions, getpid, pidfd_open, pidfd_send_signal, waitpid,
};
use service::group::{ENV_INCARNATION, ENV_SERVICE};

use super::Supervisor;
use crate::procfs::{self, Process};

/// Timeout for the end of the last killed processes.
const END_PATIENCE: Duration = Duration::from_secs(2);

/// Number of orphans reported by name when the group is down.
const ORPHANS_REPORTED_MAX: usize = 100;

impl Supervisor {
    /// Records the other processes in the process group of a service that has ended; they are killed when
    /// the service is reaped. Returns whether any process may have to be cleared away after that: what the
    /// service started and did not end is a child of this process now, or a descendant of one.
    pub(super) fn note_left_behind(&mut self, service: usize) -> bool {
        let Some(running) = &self.services[service].running else { return true };
        let children = procfs::children();
        if children.is_some_and(|all| all.into_iter().all(|child| self.is_of_service(child))) {
            return false;
        }
        let leader = running.child.pid();
        let group = leader.as_raw_nonzero().get();
        let all = procfs::processes();
        let has_orphans = all.iter().any(|process| self.is_orphan(process));
        let left: Vec<Process> = all
            .into_iter()
            .filter(|process| process.group == group && process.pid != leader)
            .filter(|process| !process.is_zombie)
            .collect();
        let name = self.name(service).to_owned();
        // Reported here, and condemned: a killed process may take a while to end, and is not to be
        // reported again meanwhile.
        self.condemned.extend(left.iter().map(|process| process.pid));
        self.report_orphans(&left, &name);
        has_orphans || !left.is_empty()
    }

    /// Reaps orphaned children, and kills those that no running incarnation has
    /// started.
    pub(super) fn clear_orphans(&mut self) {
        for process in self.orphans() {
            if process.is_zombie || !self.belongs_to_running(process.pid) {
                self.clear(process, "a service that has ended");
            }
        }
    }

    /// Kills and reaps every last child, at the end.
    pub(super) fn clear_all(&mut self) {
        let until = Instant::now() + END_PATIENCE;
        loop {
            let left = self.orphans();
            if left.is_empty() || Instant::now() > until {
                break;
            }
            for process in left {
                self.clear(process, "the group");
            }
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Reaps an orphan, or kills it, which is reported once: it may take a while to end.
    fn clear(&mut self, process: Process, of: &str) {
        let pid = process.pid;
        if process.is_zombie {
            // Its pid cannot be reused: it is this process's own child.
            let _ = waitpid(Some(pid), WaitOptions::NOHANG);
            self.condemned.retain(|&condemned| condemned != pid);
        } else {
            kill(pid);
            if !self.condemned.contains(&pid) {
                self.condemned.push(pid);
                self.report_orphans(&[process], of);
            }
        }
    }

    /// Children of this process that are not the process of a service.
    fn orphans(&self) -> Vec<Process> {
        let all = procfs::children().map_or_else(procfs::processes, |children| {
            children.into_iter().filter_map(procfs::process).collect()
        });
        all.into_iter().filter(|process| self.is_orphan(process)).collect()
    }

    fn is_orphan(&self, process: &Process) -> bool {
        process.parent == getpid().as_raw_nonzero().get() && !self.is_of_service(process.pid)
    }

    /// Returns true if this is the process of a service that has not been reaped.
    fn is_of_service(&self, pid: Pid) -> bool {
        let mut running = self.services.iter().filter_map(|service| service.running.as_ref());
        running.any(|running| running.child.pid() == pid)
    }

    /// Returns true if a running incarnation started the process: some programs
    /// put helpers into the background on purpose.
    fn belongs_to_running(&self, pid: Pid) -> bool {
        let environment = procfs::environment(pid);
        let (Some(service), Some(incarnation)) =
            (environment.get(ENV_SERVICE), environment.get(ENV_INCARNATION))
        else {
            // One that has wiped its environment is left alone until the group ends.
            return true;
        };
        self.services.iter().any(|entry| {
            let running = entry.running.as_ref();
            service == entry.spec.name.as_str()
                && running
                    .is_some_and(|running| incarnation == running.incarnation.to_string().as_str())
        })
    }

    fn report_orphans(&mut self, processes: &[Process], of: &str) {
        for process in processes {
            let orphan = format!("{} ({})", process.name, process.pid);
            tracing::warn!(orphan, of, "killed a process that was left behind");
            self.orphans_killed += 1;
            self.orphans.push(orphan);
            if self.orphans.len() > ORPHANS_REPORTED_MAX {
                self.orphans.remove(0);
            }
        }
    }
}

/// Kills one of this process's own children, whose pid is not reused until it is reaped.
fn kill(pid: Pid) {
    if let Ok(pidfd) = pidfd_open(pid, PidfdFlags::empty()) {
        // It may have ended already.
        let _ = pidfd_send_signal(&pidfd, Signal::KILL);
    }
}
