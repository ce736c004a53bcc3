//! The state of a whole group: one machine per service and the order among them.
//!
//! Pure, as the machines are: while the group is up, a service is first started once all that it
//! comes after are ready (a later restart of one of those leaves it alone); while the group stops,
//! a service is stopped once all that come after it are at rest.

use service::status::GroupState;

use crate::Time;
use crate::configuration::GroupSpec;
use crate::machine::{Actual, Effect, Event, HeldBecause, Limits, Machine, ServiceState, Wanted};
use crate::schedule::{Schedule, ScheduleError};

#[cfg(test)]
pub(crate) mod tests;

/// All services of a group, and its state as a whole.
#[derive(Clone, Debug)]
pub struct Group {
    machines: Vec<Machine>,
    critical: Vec<bool>,
    observers: Vec<bool>,
    schedule: Schedule,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Not every service has been ready yet.
    Starting,
    /// Every service that is wanted has been ready once.
    Running,
    Stopping,
}

impl Group {
    /// The group at rest.
    pub fn new(spec: &GroupSpec) -> Result<Self, ScheduleError> {
        let schedule = Schedule::new(&spec.services)?;
        let machine = |service| Machine::new(Limits::of(service, spec.restart));
        Ok(Self {
            machines: spec.services.iter().map(machine).collect(),
            critical: spec.services.iter().map(|service| service.critical).collect(),
            observers: spec.services.iter().map(|service| service.observer).collect(),
            schedule,
            phase: Phase::Stopping,
        })
    }

    /// Requests every service up.
    pub fn start(&mut self, now: Time) {
        self.phase = Phase::Starting;
        for machine in &mut self.machines {
            machine.on(Event::Start, now);
        }
    }

    /// Requests every service down, in order.
    pub fn stop(&mut self, now: Time) {
        self.phase = Phase::Stopping;
        for machine in &mut self.machines {
            machine.on(Event::Retire, now);
        }
    }

    /// Gives one event to one service.
    pub fn on(&mut self, service: usize, event: Event, now: Time) -> Option<Effect> {
        self.machines[service].on(event, now)
    }

    /// Brings the group one step forward: the next service to act upon and what to do. To be asked
    /// again until it says `None`, each effect being carried out in between.
    pub fn settle(&mut self, now: Time) -> Option<(usize, Effect)> {
        let effect = (0..self.machines.len())
            .find_map(|service| Some((service, self.on(service, Event::Clock, now)?)))
            .or_else(|| self.next_in_order(now));
        if self.phase == Phase::Starting && self.is_whole() {
            self.phase = Phase::Running;
        }
        effect
    }

    /// The first critical service that was given up, if any: a reason to stop the group.
    pub fn lost(&self) -> Option<(usize, HeldBecause)> {
        (0..self.machines.len()).filter(|&service| self.critical[service]).find_map(|service| {
            let because = self.machines[service].held_because()?;
            (because != HeldBecause::Operator).then_some((service, because))
        })
    }

    /// Returns the state of the group as a whole.
    pub fn state(&self) -> GroupState {
        match self.phase {
            Phase::Stopping => GroupState::Stopping,
            Phase::Starting if self.is_given_up() => GroupState::Degraded,
            Phase::Starting => GroupState::Starting,
            Phase::Running if self.is_whole() && !self.is_short() => GroupState::Ready,
            Phase::Running => GroupState::Degraded,
        }
    }

    /// The services that the group needs to be whole: all but observers.
    fn needed(&self) -> impl Iterator<Item = &Machine> {
        let all = self.machines.iter().zip(&self.observers);
        all.filter(|(_, is_observer)| !**is_observer).map(|(machine, _)| machine)
    }

    /// Returns true if every needed service that is wanted up is ready, be it short of a resource or not.
    pub fn is_whole(&self) -> bool {
        self.needed()
            .all(|machine| machine.wanted() == Wanted::Down || machine.actual() == Actual::Ready)
    }

    /// Returns true if some needed service is short of a resource: it runs, and does not do its work.
    fn is_short(&self) -> bool {
        self.needed().any(|machine| machine.state() == ServiceState::Short)
    }

    /// Returns true if some needed service that is wanted up is held.
    pub fn is_given_up(&self) -> bool {
        self.needed()
            .any(|machine| machine.wanted() == Wanted::Up && machine.actual() == Actual::Held)
    }

    /// Returns true if the group is stopping and no service is running.
    pub fn is_stopped(&self) -> bool {
        self.phase == Phase::Stopping && self.machines.iter().all(|machine| !machine.is_live())
    }

    /// Returns true if the group is being stopped.
    pub fn is_stopping(&self) -> bool {
        self.phase == Phase::Stopping
    }

    /// The services, indexed as in the specification, that `service` still waits for.
    pub fn waits_for(&self, service: usize) -> Vec<usize> {
        let machine = &self.machines[service];
        if machine.wanted() == Wanted::Down || machine.actual() != Actual::Down {
            return Vec::new();
        }
        let is_missing = |&&other: &&usize| self.machines[other].actual() != Actual::Ready;
        self.schedule.before(service).iter().filter(is_missing).copied().collect()
    }

    /// The state of one service.
    pub fn machine(&self, service: usize) -> &Machine {
        &self.machines[service]
    }

    /// Adopts a changed specification of the same services, in the same order.
    pub fn adopt(&mut self, spec: &GroupSpec) -> Result<(), ScheduleError> {
        assert_eq!(spec.services.len(), self.machines.len(), "the set of services is fixed");
        self.schedule = Schedule::new(&spec.services)?;
        self.critical = spec.services.iter().map(|service| service.critical).collect();
        self.observers = spec.services.iter().map(|service| service.observer).collect();
        for (machine, service) in self.machines.iter_mut().zip(&spec.services) {
            machine.limits = Limits::of(service, spec.restart);
        }
        Ok(())
    }

    /// The services in start order.
    pub fn order(&self) -> &[usize] {
        self.schedule.order()
    }

    /// When the next deadline of any service is due.
    pub fn deadline(&self) -> Option<Time> {
        self.machines.iter().filter_map(Machine::deadline).min()
    }

    /// Moves all deadlines of live services: the supervisor stood still for `by`.
    pub fn postpone(&mut self, by: Time) {
        for machine in &mut self.machines {
            machine.postpone(by);
        }
    }

    fn next_in_order(&mut self, now: Time) -> Option<(usize, Effect)> {
        (0..self.machines.len()).find_map(|service| {
            let event = if self.phase == Phase::Stopping {
                let behind = self.schedule.behind(service);
                behind.iter().all(|&other| !self.machines[other].is_live()).then_some(Event::Stop)
            } else {
                let before = self.schedule.before(service);
                let is_ready = |&other: &usize| self.machines[other].actual() == Actual::Ready;
                before.iter().all(is_ready).then_some(Event::Admit)
            };
            Some((service, self.on(service, event?, now)?))
        })
    }
}
