//! Metrics of the services, as the supervisor reports them, and of the recordings.

use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use prometheus_client::collector::Collector;
use prometheus_client::encoding::{DescriptorEncoder, EncodeMetric};
use prometheus_client::metrics::MetricType;
use prometheus_client::metrics::counter::ConstCounter;
use prometheus_client::metrics::gauge::ConstGauge;
use recording::list::{Entry, entries};
use service::status::{GroupState, GroupStatus, ServiceState, ServiceStatus};

/// Gauges and counters that others keep; a counter begins again with its service.
#[derive(Clone, Debug)]
pub(super) struct GroupMetrics {
    /// `None` while the supervisor does not answer.
    status: Arc<Mutex<Option<GroupStatus>>>,
    recordings: PathBuf,
}

impl GroupMetrics {
    pub(super) fn new(recordings: PathBuf) -> Self {
        Self { status: Arc::default(), recordings }
    }

    pub(super) fn set(&self, status: Option<GroupStatus>) {
        *self.status.lock().unwrap_or_else(PoisonError::into_inner) = status;
    }
}

/// A figure of a service: its name, its help, its type, and its value in the status.
type Figure = (&'static str, &'static str, MetricType, fn(&ServiceStatus) -> Option<f64>);

const FIGURES: [Figure; 11] = [
    ("service_ready", "1 for a service that is ready", MetricType::Gauge, |it| {
        Some(f64::from(u8::from(it.state == ServiceState::Ready)))
    }),
    ("service_restarts", "Starts after the first", MetricType::Counter, |it| {
        Some(it.restarts.into())
    }),
    ("service_resident_memory_bytes", "Resident memory", MetricType::Gauge, |it| {
        it.rss_kib.map(|kib| kib as f64 * 1024.0)
    }),
    ("service_cpu_seconds", "Processor time", MetricType::Counter, |it| it.cpu_s),
    ("service_beat_age_seconds", "Since the last heartbeat", MetricType::Gauge, |it| {
        it.beat_age_ms.map(|ms| ms as f64 / 1e3)
    }),
    ("service_input_age_seconds", "Age of the oldest pending input", MetricType::Gauge, |it| {
        it.input_age_ms.map(|ms| ms as f64 / 1e3)
    }),
    ("service_uptime_seconds", "Since the last start", MetricType::Gauge, |it| it.uptime_s),
    ("service_rejected_messages", "Messages rejected as impossible", MetricType::Counter, |it| {
        Some(it.rejected as f64)
    }),
    ("service_lost_messages", "Messages lost by a reader of all", MetricType::Counter, |it| {
        Some(it.lost as f64)
    }),
    ("journal_syncs", "Syncs of the journal", MetricType::Counter, |it| {
        (it.journal_syncs > 0).then_some(it.journal_syncs as f64)
    }),
    ("journal_sync_seconds", "Time of these syncs", MetricType::Counter, |it| {
        (it.journal_syncs > 0).then_some(it.journal_sync_s)
    }),
];

impl Collector for GroupMetrics {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> Result<(), fmt::Error> {
        build(&mut encoder)?;
        let files = entries(&self.recordings);
        let bytes: u64 = files.iter().map(|file| file.bytes).sum();
        let is_written = files.last().is_some_and(Entry::is_being_written);
        let status = self.status.lock().unwrap_or_else(PoisonError::into_inner).clone();
        gauge(&mut encoder, "recordings_bytes", "Size of all recordings", bytes as f64)?;
        gauge(&mut encoder, "recordings_files", "Number of recordings", files.len() as f64)?;
        let Some(status) = status else { return Ok(()) };
        let is_recorder = |it: &&ServiceStatus| it.name == messages::Service::Recorder.name();
        let recorder = status.services.iter().find(is_recorder);
        if let Some(recorder) = recorder {
            let is_recording = recorder.state == ServiceState::Ready && is_written;
            let help = "1 while a recording is being written";
            gauge(&mut encoder, "recorder_recording", help, f64::from(u8::from(is_recording)))?;
        }
        let is_ready = f64::from(u8::from(status.state == GroupState::Ready));
        gauge(&mut encoder, "group_ready", "1 while every wanted service is ready", is_ready)?;
        for (name, help, kind, figure) in FIGURES {
            let mut family = encoder.encode_descriptor(name, help, None, kind)?;
            for service in &status.services {
                let Some(figure) = figure(service) else { continue };
                let labels = [("service", service.name.as_str())];
                let metric = family.encode_family(&labels)?;
                match kind {
                    MetricType::Counter => ConstCounter::new(figure).encode(metric)?,
                    _ => ConstGauge::new(figure).encode(metric)?,
                }
            }
        }
        Ok(())
    }
}

/// The console's build, as labels of a constant.
fn build(encoder: &mut DescriptorEncoder<'_>) -> Result<(), fmt::Error> {
    let build = build_info::current();
    let labels = [
        ("version", build.version.as_str()),
        ("commit", build.commit.as_deref().unwrap_or("unknown")),
        ("features", &build.features.join(",")),
        ("target", &build.target),
    ];
    let help = "Build of the programs";
    let mut family = encoder.encode_descriptor("build_info", help, None, MetricType::Gauge)?;
    ConstGauge::new(1.0).encode(family.encode_family(&labels)?)
}

fn gauge(
    encoder: &mut DescriptorEncoder<'_>,
    name: &str,
    help: &str,
    value: f64,
) -> Result<(), fmt::Error> {
    let metric = encoder.encode_descriptor(name, help, None, MetricType::Gauge)?;
    ConstGauge::new(value).encode(metric)
}
