//! The processes of the group.

use serde_json::{Value as Json, json};
use service::status::Actual;
use service::status::{GroupStatus, ServiceStatus};

/// The section.
pub(super) fn section(group: &GroupStatus) -> Json {
    let services = group.services.iter().map(|service| {
        let exit = service.last_exit.as_ref().map(|exit| format!("ended with {}", exit.text));
        let notes = [service.why.clone(), service.says.clone(), exit];
        let note: Vec<String> = notes.into_iter().flatten().collect();
        json!({
            "name": service.name,
            "state": service.state(),
            "pid": service.pid,
            "incarnation": service.incarnation,
            "restarts": service.restarts,
            "since_s": service.uptime_s.map(f64::round),
            "rss_kib": service.rss_kib,
            "swapped": service.swapped.as_ref().map(|command| command.join(" ")),
            "note": note.join("; "),
        })
    });
    services.collect()
}

/// Services that were lost or have come back between two looks. One that was killed and came back
/// in between has done both; it is told as back, with how it had ended.
pub(super) fn turns<'a>(
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

/// Whether a service that the dialogue needs is not ready.
pub(super) fn missing(group: &GroupStatus) -> Option<&ServiceStatus> {
    const NEEDED: [&str; 4] = ["speech", "grounding", "policy", "arm"];
    let mut needed = group.services.iter().filter(|service| NEEDED.contains(&&*service.name));
    needed.find(|service| service.actual != Actual::Ready)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(services: &[(&str, &str, u32)]) -> GroupStatus {
        let services: Vec<Json> = services
            .iter()
            .map(|(name, actual, incarnation)| {
                json!({ "name": name, "wanted": "up", "actual": actual, "incarnation": incarnation,
                        "restarts": incarnation.saturating_sub(1) })
            })
            .collect();
        let group = json!({
            "name": "lab", "state": "ready", "supervisor_pid": 7, "version": "0", "epoch": 1,
            "uptime_s": 1.0, "scene": "bowls", "config": "/c", "strays_killed": 0,
            "services": services,
        });
        serde_json::from_value(group).unwrap()
    }

    fn told(before: &GroupStatus, after: &GroupStatus) -> Vec<(String, bool)> {
        turns(Some(before), after).into_iter().map(|(s, back)| (s.name.clone(), back)).collect()
    }

    #[test]
    fn who_is_lost_and_who_is_back() {
        let well = group(&[("arm", "ready", 1), ("policy", "ready", 1)]);
        let lost = group(&[("arm", "backoff", 1), ("policy", "ready", 1)]);
        let back = group(&[("arm", "ready", 2), ("policy", "ready", 1)]);
        assert!(told(&well, &well).is_empty() && turns(None, &lost).is_empty());
        assert_eq!(told(&well, &lost), [("arm".to_owned(), false)]);
        assert_eq!(told(&lost, &back), [("arm".to_owned(), true)]);
        assert_eq!(told(&well, &back), [("arm".to_owned(), true)], "both between two looks");
        let begins = group(&[("arm", "starting", 1), ("policy", "ready", 1)]);
        assert!(told(&begins, &well).is_empty(), "a first start is no news");
        assert_eq!(missing(&lost).map(|service| service.name.as_str()), Some("arm"));
        assert!(missing(&well).is_none());
    }
}
