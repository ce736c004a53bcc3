//! The processes of the group.

use serde_json::{Value as Json, json};
use supervisor::machine::{Actual, Wanted};
use supervisor::status::{GroupStatus, ServiceStatus};

/// The section.
pub(super) fn section(group: &GroupStatus) -> Json {
    let services = group.services.iter().map(|service| {
        let exit = service.last_exit.as_ref().map(|exit| format!("ended with {}", exit.text));
        let notes = [service.why.clone(), service.says.clone(), exit];
        let note: Vec<String> = notes.into_iter().flatten().collect();
        json!({
            "name": service.name,
            "state": state(service),
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

fn state(service: &ServiceStatus) -> &'static str {
    match service.actual {
        Actual::Down if service.wanted == Wanted::Up => "waiting",
        Actual::Down => "down",
        Actual::Starting => "starting",
        Actual::Ready => "ready",
        Actual::Stopping => "stopping",
        Actual::Backoff => "backoff",
        Actual::Held => "held",
    }
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
