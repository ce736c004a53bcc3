//! `group.toml`: scene, services and their restart policy.

use std::time::Duration;

use crate::services::{self, ServiceConfig};
use diagnostics::Fields;
use perception::Frame;
use serde_json::json;
use vocabulary::time::Span;

/// The process group.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The scene as it was named: a name in `scenes/`, or a path that ends with `.toml`.
    pub scene: String,
    /// The services, the built-in ones first, then the others in the order of the text. Every
    /// `after` names one of them and they form no cycle.
    pub services: Vec<ServiceConfig>,
    /// Restart policy.
    pub restart: RestartLimits,
    /// Logs of the services.
    pub log: Log,
    /// Shared memory that must be free for the group to start, MiB.
    pub shared_memory_free_min_mib: u32,
    /// Objects from perception.
    pub perception: Perception,
    /// The flight recorder of each service.
    pub flight: Flight,
}

/// Space of the flights, in which each service records its inputs and statements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flight {
    /// Whether services record.
    pub enabled: bool,
    /// Bytes of all flights of one service together; the oldest are deleted.
    pub bytes_max: u64,
    /// Space of the disk that stays free, bytes: nothing is recorded below.
    pub free_min: u64,
}

/// Objects from perception.
#[derive(Clone, Debug, PartialEq)]
pub struct Perception {
    /// Whether the objects on the table are those that are perceived; else they are the scene's.
    pub enabled: bool,
    /// Settings of the tracker of objects.
    pub tracker: perception::Settings,
}

/// Intensity and backoff of restarts, the same for every service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RestartLimits {
    /// Unexpected exits within [`window`](Self::window) after which a service is held.
    pub exits_max: u32,
    /// See [`exits_max`](Self::exits_max).
    pub window: Duration,
    /// First pause before a restart; it doubles each time.
    pub backoff_first: Duration,
    /// Maximum pause before a restart; at least the first.
    pub backoff_max: Duration,
    /// Time of readiness after which the pause is reset to the first.
    pub backoff_reset: Duration,
}

/// Level and size of the logs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Log {
    /// Filter given to the services, e.g. `info` or `info,policy=debug`.
    pub level: String,
    /// Lines are JSON objects with `timestamp`, `level`, `target` and `fields`; else text.
    pub json: bool,
    /// Size at which a log is rotated, bytes.
    pub file_bytes_max: u64,
    /// Number of rotated logs kept.
    pub files_kept: u32,
}

impl Group {
    /// Returns whether the service of this name has a program of its own.
    pub(crate) fn has_command(&self, service: &str) -> bool {
        self.services.iter().any(|own| own.name == service && own.command.is_some())
    }
}

pub(crate) fn read(f: &mut Fields<'_>) -> Group {
    Group {
        scene: f.text("scene"),
        services: services::read(f),
        restart: f.table("restart", restart),
        log: f.table("log", log),
        shared_memory_free_min_mib: f
            .table("shared_memory", |f| f.whole("free_min_mib", 0..=1 << 20)),
        perception: f.table("perception", perceived),
        flight: f.table("flight", flight),
    }
}

fn flight(f: &mut Fields<'_>) -> Flight {
    Flight {
        enabled: f.flag("enabled"),
        bytes_max: f.whole::<u64>("mib_max", 2..=1 << 24) << 20,
        free_min: f.whole::<u64>("free_min_mib", 0..=1 << 24) << 20,
    }
}

fn perceived(f: &mut Fields<'_>) -> Perception {
    Perception {
        enabled: f.flag("enabled"),
        tracker: perception::Settings {
            appear: f.whole("appear_detections", 1..=100),
            moved_m: f.number("moved_m", 0.001..=0.2),
            gate_m: f.number("gate_m", 0.01..=1.0),
            vanish: Span::from_s(f.number("vanish_s", 0.5..=600.0)),
            age_max: Span::from_s(f.number("age_max_s", 0.05..=10.0)),
            hidden_m: f.number("hidden_m", 0.0..=2.0),
            frames: f.list("frames", "", |f| Frame {
                name: f.text("name"),
                xyz: f.triple("xyz"),
                rpy: f.triple("rpy"),
            }),
        },
    }
}

fn restart(f: &mut Fields<'_>) -> RestartLimits {
    let limits = RestartLimits {
        exits_max: f.whole("exits_max", 1..=1_000_000),
        window: f.seconds("window_s", 0.1..=86_400.0),
        backoff_first: Duration::from_millis(f.whole("backoff_first_ms", 1..=600_000)),
        backoff_max: Duration::from_millis(f.whole("backoff_max_ms", 1..=600_000)),
        backoff_reset: f.seconds("backoff_reset_s", 0.0..=86_400.0),
    };
    let whole = !f.is_wrong("backoff_first_ms") && !f.is_wrong("backoff_max_ms");
    if whole && limits.backoff_max < limits.backoff_first {
        let keys = ["backoff_max_ms", "backoff_first_ms"];
        let key = if f.is_built_in(&keys[..1]) { keys[1] } else { keys[0] };
        let help = "raise backoff_max_ms or lower backoff_first_ms";
        f.problem(key, "the first pause is longer than backoff_max_ms", help);
    }
    limits
}

fn log(f: &mut Fields<'_>) -> Log {
    let log = Log {
        level: f.text("level"),
        json: f.choice("format", &[("text", false), ("json", true)]),
        file_bytes_max: f.whole("file_bytes_max", 4096..=1 << 40),
        files_kept: f.whole("files_kept", 0..=1000),
    };
    f.note("level", || {
        let level = format!("[^,]*({})", LEVELS.join("|"));
        json!({ "pattern": format!("^ *({level}) *(, *({level}) *)*$") })
    });
    if !f.is_wrong("level")
        && let Some(wrong) = log.level.split(',').find(|part| !is_directive(part))
    {
        let what = format!("`{}` is not a log level", wrong.trim());
        let help = format!("use one of {}, or NAME=LEVEL,…", LEVELS.join(", "));
        f.problem("level", what, help);
    }
    log
}

const LEVELS: [&str; 6] = ["off", "error", "warn", "info", "debug", "trace"];

/// `LEVEL` or `NAME=LEVEL`.
fn is_directive(part: &str) -> bool {
    let level = part.rsplit_once('=').map_or(part, |(_, level)| level).trim();
    LEVELS.contains(&level.to_lowercase().as_str())
}
