//! Taking notice of a changed configuration.

use std::io;

use super::Supervisor;
use super::waits::Goal;
use crate::Time;
use crate::configuration::Configuration;
use crate::configuration::ServiceSpec;
use crate::machine::{Event, HeldBecause, Wanted};
use crate::schedule::Schedule;
use crate::server::Client;
use service::control::{Refusal, RefusalKind, Reply};
use service::logging;

impl Supervisor {
    /// Reloads the configuration, with another scene where `scene` names one, and restarts the affected
    /// services; or, where anything is wrong with it, changes nothing at all.
    pub(super) fn reload(
        &mut self,
        client: Client,
        scene: Option<String>,
        wait_ms: u64,
        now: Time,
    ) -> Result<(), Refusal> {
        if !self.replacements.is_empty() {
            let why = "a service is just being swapped; ask again when that is decided";
            return Err(Refusal::new(RefusalKind::NotReached, why));
        }
        let wrong = |details: Vec<String>| {
            let message = "invalid configuration; nothing was changed".to_owned();
            Refusal { kind: RefusalKind::Config, message, details }
        };
        let scene = scene.or_else(|| self.scene.clone());
        let configuration = (self.load)(scene.as_deref()).map_err(wrong)?;
        self.check_same_services(&configuration.spec.services)?;
        let orderly = Schedule::new(&configuration.spec.services);
        orderly.map_err(|error| wrong(vec![error.to_string()]))?;
        if let Err(error) = (configuration.publish)(&self.around.paths) {
            return Err(self.not_written(&error));
        }
        let adopted = self.group.adopt(&configuration.spec);
        adopted.map_err(|error| wrong(vec![error.to_string()]))?;
        let changed = self.put_into_force(configuration);
        self.scene = scene;
        let restarted: Vec<usize> =
            changed.into_iter().filter(|&service| self.is_to_restart(service)).collect();
        let after = |&service: &usize| (service, self.group.machine(service).incarnation());
        let goal = Goal::Ready(restarted.iter().map(after).collect());
        for &service in &restarted {
            self.give(service, Event::Restart, now);
        }
        let restarted: Vec<String> = restarted.iter().map(|&s| self.name(s).to_owned()).collect();
        tracing::info!(?restarted, "configuration reloaded");
        self.wait_for(client, goal, wait_ms, Reply::Reloaded { restarted }, now);
        Ok(())
    }

    /// The settings in force stay what they are where the new ones cannot be written.
    fn not_written(&self, error: &io::Error) -> Refusal {
        let run = self.around.paths.run();
        let free = rustix::fs::statvfs(&run).map(|stat| (stat.f_bavail * stat.f_frsize) >> 10);
        let free = free.map(|kib| format!(", {kib} KiB free")).unwrap_or_default();
        let message = format!(
            "the settings cannot be written to {}: {error}{free}; nothing was changed",
            run.display()
        );
        Refusal::new(RefusalKind::Storage, message)
    }

    /// The set of services is fixed for the life of a group: its topics and journals are.
    fn check_same_services(&self, services: &[ServiceSpec]) -> Result<(), Refusal> {
        let now = self.services.iter().map(|service| &service.spec.name);
        if now.eq(services.iter().map(|service| &service.name)) {
            return Ok(());
        }
        let why = "services were added, removed or put in another order; \
                   that takes `whichone down` and `whichone up`";
        Err(Refusal::new(RefusalKind::Config, why))
    }

    /// Replaces the configuration; the services that have to be restarted to take notice.
    fn put_into_force(&mut self, configuration: Configuration) -> Vec<usize> {
        let mut changed = Vec::new();
        let new = configuration.spec.services.iter().cloned();
        for (service, (entry, spec)) in self.services.iter_mut().zip(new).enumerate() {
            if needs_restart(&entry.spec, &spec) {
                changed.push(service);
            }
            entry.spec = spec;
        }
        self.around.log = configuration.spec.log.clone();
        logging::set_json(self.around.log.json);
        self.configuration = configuration;
        changed
    }

    fn is_to_restart(&self, service: usize) -> bool {
        let machine = self.group.machine(service);
        let is_kept = machine.held_because() == Some(HeldBecause::Operator);
        machine.wanted() == Wanted::Up && !is_kept
    }
}

/// Deadlines and policies count without a restart; what the process was started with does not.
fn needs_restart(old: &ServiceSpec, new: &ServiceSpec) -> bool {
    let started_with = |spec: &ServiceSpec| {
        (spec.fingerprint.clone(), spec.command.clone(), spec.watchdog, spec.nice)
    };
    started_with(old) != started_with(new)
}
