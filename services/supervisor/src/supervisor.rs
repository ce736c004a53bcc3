//! The running supervisor: one thread that waits for events and handles them.
//!
//! It never waits for a service or a client. What takes time is bounded file work: the cleanup of
//! shared memory after a process has ended, mostly on a thread of its own, and a look through `/proc` for what a
//! service left behind.

use std::collections::BTreeMap;
use std::fs::File;
use std::time::{Duration, Instant};

use rustix::process::Pid;
use service::exit::Exit;
use service::group::GroupPaths;
use service::notify::Notifier;
use service::shm_cleanup::Admin;

use crate::Time;
use crate::configuration::{Configuration, Load};
use crate::group::Group;
use crate::machine::{Effect, Event, ServiceState};
use crate::server::Server;
use crate::service::{Service, Surroundings};
use crate::signals::Signals;

pub use start::StartError;

use ending::Ending;
use poll::Ready;
use put_down::PutDown;
use replacing::Replacement;
use waits::Wait;

mod ending;
mod orphans;
mod poll;
mod put_down;
mod reload;
mod replacing;
mod report;
mod requests;
mod start;
mod waits;

/// Polling period of sizes of logs and of processes that are dead, which notify of no change.
const TICK: Duration = Duration::from_secs(1);
/// Interval at which the group's shared files are looked at (there are some fifty, which nobody ought to remove), and
/// dead clients are looked for even if there seem to be none.
const LOOK_EVERY: Duration = Duration::from_secs(3);

/// Delay of a pass after which the machine is assumed to have been suspended.
const STANDSTILL: Duration = Duration::from_millis(500);

/// The supervisor of one group.
pub struct Supervisor {
    started: Instant,
    around: Surroundings,
    configuration: Configuration,
    load: Load,
    /// The scene that an operator has chosen since the start.
    scene: Option<String>,
    group: Group,
    services: Vec<Service>,
    admin: Option<Admin>,
    /// Whether the removal of shared memory of processes that have ended has begun, and perhaps not ended.
    is_cleanup_begun: bool,
    server: Server,
    signals: Signals,
    init_system: Notifier,
    put_down: PutDown,
    waits: Vec<Wait>,
    replacements: BTreeMap<usize, Replacement>,
    orphans: Vec<String>,
    orphans_killed: u32,
    /// Orphans that have been killed and not reaped yet.
    condemned: Vec<Pid>,
    ending: Option<Ending>,
    last_renewal: Option<Time>,
    next_renewal: Time,
    last_pass: Time,
    next_tick: Time,
    /// See [`LOOK_EVERY`].
    next_look: Time,
    reported_ready: bool,
    taken: File,
}

impl Supervisor {
    /// Locks the group, creates its folders and shared memory, and requests its services up.
    ///
    /// To be called on the process's main thread, which must also be the one that runs it:
    /// services are asked to shut down when the thread that started them does. Waits for the services of
    /// an earlier supervisor that was killed, and takes over TERM, INT, HUP and CHLD.
    ///
    /// # Errors
    /// The group cannot be started; see [`StartError`].
    pub fn start(paths: GroupPaths, load: Load, fresh: bool) -> Result<Self, StartError> {
        start::start(paths, load, fresh)
    }

    /// Runs the group until it has ended. Returns the exit code.
    pub fn run(mut self) -> Exit {
        self.settle(self.last_pass);
        loop {
            if let Some(ending) = self.ended() {
                return self.finish(ending);
            }
            let ready = self.wait();
            let now = self.now();
            self.forgive_standstill(now);
            self.take(ready, now);
            if now >= self.next_tick {
                self.next_tick = now + TICK;
                self.tick(now);
            }
            self.settle(now);
        }
    }

    fn now(&self) -> Time {
        self.started.elapsed()
    }

    /// The supervisor itself may have been stopped, or the whole machine. No service is judged by
    /// such a time, in which no notification was read.
    fn forgive_standstill(&mut self, now: Time) {
        let pass = now.saturating_sub(self.last_pass);
        self.last_pass = now;
        if pass > TICK + STANDSTILL {
            tracing::warn!(seconds = pass.as_secs_f64(), "time stood still; deadlines are moved");
            self.group.postpone(pass);
        }
    }

    /// Handles events: notifications first, so that no service is stopped for a missed heartbeat
    /// that has already arrived.
    fn take(&mut self, ready: Ready, now: Time) {
        if ready.signal && self.signals.asked_to_end() {
            self.end(ending::Cause::Signal, now);
        }
        let is_judged = self.group.deadline().is_some_and(|deadline| deadline <= now);
        let voices = if is_judged { (0..self.services.len()).collect() } else { ready.voices };
        for service in voices {
            self.listen(service, now);
        }
        for service in ready.ended {
            if self.services[service].has_ended() {
                self.reap(service);
            }
        }
        if ready.signal && self.signals.child_ended() {
            self.clear_orphans();
        }
        if ready.listener {
            self.server.accept(now);
        }
        for (client, flags) in ready.clients {
            if let Some(request) = self.server.advance(client, flags, now) {
                self.request(client, request, now);
            }
        }
    }

