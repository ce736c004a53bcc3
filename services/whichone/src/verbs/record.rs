//! `record`: the recorder and its files.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use messages::Service;
use recording::list::{Entry, entries};
use recording::recover::merge;
use recording::{EXTENSION, RecordingError};
use serde_json::json;
use service::control::Request;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::{operate, words};
use crate::Outcome;
use crate::cli::{OpenArgs, RecordVerb, RecorderArgs, ServiceArgs};
use crate::output::{Output, note, table};

/// How a recording is looked at.
const HOW_TO_OPEN: &str = "open it in Foxglove or Lichtblick with the layout \
                           docs/recording-layout.json; docs/recording.md has other tools";

/// Executes `record`.
pub(super) fn record(paths: &GroupPaths, verb: RecordVerb, out: &mut Output<'_>) -> Outcome {
    let recorder = |RecorderArgs { timeout }| ServiceArgs {
        service: Service::Recorder.name().to_owned(),
        timeout,
    };
    match verb {
        RecordVerb::Start(args) => operate::on_service(paths, Request::Start, recorder(args), out),
        RecordVerb::Stop(args) => operate::on_service(paths, Request::Stop, recorder(args), out),
        RecordVerb::List => list(paths, out),
        RecordVerb::Open(args) => open(paths, &args, out),
    }
}

fn list(paths: &GroupPaths, out: &mut Output<'_>) -> Outcome {
    let entries = entries(&paths.recordings());
    if out.is_json() {
        for entry in &entries {
            out.json(&json!({
                "name": name(entry),
                "file": entry.path,
                "began_unix_s": entry.began_ns as f64 / 1e9,
                "seconds": seconds(entry),
                "bytes": entry.bytes,
                "finished": entry.is_finished,
            }))?;
        }
        return Ok(Exit::Ok);
    }
    if entries.is_empty() {
        out.line(format_args!("no recordings in {}", paths.recordings().display()))?;
        return Ok(Exit::Ok);
    }
    let row = |entry: &Entry| {
        let state = if entry.is_finished { "complete" } else { "being written" };
        let size = words::memory(entry.bytes >> 10);
        vec![name(entry), words::time(seconds(entry)), size, state.to_owned()]
    };
    let rows: Vec<_> = entries.iter().map(row).collect();
    out.line(paths.recordings().display())?;
    table(&["NAME", "LENGTH", "SIZE", "STATE"], &rows)
        .into_iter()
        .try_for_each(|it| out.line(it))?;
    Ok(Exit::Ok)
}

fn open(paths: &GroupPaths, args: &OpenArgs, out: &mut Output<'_>) -> Outcome {
    let folder = paths.recordings();
    let wanted = args.name.as_deref().unwrap_or_default();
    let found = entries(&folder).into_iter().rev().find(|entry| name(entry).starts_with(wanted));
    let Some(entry) = found else {
        let what = match wanted {
            "" => format!("no recordings in {}", folder.display()),
            name => format!("no recording {name} in {}", folder.display()),
        };
        return Err(Failure::new(
            Exit::NotReached,
            format!("{what}; help: `whichone record list`"),
        ));
    };
    let copy = args.out.clone();
    let copy = copy.or_else(|| {
        let own = std::env::temp_dir().join(format!("{}.{EXTENSION}", name(&entry)));
        // A former copy of the same recording has less of it.
        (!entry.is_finished).then(|| fs::remove_file(&own)).map(|_| own)
    });
    let path = match copy {
        None => entry.path,
        Some(path) => {
            merge(&[entry.path], &path).map_err(failure)?;
            path
        }
    };
    match out.is_json() {
        true => out.json(&json!({ "file": path }))?,
        false => out.line(path.display())?,
    }
    note(HOW_TO_OPEN);
    Ok(Exit::Ok)
}

/// The name without its end.
fn name(entry: &Entry) -> String {
    let file = entry.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    file.split_once(&format!(".{EXTENSION}")).map_or(file.clone(), |(name, _)| name.to_owned())
}

/// Seconds from its beginning to its last change.
fn seconds(entry: &Entry) -> f64 {
    let changed = entry.path.metadata().and_then(|found| found.modified());
    let changed = changed.unwrap_or_else(|_| SystemTime::now());
    let changed = changed.duration_since(UNIX_EPOCH).unwrap_or_default();
    (changed.as_secs_f64() - entry.began_ns as f64 / 1e9).max(0.0)
}

/// The failure of a verb that writes a recording.
pub(super) fn failure(error: RecordingError) -> Failure {
    Failure::new(Exit::Storage, error.to_string())
}
