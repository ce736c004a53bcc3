//! Requests that are answered later.

use std::time::Duration;

use super::Supervisor;
use crate::Time;
use crate::machine::{Actual, HeldBecause, ServiceState, Wanted};
use crate::server::Client;
use service::control::{Refusal, RefusalKind, Reply};

/// A client, the condition it waits for, and its answer.
#[derive(Debug)]
pub(super) struct Wait {
    pub(super) client: Client,
    pub(super) goal: Goal,
    pub(super) until: Option<Time>,
    pub(super) then: Reply,
}

/// Condition that a client waits for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// Every service that is wanted up is ready.
    Whole,
    /// These services are ready, each in an incarnation above this number.
    Ready(Vec<(usize, u32)>),
    /// No process of this service runs.
    AtRest(usize),
    /// The group is down; answered when it ends, never here.
    Down,
}

/// Progress of a wait.
enum Standing {
    Reached,
    Open,
    /// It will not be reached: this service stands in the way.
    Lost(usize),
}

impl Supervisor {
    /// Answers at once without a wait or where the condition holds, else later.
    pub(super) fn wait_for(
        &mut self,
        client: Client,
        goal: Goal,
        wait_ms: u64,
        then: Reply,
        now: Time,
    ) {
        if wait_ms == 0 {
            return self.server.reply(client, &then, now);
        }
        let until = Some(now + Duration::from_millis(wait_ms));
        self.waits.push(Wait { client, goal, until, then });
    }

    /// Answers every wait that is over.
    pub(super) fn answer_waits(&mut self, now: Time) {
        for wait in std::mem::take(&mut self.waits) {
            if !self.server.is_waiting(wait.client) {
                continue;
            }
            let is_late = wait.until.is_some_and(|until| now >= until);
            let reply = match self.standing(&wait.goal) {
                Standing::Reached => wait.then,
                Standing::Lost(service) => Reply::Refused(self.why_not_ready(service)),
                Standing::Open if is_late => Reply::Refused(self.too_late(&wait.goal)),
                Standing::Open => {
                    self.waits.push(wait);
                    continue;
                }
            };
            self.server.reply(wait.client, &reply, now);
        }
    }

    fn standing(&self, goal: &Goal) -> Standing {
        match goal {
            Goal::Down => Standing::Open,
            Goal::AtRest(service) if self.group.machine(*service).is_live() => Standing::Open,
            Goal::AtRest(_) => Standing::Reached,
            Goal::Ready(services) => self.standing_of(services.iter().copied()),
            Goal::Whole => {
                let wanted = |&service: &usize| self.group.machine(service).wanted() == Wanted::Up;
                self.standing_of((0..self.services.len()).filter(wanted).map(|s| (s, 0)))
            }
        }
    }

    fn standing_of(&self, services: impl Iterator<Item = (usize, u32)>) -> Standing {
        let mut standing = Standing::Reached;
        for (service, after) in services {
            let machine = self.group.machine(service);
            let is_given_up = machine.actual() == Actual::Held || machine.wanted() == Wanted::Down;
            if is_given_up && !self.replacements.contains_key(&service) {
                return Standing::Lost(service);
            }
            if machine.actual() != Actual::Ready || machine.incarnation() <= after {
                standing = Standing::Open;
            }
        }
        standing
    }

    /// Returns the reason why a service is not ready, with the end of its log.
    fn why_not_ready(&self, service: usize) -> Refusal {
        let name = self.name(service);
        let why = match self.group.machine(service).held_because() {
            Some(HeldBecause::Operator) => format!("{name} is held by the operator"),
            Some(because) => format!("{name} has failed: {because}"),
            None => format!("{name} is not wanted up"),
        };
        let ended = self.services[service].ended.as_ref();
        let end = ended.map(|ended| format!("; it ended with {}", ended.text()));
        Refusal {
            kind: RefusalKind::NotReached,
            message: why + &end.unwrap_or_default(),
            details: self.services[service].log_tail(&self.around.paths),
        }
    }

    fn too_late(&self, goal: &Goal) -> Refusal {
        let concerned: Vec<usize> = match goal {
            Goal::Whole | Goal::Down => (0..self.services.len()).collect(),
            Goal::Ready(services) => services.iter().map(|&(service, _)| service).collect(),
            Goal::AtRest(service) => vec![*service],
        };
        let late = concerned.into_iter().filter_map(|service| {
            let machine = self.group.machine(service);
            let is_late = matches!(goal, Goal::AtRest(_)) || machine.actual() != Actual::Ready;
            is_late.then(|| self.in_words(service))
        });
        let late: Vec<String> = late.collect();
        Refusal::new(RefusalKind::NotReached, format!("not in time: {}", late.join("; ")))
    }

    /// A service and what it does, e.g. `speech waits for policy`.
    fn in_words(&self, service: usize) -> String {
        let name = self.name(service);
        match (self.group.machine(service).state(), self.why(service)) {
            (ServiceState::Waiting | ServiceState::Short, Some(why)) => format!("{name} {why}"),
            (ServiceState::Restarting, _) => format!("{name} pauses before its next start"),
            (ServiceState::Failed, _) => format!("{name} has failed"),
            (state, _) => format!("{name} is {}", state.word()),
        }
    }
}