    /// Brings everything forward that can go forward now: the time of this pass, at which all that
    /// was said has been heard. A later look at the clock might follow a standstill.
    fn settle(&mut self, now: Time) {
        loop {
            while let Some((service, effect)) = self.group.settle(now) {
                self.carry_out(service, effect, now);
            }
            if !self.advance_replacements(now) {
                break;
            }
        }
        self.check_critical(now);
        self.answer_waits(now);
        let is_up = self.group.is_whole() && !self.group.is_stopping();
        if !self.reported_ready && is_up {
            self.reported_ready = true;
            tracing::info!(ms = now.as_millis(), "every service is ready");
            self.init_system.say("READY=1");
        }
    }

    fn tick(&mut self, now: Time) {
        self.init_system.beat("WATCHDOG=1");
        self.server.drop_slow(now);
        self.bound_logs();
        let is_look_due = now >= self.next_look;
        if is_look_due {
            self.next_look = now + LOOK_EVERY;
            self.check_topics(now);
        }
        // Each client that was killed would keep its places among a topic's readers and writers.
        if is_look_due || self.has_clients() {
            self.clean();
        }
        if let Some(admin) = &self.admin
            && self.group.state() == service::status::GroupState::Ready
        {
            admin.keep_spare();
        }
    }

    /// Returns true if processes have joined that it has not started, which may have been killed.
    fn has_clients(&self) -> bool {
        let own = 1 + self.services.iter().filter(|service| service.running.is_some()).count();
        self.admin.as_ref().is_some_and(|admin| admin.joined() > own)
    }

    /// Removes the shared memory of processes that have ended.
    fn clean(&mut self) {
        self.is_cleanup_begun = false;
        self.admin.iter().for_each(Admin::clean_dead);
    }

    fn listen(&mut self, service: usize, now: Time) {
        for event in self.services[service].listen(now) {
            self.give(service, event, now);
        }
    }

    /// Requests every service up but those that an operator has put down.
    fn start_group(&mut self, now: Time) {
        self.group.start(now);
        let position = |name: &str| self.services.iter().position(|it| it.spec.name == name);
        self.put_down.apply(&mut self.group, position, now);
    }

    /// Carries out an operator's order for a service, which outlives the supervisor.
    fn order(&mut self, service: usize, order: Event, now: Time) {
        // First: the disk may be slow.
        self.give(service, order, now);
        if self.put_down.note(&self.services[service].spec.name, order) {
            self.put_down.write(&self.around.paths.put_down());
        }
    }

    /// Passes an event to a service and carries out the effects.
    fn give(&mut self, service: usize, event: Event, now: Time) {
        if let Some(effect) = self.group.on(service, event, now) {
            self.carry_out(service, effect, now);
        }
    }

    fn carry_out(&mut self, service: usize, effect: Effect, now: Time) {
        if effect != Effect::Spawn {
            return self.services[service].signal(effect);
        }
        let incarnation = self.group.machine(service).incarnation();
        // Its topics have room for one writer: the predecessor goes first, from shared memory, too. The shipped
        // programs wait for the cleanup that has begun, after they have loaded.
        if self.is_cleanup_begun && !self.services[service].is_shipped() {
            self.clean();
        }
        let spawned = self.services[service].spawn(incarnation, &self.around, now);
        if let Err(exit) = spawned {
            // A start that failed is never followed by another one at once.
            let effect = self.group.on(service, Event::Exited(exit), now);
            debug_assert_eq!(effect, None);
            self.report_rest(service);
        }
    }

    /// Reaps a service's ended process and has its successor started.
    fn reap(&mut self, service: usize) {
        self.listen(service, self.now());
        let failure = self.group.machine(service).failure();
        let has_left_behind = self.note_left_behind(service);
        let ended_at = self.now();
        let Some(exit) = self.services[service].reap(failure, ended_at) else { return };
        self.admin.iter().for_each(Admin::make_way);
        if has_left_behind {
            self.clear_orphans();
        }
        self.is_cleanup_begun = self.admin.as_ref().is_some_and(Admin::begin_cleanup);
        if !self.is_cleanup_begun {
            self.clean();
        }
        self.give(service, Event::Exited(exit), self.now());
        self.report_rest(service);
    }

    /// Logs why an ended service is not started again at once.
    fn report_rest(&self, service: usize) {
        let (name, why) = (self.name(service), self.why(service).unwrap_or_default());
        match self.group.machine(service).state() {
            ServiceState::Short => tracing::warn!(service = name, "{why}; it is retried"),
            ServiceState::Failed => {
                tracing::error!(service = name, "given up: {why}; help: whichone start {name}");
            }
            ServiceState::Held => tracing::info!(service = name, "{why}"),
            _ => {}
        }
    }

    fn bound_logs(&self) {
        let services = self.services.iter().filter(|service| service.running.is_some());
        let names =
            services.map(|service| service.spec.name.as_str()).chain([messages::SUPERVISOR]);
        for name in names {
            match service::log_file::bound(&self.around.paths.log_file(name), &self.around.log) {
                Ok(true) => tracing::warn!(service = name, "its log grew too fast and was cut"),
                Ok(false) => {}
                Err(error) => tracing::warn!(service = name, %error, "its log is not bounded"),
            }
        }
    }

    /// Position of the service with this name.
    fn position(&self, name: &str) -> Option<usize> {
        self.services.iter().position(|service| service.spec.name == name)
    }

    fn name(&self, service: usize) -> &str {
        &self.services[service].spec.name
    }
}
