use messages::{ArmStatus, Ended, Outcome, PickOutcome, PolicyView, Receipt, ReceiptStatus};
use messages::{FixedText, InteractionId, UtteranceSeq};
use service::Time;

use super::*;

fn metrics() -> Metrics {
    Metrics::new("/nowhere".into())
}

fn assert_prints(metrics: &Metrics, lines: &[&str]) {
    let text = metrics.text();
    for line in lines {
        assert!(text.lines().any(|printed| printed == *line), "{line} in\n{text}");
    }
}

#[test]
fn metrics_are_exported_under_their_names() {
    let metrics = metrics();
    metrics.viewers.set(3);
    metrics.frames.inc_by(2);
    metrics.latency.observe(0.5);
    // The commit and the features are registered by programs alone.
    let build = format!(
        "whichone_build_info{{version=\"{}\",commit=\"unknown\",features=\"\",target=\"{}\"}} 1.0",
        build_info::VERSION,
        build_info::TARGET
    );
    let lines: [&str; 6] = [
        "whichone_console_viewers 3",
        "whichone_console_frames_total 2",
        "whichone_console_answer_seconds_count 1",
        "whichone_picks_total{outcome=\"delivered\"} 0",
        "whichone_recordings_files 0.0",
        &build,
    ];
    assert_prints(&metrics, &lines);
}

fn ended(interaction: u64, outcome: Outcome) -> Option<Ended> {
    Some(Ended {
        interaction: InteractionId(interaction),
        object: None,
        name: None,
        outcome,
        questions: 2,
        seconds: 7.5,
        utterances: (UtteranceSeq(1), UtteranceSeq(3)),
    })
}

#[test]
fn interactions_and_questions_are_counted_once() {
    let (metrics, mut tally) = (metrics(), Tally::new(Time(0)));
    let view = |interaction, questions, last| PolicyView {
        interaction,
        questions,
        last,
        ..PolicyView::default()
    };
    for (interaction, questions, last) in [
        // State from before the console began.
        (4, 2, ended(3, Outcome::Delivered)),
        (4, 3, ended(3, Outcome::Delivered)),
        (4, 3, ended(3, Outcome::Delivered)),
        (0, 0, ended(4, Outcome::Delivered)),
        (0, 0, ended(4, Outcome::Refused)),
        (5, 1, ended(4, Outcome::Refused)),
    ] {
        tally.on_view(&view(interaction, questions, last), &metrics.dialogue);
    }
    let lines = [
        "whichone_questions_total 2",
        "whichone_interactions_total{outcome=\"delivered\"} 1",
        "whichone_interactions_total{outcome=\"refused\"} 1",
        "whichone_pick_seconds_count 1",
        "whichone_pick_seconds_sum 7.5",
        "whichone_pick_questions_sum 2.0",
    ];
    assert_prints(&metrics, &lines);
}

#[test]
fn picks_are_counted_once_with_their_outcome() {
    let (metrics, mut tally) = (metrics(), Tally::new(Time(0)));
    for (interaction, attempt, outcome) in [
        (1, 1, PickOutcome::Delivered),
        (1, 1, PickOutcome::Delivered),
        (2, 1, PickOutcome::Pending),
        (2, 1, PickOutcome::Missed),
        (2, 2, PickOutcome::Pending),
        (2, 2, PickOutcome::Delivered),
        (2, 2, PickOutcome::Delivered),
    ] {
        let outcome = outcome.into();
        let status = ArmStatus { interaction, attempt, outcome, ..ArmStatus::default() };
        tally.on_arm(&status, &metrics.dialogue);
    }
    let lines = [
        "whichone_picks_total{outcome=\"delivered\"} 1",
        "whichone_picks_total{outcome=\"missed\"} 1",
    ];
    assert_prints(&metrics, &lines);
}

#[test]
fn utterances_are_counted_once_and_spoken_ones_measured() {
    let (metrics, mut tally) = (metrics(), Tally::new(Time(1_000)));
    let receipt = |key, onset_ns, status: ReceiptStatus, snr_db| Receipt {
        key: [key; 16],
        onset_ns,
        status: status.into(),
        snr_db,
        confidence: 0.75,
        note: FixedText::truncated("the white one"),
        ..Receipt::default()
    };
    for (key, onset_ns, status, snr_db) in [
        (1, 999, ReceiptStatus::Accepted, 20.0),
        (2, 1_001, ReceiptStatus::Accepted, 20.0),
        (2, 1_001, ReceiptStatus::Accepted, 20.0),
        (3, 1_002, ReceiptStatus::Accepted, 0.0),
        (4, 1_003, ReceiptStatus::NotForMe, 12.0),
        (5, 1_004, ReceiptStatus::Over, 0.0),
    ] {
        tally.on_receipt(&receipt(key, onset_ns, status, snr_db), &metrics.dialogue);
    }
    let lines = [
        "whichone_utterances_total{result=\"accepted\"} 2",
        "whichone_utterances_total{result=\"not_for_me\"} 1",
        "whichone_recognition_confidence_count 2",
        "whichone_speech_snr_decibels_sum 32.0",
    ];
    assert_prints(&metrics, &lines);
}

