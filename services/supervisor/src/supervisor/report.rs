//! Status reports.

use std::path::Path;
use std::time::Duration;

use rustix::process::getpid;

use super::Supervisor;
use crate::Time;
use crate::machine::ServiceState;
use crate::procfs;
use crate::service::{Ended, SHARED_MEMORY, STORAGE};
use service::status::{GroupStatus, LastExit, ServiceStatus};

impl Supervisor {
    /// The group at this moment.
    pub(super) fn status(&self, now: Time) -> GroupStatus {
        let me = procfs::process(getpid());
        GroupStatus {
            name: self.around.paths.name().to_string(),
            state: self.group.state(),
            supervisor_pid: std::process::id(),
            version: build_info::full_version(),
            build: Some(build_info::current().clone()),
            uptime_s: now.as_secs_f64(),
            epoch: self.around.epoch,
            scene: self.configuration.scene.clone(),
            profile: self.configuration.profile.clone(),
            config: self.configuration.directory.clone(),
            set: Some(self.configuration.set.clone()),
            orphans_killed: self.orphans_killed,
            rss_kib: me.as_ref().map(|process| process.rss_kib),
            cpu_s: me.map(|process| process.cpu_s),
            services: (0..self.services.len()).map(|s| self.service_status(s, now)).collect(),
        }
    }

    fn service_status(&self, service: usize, now: Time) -> ServiceStatus {
        let entry = &self.services[service];
        let machine = self.group.machine(service);
        let running = entry.running.as_ref();
        let pid = running.map(|running| running.child.pid());
        let process = pid.and_then(procfs::process);
        let state = machine.state();
        let log_tail = match state {
            ServiceState::Failed | ServiceState::Short => entry.log_tail(&self.around.paths),
            _ => Vec::new(),
        };
        ServiceStatus {
            name: entry.spec.name.clone(),
            wanted: machine.wanted(),
            actual: machine.actual(),
            state,
            why: self.why(service),
            pid: pid.map(|pid| pid.as_raw_nonzero().get().unsigned_abs()),
            incarnation: machine.incarnation(),
            uptime_s: running.map(|running| (now.saturating_sub(running.since)).as_secs_f64()),
            restarts: machine.incarnation().saturating_sub(1),
            beat_age_ms: running.and_then(|running| Some(ms(now.saturating_sub(running.beat?)))),
            input_age_ms: running.and_then(|running| running.input_age(now)).map(ms),
            version: running.and_then(|running| running.version.clone()),
            says: running.and_then(|running| running.says.clone()),
            rejected: running.map_or(0, |running| running.rejected),
            lost: running.map_or(0, |running| running.lost),
            journal_syncs: running.map_or(0, |running| running.syncs.0),
            journal_sync_s: running.map_or(0.0, |running| running.syncs.1.as_secs_f64()),
            swapped: entry.swapped.as_ref().map(|command| command.words.clone()),
            last_exit: entry.ended.as_ref().map(|ended| last_exit(ended, now)),
            log_tail,
            rss_kib: process.as_ref().map(|process| process.rss_kib),
            cpu_s: process.map(|process| process.cpu_s),
        }
    }

    /// Describes a shortage: as it was said, or by what is left where only its kind is known.
    fn waits_for(&self, what: &str) -> String {
        let folder = match what {
            STORAGE => &self.around.paths.journal(),
            SHARED_MEMORY => Path::new("/dev/shm"),
            said => return format!("waits for {said}"),
        };
        let Ok(stat) = rustix::fs::statvfs(folder) else { return format!("waits for {what}") };
        let (free_kib, folder) = ((stat.f_bavail * stat.f_frsize) >> 10, folder.display());
        format!("waits for {what}: {free_kib} KiB free in {folder}")
    }

    /// Returns the reason why a service is not in its wanted state.
    pub(super) fn why(&self, service: usize) -> Option<String> {
        let (machine, entry) = (self.group.machine(service), &self.services[service]);
        if let Some(because) = machine.held_because() {
            return Some(because.to_string());
        }
        // One that runs may be short, too.
        if machine.state() == ServiceState::Short || entry.running.is_some() {
            return entry.shortage().map(|what| self.waits_for(what));
        }
        let missing = self.group.waits_for(service);
        let names: Vec<&str> = missing.iter().map(|&other| self.name(other)).collect();
        (!names.is_empty()).then(|| format!("waits for {}", names.join(" and ")))
    }
}

fn last_exit(ended: &Ended, now: Time) -> LastExit {
    LastExit {
        incarnation: ended.incarnation,
        exit: ended.exit,
        failure: ended.failure,
        killed: ended.killed,
        age_s: now.saturating_sub(ended.at).as_secs_f64(),
        text: ended.text(),
    }
}

fn ms(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}
