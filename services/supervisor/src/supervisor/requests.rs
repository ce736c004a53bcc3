//! Requests of an operator.

use super::Supervisor;
use super::ending::Cause;
use super::waits::{Goal, Wait};
use crate::Time;
use crate::machine::{Event, Wanted};
use crate::server::Client;
use service::control::{Refusal, RefusalKind, Reply, Request, Target};

impl Supervisor {
    /// Answers a request, or begins what it asks for and answers when that is done.
    pub(super) fn request(&mut self, client: Client, request: Request, now: Time) {
        tracing::debug!(?request, "request");
        if let Err(refusal) = self.try_request(client, request, now) {
            self.server.reply(client, &Reply::Refused(refusal), now);
        }
    }

    fn try_request(&mut self, client: Client, request: Request, now: Time) -> Result<(), Refusal> {
        match request {
            Request::Ping => self.server.reply(client, &done("the supervisor listens".into()), now),
            Request::Status => {
                let status = Reply::Status(Box::new(self.status(now)));
                self.server.reply(client, &status, now);
            }
            Request::Down => {
                self.end(Cause::Asked, now);
                let then = done("down".into());
                self.waits.push(Wait { client, goal: Goal::Down, until: None, then });
            }
            _ if self.group.is_stopping() => {
                return Err(Refusal::new(RefusalKind::NotReached, "the group is stopping"));
            }
            Request::WaitReady { wait_ms } => {
                let then = done("every service that is wanted is ready".into());
                self.wait_for(client, Goal::Whole, wait_ms.max(1), then, now);
            }
            Request::Reload { wait_ms } => self.reload(client, None, wait_ms, now)?,
            Request::UseScene { scene, wait_ms } => {
                self.reload(client, Some(scene), wait_ms, now)?;
            }
            Request::Swap { service, command, directory } => {
                let service = self.find(&service)?;
                self.replace(client, service, command, directory, now)?;
            }
            Request::Start(Target { service, wait_ms }) => {
                let service = self.find(&service)?;
                self.order(service, Event::Start, now);
                self.await_ready(client, service, 0, wait_ms, now);
            }
            Request::Release(Target { service, wait_ms }) => {
                let service = self.find(&service)?;
                self.order(service, Event::Release, now);
                self.await_release(client, service, wait_ms, now);
            }
            Request::Restart { service, original, wait_ms } => {
                let service = self.find(&service)?;
                if original {
                    self.services[service].replace_command(None);
                }
                let before = self.group.machine(service).incarnation();
                self.order(service, Event::Restart, now);
                self.await_ready(client, service, before, wait_ms, now);
            }
            Request::Stop(Target { service, wait_ms }) => {
                self.put_down(client, &service, Event::Stop, wait_ms, now)?;
            }
            Request::Hold(Target { service, wait_ms }) => {
                self.put_down(client, &service, Event::Hold, wait_ms, now)?;
            }
        }
        Ok(())
    }

    fn await_ready(&mut self, client: Client, service: usize, after: u32, wait_ms: u64, now: Time) {
        let name = self.name(service);
        let message = match wait_ms {
            0 => format!("{name} is starting"),
            _ => format!("{name} is ready"),
        };
        self.wait_for(client, Goal::Ready(vec![(service, after)]), wait_ms, done(message), now);
    }

    /// A service that is not wanted up has nothing to become ready for.
    fn await_release(&mut self, client: Client, service: usize, wait_ms: u64, now: Time) {
        if self.group.machine(service).wanted() == Wanted::Up {
            return self.await_ready(client, service, 0, wait_ms, now);
        }
        let message = format!("{} is released, and not wanted up", self.name(service));
        self.server.reply(client, &done(message), now);
    }

    fn put_down(
        &mut self,
        client: Client,
        service: &str,
        event: Event,
        wait_ms: u64,
        now: Time,
    ) -> Result<(), Refusal> {
        let service = self.find(service)?;
        self.order(service, event, now);
        let name = self.name(service);
        let message = match (event, wait_ms) {
            (_, 0) => format!("{name} is stopping"),
            (Event::Hold, _) => format!("{name} is held"),
            _ => format!("{name} is down"),
        };
        self.wait_for(client, Goal::AtRest(service), wait_ms, done(message), now);
        Ok(())
    }

    /// The service that is meant, unless it is being replaced: then it is decided first how that
    /// ends.
    fn find(&self, name: &str) -> Result<usize, Refusal> {
        let Some(service) = self.position(name) else {
            let names: Vec<&str> = (0..self.services.len()).map(|s| self.name(s)).collect();
            let why = format!("unknown service {name}; help: use one of {}", names.join(", "));
            return Err(Refusal::new(RefusalKind::Usage, why));
        };
        if self.replacements.contains_key(&service) {
            let why = format!("{name} is just being swapped; ask again when that is decided");
            return Err(Refusal::new(RefusalKind::NotReached, why));
        }
        Ok(service)
    }
}

pub(super) fn done(message: String) -> Reply {
    Reply::Done { message }
}
