//! Order in which services start; they stop in the reverse order.

use thiserror::Error;

use crate::configuration::ServiceSpec;

/// The order of a group: for every service, by index, its neighbours in the `after` relation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    before: Vec<Vec<usize>>,
    behind: Vec<Vec<usize>>,
    order: Vec<usize>,
}

/// Dependencies that admit no order.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ScheduleError {
    /// Two services have the same name.
    #[error("two services are called {0}")]
    Twice(String),
    /// A service comes after one that does not exist.
    #[error("{0} comes after {1}, which is not a service of the group")]
    Unknown(String, String),
    /// Services that wait for each other.
    #[error("these services wait for each other: {}", .0.join(", "))]
    Cycle(Vec<String>),
}

impl Schedule {
    /// The order of these services; those that do not depend on each other keep the order given.
    pub fn new(services: &[ServiceSpec]) -> Result<Self, ScheduleError> {
        let position = |name: &str| services.iter().position(|service| service.name == name);
        let mut before = Vec::with_capacity(services.len());
        let mut behind = vec![Vec::new(); services.len()];
        for (index, service) in services.iter().enumerate() {
            if position(&service.name) != Some(index) {
                return Err(ScheduleError::Twice(service.name.clone()));
            }
            let mut earlier = Vec::with_capacity(service.after.len());
            for name in &service.after {
                let other = position(name)
                    .ok_or_else(|| ScheduleError::Unknown(service.name.clone(), name.clone()))?;
                if !earlier.contains(&other) {
                    earlier.push(other);
                    behind[other].push(index);
                }
            }
            before.push(earlier);
        }
        let order = sort(&before).map_err(|stuck| {
            ScheduleError::Cycle(stuck.into_iter().map(|i| services[i].name.clone()).collect())
        })?;
        Ok(Self { before, behind, order })
    }

    /// Services that have to be ready before `service` starts.
    pub fn before(&self, service: usize) -> &[usize] {
        &self.before[service]
    }

    /// Services that have to be at rest before `service` stops.
    pub fn behind(&self, service: usize) -> &[usize] {
        &self.behind[service]
    }

    /// All services, each after those that it comes after.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

/// Topological order, or the services that are left over because they lie on or behind a cycle.
fn sort(before: &[Vec<usize>]) -> Result<Vec<usize>, Vec<usize>> {
    let mut order: Vec<usize> = Vec::with_capacity(before.len());
    let mut left: Vec<usize> = (0..before.len()).collect();
    while !left.is_empty() {
        let next = left.iter().position(|&i| before[i].iter().all(|other| order.contains(other)));
        match next {
            Some(position) => order.push(left.remove(position)),
            None => return Err(left),
        }
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::group::tests::service;

    fn schedule(services: &[(&str, &[&str])]) -> Result<Schedule, ScheduleError> {
        let services: Vec<_> = services.iter().map(|(name, after)| service(name, after)).collect();
        Schedule::new(&services)
    }

    #[test]
    fn order_respects_after_and_keeps_the_rest_as_given() {
        let found = schedule(&[("a", &["c"]), ("b", &[]), ("c", &["b"]), ("d", &[])]).unwrap();
        assert_eq!(found.order(), [1, 2, 0, 3]);
        assert_eq!(found.before(0), [2]);
        assert_eq!(found.behind(1), [2]);
    }

    #[test]
    fn schedule_reports_cycles_and_unknown_dependencies() {
        assert_eq!(
            schedule(&[("a", &["b"]), ("b", &["a"]), ("c", &[])]),
            Err(ScheduleError::Cycle(vec!["a".into(), "b".into()]))
        );
        assert_eq!(schedule(&[("a", &["a"])]), Err(ScheduleError::Cycle(vec!["a".into()])));
        assert_eq!(schedule(&[("a", &["x"])]), Err(ScheduleError::Unknown("a".into(), "x".into())));
        assert_eq!(schedule(&[("a", &[]), ("a", &[])]), Err(ScheduleError::Twice("a".into())));
    }
}
