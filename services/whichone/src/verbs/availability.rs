//! Services that do nothing for anyone for now: held, failed, stopped, or short of a resource. A verb
//! that needs one says so at once instead of waiting for an answer.

use std::time::{Duration, Instant};

use messages::Service;
use service::control::{self, CallError, PendingReply, Reply, Request};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::status::{GroupStatus, ServiceState};

/// Timeout of the status.
const STATUS_PATIENCE: Duration = Duration::from_millis(500);
/// Delay of a waiting verb's first look: what has ended already is reported before.
const FIRST_LOOK: Duration = Duration::from_millis(300);
/// Interval at which it looks again.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Services that an accepted utterance still needs.
pub(super) const AFTER_SPEECH: &[Service] = &[Service::Grounding, Service::Policy, Service::Arm];

/// What the supervisor says of its services; nothing where it does not answer, which keeps no client from
/// the services.
pub(super) struct Availability(Option<Box<GroupStatus>>);

/// The same once the supervisor has answered; meanwhile the client can do something else.
pub(super) struct PendingAvailability(Result<PendingReply, CallError>);

impl PendingAvailability {
    /// Waits for the answer.
    pub(super) fn wait(self) -> Availability {
        match self.0.and_then(PendingReply::wait) {
            Ok(Reply::Status(status)) => Availability(Some(status)),
            _ => Availability(None),
        }
    }
}

impl Availability {
    /// Asks the supervisor.
    pub(super) fn request(paths: &GroupPaths) -> PendingAvailability {
        PendingAvailability(control::send(
            &paths.control_socket(),
            &Request::Status,
            STATUS_PATIENCE,
        ))
    }

    /// Asks the supervisor and waits for its answer.
    pub(super) fn now(paths: &GroupPaths) -> Self {
        Self::request(paths).wait()
    }

    /// Fails where the service does nothing for now.
    pub(super) fn require(&self, service: Service) -> Result<(), Failure> {
        match self.first_missing(&[service], |_| true) {
            Some(why) => Err(Failure::new(Exit::NotReached, why)),
            None => Ok(()),
        }
    }

    /// Returns why the first of the services that is in such a state does nothing for now.
    pub(super) fn first_missing(
        &self,
        services: &[Service],
        counts: impl Fn(ServiceState) -> bool,
    ) -> Option<String> {
        let named = |name: &str| services.iter().any(|service| service.name() == name);
        let mut needed = self.0.iter().flat_map(|status| &status.services);
        needed.find_map(|service| {
            let why = service.unavailable().filter(|_| counts(service.state));
            why.filter(|_| named(&service.name))
        })
    }
}

/// Looks now and then whether a dialogue can go on without a person's help.
#[derive(Debug)]
pub(super) struct Lookout {
    due: Instant,
    services: &'static [Service],
    /// Whether a shortage counts, which may pass by itself.
    shortages: bool,
    /// What was reported last.
    reported: Option<String>,
}

impl Lookout {
    /// For one who waits until a shortage has passed.
    pub(super) fn new() -> Self {
        let due = Instant::now() + FIRST_LOOK;
        Self { due, services: &Service::DIALOGUE, shortages: false, reported: None }
    }

    /// For one who waits for these services alone, until a shortage has passed.
    pub(super) fn of(services: &'static [Service]) -> Self {
        Self { services, ..Self::new() }
    }

    /// For one who wants to know of shortages too.
    pub(super) fn with_shortages(self) -> Self {
        Self { shortages: true, ..self }
    }

    /// Returns why the dialogue stands still, where that is news.
    pub(super) fn news(&mut self, paths: &GroupPaths) -> Option<String> {
        if Instant::now() < self.due {
            return None;
        }
        self.due = Instant::now() + LOOK_EVERY;
        let counts = |state| self.shortages || state != ServiceState::Short;
        let why = Availability::now(paths).first_missing(self.services, counts);
        let is_news = why != self.reported;
        self.reported.clone_from(&why);
        why.filter(|_| is_news)
    }
}

#[cfg(test)]
mod tests {
    use service::status::ServiceStatus;

    use super::*;

    #[test]
    fn only_what_does_not_pass_by_itself_is_unavailable() {
        use ServiceState::{
            Down, Failed, Held, Ready, Restarting, Short, Starting, Stopping, Waiting,
        };
        let service = |name: &str, state, why: &str| ServiceStatus {
            name: name.to_owned(),
            state,
            why: Some(why.to_owned()),
            ..ServiceStatus::default()
        };
        let found_why = |state, why| {
            let services = vec![service("console", Failed, ""), service("arm", state, why)];
            let status = Box::new(GroupStatus { services, ..GroupStatus::default() });
            Availability(Some(status)).first_missing(&Service::DIALOGUE, |_| true)
        };
        let found = |state| found_why(state, "so");
        for state in [Ready, Starting, Waiting, Restarting, Stopping] {
            assert_eq!(found(state), None, "{state:?}");
        }
        let held = "arm is held by the operator; help: whichone release arm";
        assert_eq!(found(Held).as_deref(), Some(held));
        let failed = "arm has failed: so; help: whichone logs arm, then start arm";
        assert_eq!(found(Failed).as_deref(), Some(failed));
        let down = "arm is stopped; help: whichone start arm";
        assert_eq!(found(Down).as_deref(), Some(down));
        let short = "arm so; help: free some; it is retried by itself";
        assert_eq!(found(Short).as_deref(), Some(short));
        let why = "waits for /r: Permission denied; help: make the folder writable";
        assert_eq!(found_why(Short, why), Some(format!("arm {why}")));
    }
}
