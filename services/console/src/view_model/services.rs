//! Services that the group has lost or that are back.

use messages::Service;
use service::status::Actual;
use service::status::{GroupStatus, ServiceStatus};

/// Returns the services that were lost or are back since the status before, and which of both. One
/// that was restarted in between is back.
pub(super) fn transitions<'a>(
    before: Option<&GroupStatus>,
    after: &'a GroupStatus,
) -> Vec<(&'a ServiceStatus, bool)> {
    let Some(before) = before else { return Vec::new() };
    let changed = after.services.iter().filter_map(|now| {
        let was = before.services.iter().find(|was| was.name == now.name)?;
        let (was_ready, is_ready) = (was.actual == Actual::Ready, now.actual == Actual::Ready);
        let is_another = now.incarnation != was.incarnation;
        match (was_ready, is_ready) {
            (true, false) => Some((now, false)),
            (_, true) if is_another && was.incarnation > 0 => Some((now, true)),
            (false, true) if was.incarnation > 0 && was.restarts > 0 => Some((now, true)),
            _ => None,
        }
    });
    changed.collect()
}

/// Returns a service that the dialogue needs and that is not ready.
pub(super) fn missing(group: &GroupStatus) -> Option<&ServiceStatus> {
    let names = Service::DIALOGUE.map(Service::name);
    let mut needed = group.services.iter().filter(|service| names.contains(&&*service.name));
    needed.find(|service| service.actual != Actual::Ready)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(services: &[(&str, Actual, u32)]) -> GroupStatus {
        let service = |&(name, actual, incarnation): &(&str, Actual, u32)| ServiceStatus {
            name: name.to_owned(),
            actual,
            incarnation,
            restarts: incarnation.saturating_sub(1),
            ..ServiceStatus::default()
        };
        GroupStatus { services: services.iter().map(service).collect(), ..GroupStatus::default() }
    }

    fn changes(before: &GroupStatus, after: &GroupStatus) -> Vec<(String, bool)> {
        transitions(Some(before), after)
            .into_iter()
            .map(|(s, back)| (s.name.clone(), back))
            .collect()
    }

    #[test]
    fn services_lost_and_back_are_reported() {
        let well = group(&[("arm", Actual::Ready, 1), ("policy", Actual::Ready, 1)]);
        let lost = group(&[("arm", Actual::Backoff, 1), ("policy", Actual::Ready, 1)]);
        let back = group(&[("arm", Actual::Ready, 2), ("policy", Actual::Ready, 1)]);
        assert!(changes(&well, &well).is_empty() && transitions(None, &lost).is_empty());
        assert_eq!(changes(&well, &lost), [("arm".to_owned(), false)]);
        assert_eq!(changes(&lost, &back), [("arm".to_owned(), true)]);
        assert_eq!(
            changes(&well, &back),
            [("arm".to_owned(), true)],
            "lost and back between two statuses"
        );
        let begins = group(&[("arm", Actual::Starting, 1), ("policy", Actual::Ready, 1)]);
        assert!(changes(&begins, &well).is_empty(), "a first start is not reported");
        assert_eq!(missing(&lost).map(|service| service.name.as_str()), Some("arm"));
        assert!(missing(&well).is_none());
    }
}
