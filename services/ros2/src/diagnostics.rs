//! The supervisor's status as diagnostics.

use crate::types::{DiagnosticStatus, KeyValue};
use service::status::{GroupStatus, ServiceState, ServiceStatus};

/// Counters of the node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Utterances that the group has accepted.
    pub accepted: u64,
    /// Utterances that were refused: too many at a time, too long, empty, or by the group.
    pub refused: u64,
    /// Messages that could not be read.
    pub unreadable: u64,
    /// Messages that found no room on their way out.
    pub dropped: u64,
    /// Looks of detectors and markers that were passed on to the group.
    pub sightings: u64,
    /// Identifiers of detectors that no label has.
    pub unknown_ids: u64,
    /// Detections without a usable pose.
    pub without_pose: u64,
}

fn value(key: &str, value: impl ToString) -> KeyValue {
    KeyValue { key: key.to_owned(), value: value.to_string() }
}

/// One status for each service, and one for the node. Without an answer of the supervisor, services are
/// not known.
pub fn statuses(group: Result<&GroupStatus, &str>, own: &Counters) -> Vec<DiagnosticStatus> {
    let mut all = match group {
        Ok(group) => group.services.iter().map(|of| service(of, &group.name)).collect(),
        Err(why) => vec![DiagnosticStatus {
            level: DiagnosticStatus::STALE,
            name: "whichone: supervisor".to_owned(),
            message: why.to_owned(),
            ..DiagnosticStatus::default()
        }],
    };
    let hardware_id = group.map_or_else(|_| String::new(), |group| group.name.clone());
    all.push(DiagnosticStatus {
        level: DiagnosticStatus::OK,
        name: "whichone: ROS 2 node".to_owned(),
        message: "running".to_owned(),
        hardware_id,
        values: vec![
            value("accepted", own.accepted),
            value("refused", own.refused),
            value("unreadable", own.unreadable),
            value("dropped", own.dropped),
            value("sightings", own.sightings),
            value("unknown_ids", own.unknown_ids),
            value("without_pose", own.without_pose),
        ],
    });
    all
}

fn service(service: &ServiceStatus, group: &str) -> DiagnosticStatus {
    let level = match service.state {
        ServiceState::Ready => DiagnosticStatus::OK,
        ServiceState::Short | ServiceState::Held | ServiceState::Failed | ServiceState::Down => {
            DiagnosticStatus::ERROR
        }
        ServiceState::Waiting
        | ServiceState::Starting
        | ServiceState::Stopping
        | ServiceState::Restarting => DiagnosticStatus::WARN,
    };
    let word = service.state.word().to_owned();
    let figures = [
        ("pid", service.pid.map(u64::from)),
        ("incarnation", Some(service.incarnation.into())),
        ("restarts", Some(service.restarts.into())),
        ("beat_age_ms", service.beat_age_ms),
        ("rejected", Some(service.rejected)),
        ("rss_kib", service.rss_kib),
    ];
    DiagnosticStatus {
        level,
        name: format!("whichone: {}", service.name),
        message: service.unavailable().unwrap_or(word),
        hardware_id: group.to_owned(),
        values: figures.into_iter().filter_map(|(key, figure)| Some(value(key, figure?))).collect(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn services_are_judged_by_what_they_do_for_a_user() {
        let service = |name: &str, state: &str| {
            json!({ "name": name, "wanted": "up", "actual": "ready", "state": state,
                    "incarnation": 3, "restarts": 2, "pid": 17 })
        };
        let services =
            [service("arm", "ready"), service("policy", "held"), service("speech", "starting")];
        let group = json!({ "name": "lab", "state": "ready", "supervisor_pid": 7, "version": "0",
            "epoch": 1, "uptime_s": 1.0, "scene": "bowls", "config": "/c", "strays_killed": 0,
            "services": services });
        let group: GroupStatus = serde_json::from_value(group).unwrap();
        let found = statuses(Ok(&group), &Counters { refused: 4, ..Counters::default() });
        let levels: Vec<_> =
            found.iter().map(|status| (status.name.as_str(), status.level)).collect();
        assert_eq!(
            levels,
            [
                ("whichone: arm", DiagnosticStatus::OK),
                ("whichone: policy", DiagnosticStatus::ERROR),
                ("whichone: speech", DiagnosticStatus::WARN),
                ("whichone: ROS 2 node", DiagnosticStatus::OK),
            ]
        );
        assert!(found[1].message.contains("held by the operator"), "{}", found[1].message);
        assert!(found[0].values.contains(&value("pid", 17)));
        assert!(found[3].values.contains(&value("refused", 4)));
        let unknown = statuses(Err("no answer"), &Counters::default());
        assert_eq!((unknown.len(), unknown[0].level), (2, DiagnosticStatus::STALE));
    }
}
