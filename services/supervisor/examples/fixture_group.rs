//! A supervisor for tests: the real one, with a group that a small JSON file describes.
//!
//! Arguments: the group's name and the file. With options instead, the program that `whichone up` starts.

#![expect(clippy::unwrap_used, reason = "a fixture fails loudly")]

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use config::{Log, Restart, RestartLimits};
use serde::Deserialize;
use service::group::{GroupName, GroupPaths};
use supervisor::Supervisor;
use supervisor::configuration::{Configuration, GroupSpec, ServiceSpec};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Group {
    services: Vec<Service>,
    #[serde(default = "five")]
    exits_max: u32,
    #[serde(default = "megabyte")]
    log_bytes_max: u64,
    #[serde(default)]
    shared_memory_free_min_mib: u64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Service {
    name: String,
    command: Vec<String>,
    #[serde(default)]
    after: Vec<String>,
    #[serde(default)]
    critical: bool,
    #[serde(default = "ten_seconds")]
    start_ms: u64,
    #[serde(default)]
    watchdog_ms: Option<u64>,
    #[serde(default = "ten_seconds")]
    stop_ms: u64,
    #[serde(default)]
    fingerprint: String,
}

fn five() -> u32 {
    5
}

fn megabyte() -> u64 {
    1 << 20
}

fn ten_seconds() -> u64 {
    10_000
}

fn main() -> ExitCode {
    if std::env::args().nth(1).is_none_or(|first| first.starts_with("--")) {
        return supervisor::cli::run();
    }
    let _log = service::logging::init();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let paths = GroupPaths::resolve(&GroupName::new(&arguments[0]).unwrap()).unwrap();
    let file = PathBuf::from(&arguments[1]);
    match Supervisor::start(paths, Box::new(move |scene| load(&file, scene)), false) {
        Ok(supervisor) => supervisor.run().code(),
        Err(error) => {
            tracing::error!("{error}");
            error.exit().code()
        }
    }
}

fn load(file: &std::path::Path, scene: Option<&str>) -> Result<Configuration, Vec<String>> {
    let text = std::fs::read_to_string(file).map_err(|error| vec![error.to_string()])?;
    let group: Group = serde_json::from_str(&text).map_err(|error| vec![error.to_string()])?;
    Ok(Configuration {
        spec: GroupSpec {
            services: group.services.into_iter().map(service).collect(),
            restart: RestartLimits {
                exits_max: group.exits_max,
                window: Duration::from_secs(60),
                backoff_first: Duration::from_millis(100),
                backoff_max: Duration::from_secs(5),
                backoff_reset: Duration::from_secs(30),
            },
            log: Log {
                level: "info".into(),
                json: false,
                file_bytes_max: group.log_bytes_max,
                files_kept: 2,
            },
        },
        scene: scene.unwrap_or("bowls").into(),
        profile: None,
        directory: file.parent().unwrap().to_owned(),
        set: Vec::new(),
        shared_memory_free_min_mib: group.shared_memory_free_min_mib,
        publish: Box::new(move |paths| std::fs::write(paths.run().join("published"), &text)),
    })
}

fn service(service: Service) -> ServiceSpec {
    ServiceSpec {
        name: service.name,
        command: service.command,
        is_shipped: false,
        after: service.after,
        critical: service.critical,
        start_deadline: Duration::from_millis(service.start_ms),
        watchdog: service.watchdog_ms.map(Duration::from_millis),
        observer: false,
        stop_deadline: Duration::from_millis(service.stop_ms),
        nice: 0,
        restart: Restart::Always,
        fingerprint: service.fingerprint,
    }
}
