//! Metrics of a real group, as the parser of Prometheus' own client library reads them.

use std::process::Command;

use serde_json::{Value as Json, json};
use whichone_tests::console::http;
use whichone_tests::{Group, run, wait_for};

/// Everything that is exported, by name.
fn parsed(group: &Group) -> Json {
    let (status, head, text) = http(&group.console(), "GET", "/metrics", &[], "");
    assert_eq!(status, 200);
    assert!(head.contains("application/openmetrics-text; version=1.0.0"), "{head}");
    let python =
        std::env::var("WHICHONE_RECORDING_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/recording/metrics.py");
    let ended = run(Command::new(python).arg(program), &text, 30.0);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{text}");
    ended.json()
}

fn sample(metrics: &Json, family: &str, name: &str, labels: &Json) -> Option<f64> {
    let samples = metrics[family]["samples"].as_array()?;
    samples.iter().find(|it| it[0] == name && it[1] == *labels)?[2].as_f64()
}

#[test]
#[ignore = "needs python3 with prometheus-client"]
fn metrics_are_read_by_prometheus_client() {
    let group = Group::up(&["arm.time_scale=10.0", "group.recorder.free_min_mib=0"]);
    let ended = group.fetch("get me the bowl", "white2");
    group.must(&["restart", "grounding"]);
    let none = json!({});
    let grounding = json!({ "service": "grounding" });
    // The supervisor is asked once a second, and services report their syncs with their heartbeats.
    let journaling = ["speech", "policy", "arm"].map(|it| json!({ "service": it }));
    let metrics = wait_for("the restart and the syncs in the metrics", 20.0, || {
        let metrics = parsed(&group);
        let counted = |name: &str, of: &Json| sample(&metrics, name, &format!("{name}_total"), of);
        let synced = |it: &Json| counted("whichone_journal_syncs", it) > Some(0.0);
        let restarts = counted("whichone_service_restarts", &grounding);
        let ready = "whichone_service_ready";
        let is_back =
            restarts == Some(1.0) && sample(&metrics, ready, ready, &grounding) == Some(1.0);
        (is_back && journaling.iter().all(synced)).then_some(metrics)
    });
    let counted =
        |family: &str, labels: &Json| sample(&metrics, family, &format!("{family}_total"), labels);
    let delivered = json!({ "outcome": "delivered" });
    assert_eq!(counted("whichone_picks", &delivered), Some(1.0));
    assert_eq!(counted("whichone_interactions", &delivered), Some(1.0));
    assert_eq!(counted("whichone_questions", &none), ended["questions"].as_f64());
    let seconds = "whichone_pick_seconds";
    assert_eq!(sample(&metrics, seconds, "whichone_pick_seconds_count", &none), Some(1.0));
    let lasted = sample(&metrics, seconds, "whichone_pick_seconds_sum", &none);
    assert_eq!(lasted, ended["seconds"].as_f64());
    let accepted = counted("whichone_utterances", &json!({ "result": "accepted" }));
    assert_eq!(accepted, group.dialogue()["applied"].as_f64());
    for service in ["speech", "grounding", "policy", "arm", "console", "recorder"] {
        let of = |family: &str| sample(&metrics, family, family, &json!({ "service": service }));
        assert_eq!(of("whichone_service_ready"), Some(1.0), "{service}");
        assert!(of("whichone_service_resident_memory_bytes") > Some(1e6), "{service}");
        assert!(of("whichone_service_beat_age_seconds") < Some(60.0), "{service}");
    }
    for service in &journaling {
        assert!(counted("whichone_journal_sync_seconds", service) > Some(0.0), "{service}");
    }
    assert_eq!(counted("whichone_journal_syncs", &grounding), None, "it has no journal");
    let recorder = json!({ "service": "recorder" });
    assert!(counted("whichone_service_lost_messages", &recorder).is_some());
    let gauge = |name: &str| sample(&metrics, name, name, &none);
    assert_eq!(gauge("whichone_recorder_recording"), Some(1.0));
    assert!(gauge("whichone_recordings_bytes") > Some(0.0));
    assert_eq!(metrics["whichone_pick_seconds"]["type"], "histogram");
    group.down();
}
