//! Shutdown of a group, and its restart when its shared memory was removed.

use std::fs;
use std::time::Duration;

use messages::Epoch;
use service::exit::Exit;
use service::shm_cleanup::{Admin, remove_leftovers};

use super::Supervisor;
use super::put_down;
use super::start::{StartError, make_folders};
use super::waits::Goal;
use crate::Time;
use crate::machine::HeldBecause;
use crate::server::Server;
use service::control::{DownReport, Refusal, RefusalKind, Reply};

/// A second loss of the topics' files within this time stops the group for good.
const RENEWAL_INTERVAL: Duration = Duration::from_secs(60);

/// Pause after a restart that has failed: what it needs may be short for a while.
const RENEWAL_RETRY: Duration = Duration::from_secs(1);

/// A group that is being stopped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    cause: Cause,
    since: Time,
}

/// Reason for stopping the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// Requested by the operator.
    Asked,
    /// The process was asked to shut down.
    Signal,
    /// A critical service was given up.
    Critical(HeldBecause),
    /// Its files were removed from outside: it is restarted.
    FilesGone,
    /// They were removed again.
    Unusable,
}

impl Supervisor {
    /// Starts to stop the group, in order. A request to shut down has priority over a restart.
    pub(super) fn end(&mut self, cause: Cause, now: Time) {
        match &mut self.ending {
            Some(ending) if ending.cause == Cause::FilesGone => ending.cause = cause,
            Some(_) => {}
            None => {
                tracing::info!(?cause, "the group stops");
                self.init_system.say("STOPPING=1");
                self.ending = Some(Ending { cause, since: now });
                self.group.stop(now);
            }
        }
    }

    /// Returns the exit code once the group has stopped.
    pub(super) fn ended(&mut self) -> Option<Ending> {
        let ending = self.ending.filter(|_| self.group.is_stopped())?;
        if ending.cause != Cause::FilesGone {
            return Some(ending);
        }
        if self.now() < self.next_renewal {
            return None;
        }
        match self.renew() {
            Ok(()) => {
                self.ending = None;
                self.settle(self.now());
            }
            Err(error) => {
                tracing::error!(%error, "the group cannot be started again yet");
                self.next_renewal = self.now() + RENEWAL_RETRY;
            }
        }
        None
    }

    /// Cleans up, answers the waiting clients, and returns the exit code.
    pub(super) fn finish(mut self, ending: Ending) -> Exit {
        self.clear_all();
        let report = self.clear_files(ending);
        let Self { around, server, waits, taken, started, services, .. } = self;
        let now = started.elapsed();
        let paths = around.paths.clone();
        // Released before the answers, so that a client can restart the group at once.
        drop((services, around, taken));
        let mut server: Server = server;
        let down = Reply::Down(report);
        let refused = Reply::Refused(Refusal::new(RefusalKind::NotReached, "the group has ended"));
        for wait in waits {
            let reply = if wait.goal == Goal::Down { &down } else { &refused };
            server.reply(wait.client, reply, now);
        }
        server.finish();
        tracing::info!(group = %paths.name(), "the group is down");
        match ending.cause {
            Cause::Asked | Cause::Signal => Exit::Ok,
            Cause::Critical(HeldBecause::Permanent(_)) => Exit::Config,
            Cause::Critical(_) => Exit::NotReached,
            Cause::FilesGone | Cause::Unusable => Exit::Storage,
        }
    }

    /// Stops the group when a critical service is held.
    pub(super) fn check_critical(&mut self, now: Time) {
        if self.ending.is_some() {
            return;
        }
        if let Some((service, because)) = self.group.lost()
            && !self.replacements.contains_key(&service)
        {
            let service = self.name(service);
            tracing::error!(service, %because, "a critical service is lost");
            self.end(Cause::Critical(because), now);
        }
    }

    /// Checks the files by which new processes find the group. Without them every new process would
    /// silently create a group of its own; only restarting all services repairs that.
    pub(super) fn check_topics(&mut self, now: Time) {
        let is_intact = self.admin.as_ref().is_some_and(Admin::intact)
            && self.around.paths.control_socket().try_exists().unwrap_or(true);
        if is_intact || self.ending.is_some() {
            return;
        }
        let is_first = self.last_renewal.is_none_or(|last| now - last > RENEWAL_INTERVAL);
        let cause = if is_first { Cause::FilesGone } else { Cause::Unusable };
        let folder = self.around.paths.run();
        tracing::warn!(folder = %folder.display(), ?cause, "files of the running group are gone");
        self.end(cause, now);
    }

    /// Recreates the run folder and starts the group.
    fn renew(&mut self) -> Result<(), StartError> {
        let failed = |what| move |error| StartError::Io(what, error);
        let paths = &self.around.paths;
        self.admin = None;
        remove_leftovers(paths);
        make_folders(paths)?;
        (self.configuration.publish)(paths).map_err(failed("settings for the services"))?;
        self.admin = Some(Admin::open(paths, Epoch(self.around.epoch))?);
        if !paths.control_socket().exists() {
            self.server.rebind(&paths.control_socket()).map_err(failed("control socket"))?;
        }
        let now = self.now();
        self.last_renewal = Some(now);
        self.reported_ready = false;
        self.start_group(now);
        Ok(())
    }

    fn clear_files(&mut self, ending: Ending) -> DownReport {
        self.admin = None;
        let paths = &self.around.paths;
        let leftovers = remove_leftovers(paths);
        if let Err(error) = fs::remove_dir_all(paths.run())
            && error.kind() != std::io::ErrorKind::NotFound
        {
            tracing::error!(folder = %paths.run().display(), %error, "not removed");
        }
        if ending.cause == Cause::Asked {
            put_down::forget(&paths.put_down());
        }
        let killed = self.services.iter().filter(|service| {
            service.ended.as_ref().is_some_and(|ended| ended.killed && ended.at >= ending.since)
        });
        DownReport {
            killed: killed.map(|service| service.spec.name.clone()).collect(),
            orphans: std::mem::take(&mut self.orphans),
            leftovers: leftovers.iter().map(|path| path.display().to_string()).collect(),
            seconds: (self.now() - ending.since).as_secs_f64(),
        }
    }
}