/// A status with one service, as the supervisor sends it.
fn status() -> GroupStatus {
    let service = serde_json::json!({
        "name": "recorder", "wanted": "up", "actual": "ready", "state": "ready", "why": null,
        "pid": 7, "incarnation": 3, "uptime_s": 1.5, "restarts": 2, "beat_age_ms": 250,
        "input_age_ms": 10, "version": null, "says": null, "rejected": 1, "lost": 4,
        "journal_syncs": 5, "journal_sync_s": 0.25, "swapped": null, "last_exit": null,
        "rss_kib": 1024, "cpu_s": 0.5
    });
    let group = serde_json::json!({
        "name": "g", "state": "ready", "supervisor_pid": 1, "version": "0", "uptime_s": 9.0,
        "epoch": 1, "scene": "bowls", "profile": null, "config": "/c", "strays_killed": 0,
        "rss_kib": null, "cpu_s": null, "services": [service]
    });
    serde_json::from_value(group).unwrap()
}

#[test]
fn figures_of_services_are_exported_while_the_supervisor_answers() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("2026-11-25T10-08-19.250Z.mcap.part");
    std::fs::write(&file, "12345").unwrap();
    // As the recorder does.
    let file = std::fs::File::open(file).unwrap();
    file.lock().unwrap();
    let metrics = Metrics::new(folder.path().to_owned());
    metrics.set_group(Some(&status()));
    let lines = [
        "whichone_group_ready 1.0",
        "whichone_service_ready{service=\"recorder\"} 1.0",
        "whichone_service_restarts_total{service=\"recorder\"} 2.0",
        "whichone_service_resident_memory_bytes{service=\"recorder\"} 1048576.0",
        "whichone_service_beat_age_seconds{service=\"recorder\"} 0.25",
        "whichone_service_lost_messages_total{service=\"recorder\"} 4.0",
        "whichone_journal_syncs_total{service=\"recorder\"} 5.0",
        "whichone_journal_sync_seconds_total{service=\"recorder\"} 0.25",
        "whichone_recorder_recording 1.0",
        "whichone_recordings_bytes 5.0",
    ];
    assert_prints(&metrics, &lines);
    metrics.set_group(None);
    assert!(!metrics.text().contains("whichone_service_ready"));
}

/// Names of metrics, with the labels that a query uses on each.
fn queried(text: &str) -> Vec<String> {
    let names = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    names.filter(|name| name.starts_with("whichone_")).map(str::to_owned).collect()
}

#[test]
fn dashboard_queries_metrics_and_labels_that_are_exported() {
    let dashboard = include_str!("../../../docs/grafana-dashboard.json");
    let dashboard: serde_json::Value = serde_json::from_str(dashboard).unwrap();
    let metrics = metrics();
    metrics.set_group(Some(&status()));
    let text = metrics.text();
    let exported: Vec<&str> =
        text.lines().filter_map(|line| line.split(['{', ' ']).next()).collect();
    let mut names = Vec::new();
    for panel in dashboard["panels"].as_array().unwrap() {
        for target in panel["targets"].as_array().unwrap() {
            let query = target["expr"].as_str().unwrap();
            let found = queried(query);
            assert!(!found.is_empty(), "{query}");
            for name in &found {
                assert!(exported.contains(&name.as_str()), "{query}: {name} is not exported");
            }
            // Labels used for grouping or in a legend.
            let legend = target["legendFormat"].as_str().unwrap_or_default();
            let by = query.split("by (").nth(1).and_then(|rest| rest.split(')').next());
            let shown = legend.split("{{").nth(1).and_then(|rest| rest.split("}}").next());
            for label in by.into_iter().flat_map(|by| by.split(", ")).chain(shown) {
                let has_label = |line: &str| {
                    line.starts_with(&found[0]) && line.contains(&format!("{label}=\""))
                };
                assert!(text.lines().any(has_label), "{query}: no label {label}");
            }
            names.extend(found);
        }
    }
    for shown in [
        "whichone_picks_total",
        "whichone_questions_total",
        "whichone_pick_seconds_bucket",
        "whichone_service_restarts_total",
        "whichone_service_resident_memory_bytes",
        "whichone_service_beat_age_seconds",
        "whichone_recognition_confidence_bucket",
        "whichone_speech_snr_decibels_bucket",
        "whichone_journal_sync_seconds_total",
        "whichone_recorder_recording",
        "whichone_recordings_bytes",
        "whichone_service_lost_messages_total",
    ] {
        assert!(names.iter().any(|name| name == shown), "{shown} is not shown");
    }
}
