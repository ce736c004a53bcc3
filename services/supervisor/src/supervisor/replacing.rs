//! Replacing a service's program on request.

use std::path::PathBuf;

use super::Supervisor;
use super::requests::done;
use crate::Time;
use crate::machine::{Event, ServiceState};
use crate::server::Client;
use crate::service::Command;
use crate::swap::{Move, Swap};
use service::control::{Refusal, RefusalKind, Reply};
use service::program::find_program;

/// A replacement under way.
#[derive(Debug)]
pub(super) struct Replacement {
    swap: Swap,
    client: Client,
    /// Previous command of the service.
    previous: Option<Command>,
    /// Reason for the rollback, after one.
    refused: Option<Refusal>,
}

impl Supervisor {
    /// Begins a replacement.
    pub(super) fn replace(
        &mut self,
        client: Client,
        service: usize,
        words: Vec<String>,
        directory: PathBuf,
        now: Time,
    ) -> Result<(), Refusal> {
        if let Err(error) = find_program(&words, &directory) {
            return Err(Refusal::new(RefusalKind::Usage, error.to_string()));
        }
        if self.group.machine(service).state() == ServiceState::Held {
            let why = format!("{0} is held; help: whichone release {0}", self.name(service));
            return Err(Refusal::new(RefusalKind::NotReached, why));
        }
        tracing::info!(service = self.name(service), command = words.join(" "), "swap");
        let swap = Swap::new(self.group.machine(service));
        let previous = self.services[service].replace_command(Some(Command { words, directory }));
        let replacement = Replacement { swap, client, previous, refused: None };
        self.replacements.insert(service, replacement);
        self.order(service, Event::Restart, now);
        Ok(())
    }

    /// Brings every replacement forward; whether any has acted upon its service.
    pub(super) fn advance_replacements(&mut self, now: Time) -> bool {
        let mut has_acted = false;
        for (service, mut replacement) in std::mem::take(&mut self.replacements) {
            let client = replacement.client;
            let reply = match replacement.swap.next(self.group.machine(service)) {
                _ if self.group.is_stopping() => {
                    Reply::Refused(Refusal::new(RefusalKind::NotReached, "the group is stopping"))
                }
                Move::Wait => {
                    self.replacements.insert(service, replacement);
                    continue;
                }
                Move::Restore => {
                    has_acted = true;
                    replacement.refused = Some(self.why_refused(service));
                    self.services[service].replace_command(replacement.previous.take());
                    self.replacements.insert(service, replacement);
                    self.give(service, Event::Restart, now);
                    continue;
                }
                Move::Kept => done(format!("{} runs the new command", self.name(service))),
                Move::Restored => taken_back(replacement, "the earlier command runs again"),
                Move::Lost => taken_back(replacement, "the previous command failed to restart"),
            };
            tracing::info!(service = self.name(service), ?reply, "swap decided");
            self.server.reply(client, &reply, now);
        }
        has_acted
    }

    fn why_refused(&self, service: usize) -> Refusal {
        let entry = &self.services[service];
        let end = entry.ended.as_ref().map(|ended| ended.text()).unwrap_or_default();
        Refusal {
            kind: RefusalKind::NotReached,
            message: format!("{}: the new command was not ready: {end}", self.name(service)),
            details: entry.log_tail(&self.around.paths),
        }
    }
}

fn taken_back(replacement: Replacement, outcome: &str) -> Reply {
    let mut refusal = replacement
        .refused
        .unwrap_or_else(|| Refusal::new(RefusalKind::NotReached, "the new command was not ready"));
    refusal.message = format!("{}; {outcome}", refusal.message);
    Reply::Refused(refusal)
}
