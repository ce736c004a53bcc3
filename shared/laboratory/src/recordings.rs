//! `record list` and `record open`: the files of the recorder.

use std::fs;
use std::path::PathBuf;

use command_line::Outcome;
use command_line::amounts;
use command_line::output::{Output, note, table};
use recording::list::{Entry, State, entries};
use recording::recover::merge;
use recording::{EXTENSION, LeftOut};
use serde_json::json;
use service::exit::{Exit, Failure};
use service::folders::make_private;
use service::group::GroupPaths;

use crate::args::OpenArgs;

/// How a recording is looked at.
const HOW_TO_OPEN: &str = "open it in Foxglove or Lichtblick with the layout \
                           docs/recording-layout.json; docs/recording.md has other tools";

/// Folder of the group for the copy that `record open` has made last.
const COPIES: &str = "opened";

/// Lists the recordings, oldest first.
///
/// # Errors
/// The output is closed.
pub fn list(paths: &GroupPaths, out: &mut Output<'_>) -> Outcome {
    let entries = entries(&paths.recordings());
    if out.is_json() {
        for entry in &entries {
            out.json(&json!({
                "name": name(entry),
                "file": entry.path,
                "began_unix_s": entry.is_own().then_some(entry.began_ns as f64 / 1e9),
                "seconds": entry.seconds(),
                "bytes": entry.bytes,
                "state": entry.state(),
            }))?;
        }
        return Ok(Exit::Ok);
    }
    if entries.is_empty() {
        out.line(format_args!("no recordings in {}", paths.recordings().display()))?;
        return Ok(Exit::Ok);
    }
    let row = |entry: &Entry| {
        let length = entry.seconds().map_or("-".to_owned(), amounts::time);
        let size = amounts::memory(entry.bytes >> 10);
        vec![name(entry), length, size, state(entry).to_owned()]
    };
    let rows: Vec<_> = entries.iter().map(row).collect();
    out.line(paths.recordings().display())?;
    table(&["NAME", "LENGTH", "SIZE", "STATE"], &rows)
        .into_iter()
        .try_for_each(|it| out.line(it))?;
    Ok(Exit::Ok)
}

/// Prints the path of a recording that viewers can open.
///
/// # Errors
/// There is no such recording, or it cannot be read whole or copied.
pub fn open(paths: &GroupPaths, args: &OpenArgs, out: &mut Output<'_>) -> Outcome {
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
    let copy = match (&args.out, entry.state()) {
        (Some(path), _) => {
            safe_files::check_new_output(path).map_err(|error| Failure::file(path, &error))?;
            Some(path.clone())
        }
        (None, State::BeingWritten | State::Incomplete) => Some(place_of_copy(paths, &entry)?),
        (None, _) => None,
    };
    let (path, left_out) = match copy {
        None => (entry.path, LeftOut::default()),
        Some(path) => {
            let (_, left_out) = merge(&[entry.path], &path)?;
            (path, left_out)
        }
    };
    match out.is_json() {
        true => out.json(&json!({ "file": path }))?,
        false => out.line(path.display())?,
    }
    note(HOW_TO_OPEN);
    if left_out.is_nothing() {
        return Ok(Exit::Ok);
    }
    note(format_args!("left out, as it cannot be read: {left_out}"));
    Ok(Exit::NotReached)
}

/// Where a recording is copied to that is not complete. Former copies, which have less of it, are removed.
fn place_of_copy(paths: &GroupPaths, entry: &Entry) -> Result<PathBuf, Failure> {
    let folder = paths.root().join(COPIES);
    make_private(&folder).map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
    for former in fs::read_dir(&folder).into_iter().flatten().flatten() {
        // One that stays takes space.
        let _ = fs::remove_file(former.path());
    }
    Ok(folder.join(format!("{}.{EXTENSION}", name(entry))))
}

/// The name without its end.
fn name(entry: &Entry) -> String {
    let file = entry.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    file.split_once(&format!(".{EXTENSION}")).map_or(file.clone(), |(name, _)| name.to_owned())
}

/// The state in words.
fn state(entry: &Entry) -> &'static str {
    match entry.state() {
        State::Complete => "complete",
        State::BeingWritten => "being written",
        State::Incomplete => "incomplete",
        State::Damaged => "damaged",
        State::Foreign => "not of the recorder",
    }
}
