//! `logs`: the logs of the services.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::thread;
use std::time::Duration;

use clap::Args;
use command_line::Outcome;
use command_line::output::{Ink, Output};
use recording::log_tail::LogFile;
use serde::{Deserialize, Serialize};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::printable::one_line;

/// Arguments of `logs`.
#[derive(Debug, Args)]
pub struct LogsArgs {
    /// Name of a service, or `supervisor` [default: all].
    pub service: Option<String>,
    /// Follow the logs.
    #[arg(long, short)]
    pub follow: bool,
    /// Number of lines from the end.
    #[arg(long, short = 'n', value_name = "N", default_value_t = 40)]
    pub tail: usize,
}

/// Interval at which logs are polled for new lines.
const LOOK_EVERY: Duration = Duration::from_millis(200);

/// Shows the last lines of the logs and follows them.
///
/// # Errors
/// The service has no log, or a log cannot be read.
pub fn logs(paths: &GroupPaths, args: &LogsArgs, out: &mut Output<'_>) -> Outcome {
    let mut files = files(paths, args.service.as_deref())?;
    let mut lines = Vec::new();
    for file in &mut files {
        let last = file.last_lines(args.tail).map_err(|e| Failure::file(file.path(), &e))?;
        lines.extend(last.into_iter().map(|line| (file.service().to_owned(), line)));
    }
    let lines = in_order_of_time(lines);
    let several = files.len() > 1;
    for (service, line) in &lines[lines.len().saturating_sub(args.tail)..] {
        print(several, service, line, out)?;
    }
    if !args.follow {
        return Ok(Exit::Ok);
    }
    loop {
        thread::sleep(LOOK_EVERY);
        follow(paths, args, &mut files, out)?;
    }
}

fn follow(
    paths: &GroupPaths,
    args: &LogsArgs,
    files: &mut Vec<LogFile>,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    if args.service.is_none() {
        // The log of a new service is printed from its beginning.
        let new = self::files(paths, None)?;
        let known = |file: &LogFile| files.iter().any(|k| k.service() == file.service());
        let new: Vec<LogFile> = new.into_iter().filter(|file| !known(file)).collect();
        files.extend(new);
    }
    let several = files.len() > 1;
    let mut lines = Vec::new();
    for file in files {
        let new = file.new_lines().map_err(|e| Failure::file(file.path(), &e))?;
        lines.extend(new.into_iter().map(|line| (file.service().to_owned(), line)));
    }
    in_order_of_time(lines)
        .iter()
        .try_for_each(|(service, line)| print(several, service, line, out))
}

/// A line with `--json`: as it stands in the log, and its parts where it has them.
#[derive(Serialize)]
struct Line<'a> {
    service: &'a str,
    line: &'a str,
    #[serde(flatten)]
    parts: Option<Parts>,
}

/// Parts of a line that a service wrote; a panic or the output of a library has none.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Parts {
    timestamp: String,
    level: String,
    /// The module that wrote it.
    target: String,
    /// Values by name, the text as `message`. Lines of text have the values in the message.
    fields: serde_json::Map<String, serde_json::Value>,
}

/// Returns the parts of a line of either form of the logs.
fn parts(line: &str) -> Option<Parts> {
    if line.starts_with('{') {
        return serde_json::from_str(line).ok();
    }
    let timestamp = time_of(line)?;
    let (level, rest) = line[timestamp.len()..].trim_start().split_once(' ')?;
    let (target, message) = rest.trim_start().split_once(": ")?;
    let is_level = matches!(level, "TRACE" | "DEBUG" | "INFO" | "WARN" | "ERROR");
    is_level.then(|| Parts {
        timestamp: timestamp.to_owned(),
        level: level.to_owned(),
        target: target.to_owned(),
        fields: [("message".to_owned(), message.into())].into_iter().collect(),
    })
}

fn print(several: bool, service: &str, line: &str, out: &mut Output<'_>) -> Result<(), Failure> {
    if out.is_json() {
        return out.json(&Line { service, line, parts: parts(line) });
    }
    let line = one_line(line);
    if !several {
        return out.line(line);
    }
    let service = out.style().paint(Ink::Cyan, format!("{service:<10}"));
    out.line(format_args!("{service} {line}"))
}

/// The log of one service, or all logs of the group.
fn files(paths: &GroupPaths, service: Option<&str>) -> Result<Vec<LogFile>, Failure> {
    let names = names(&paths.log())?;
    match service {
        None => Ok(names.iter().map(|name| LogFile::new(name, paths.log_file(name))).collect()),
        Some(name) if names.iter().any(|known| known == name) => {
            Ok(vec![LogFile::new(name, paths.log_file(name))])
        }
        Some(name) => {
            let what = format!("no log of {name} in {}", paths.log().display());
            let help = match names.is_empty() {
                true => "help: start the group with `whichone up`".to_owned(),
                false => format!("help: existing logs: {}", names.join(", ")),
            };
            Err(Failure::new(Exit::Usage, format!("{what}; {help}")))
        }
    }
}

fn names(folder: &Path) -> Result<Vec<String>, Failure> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(|error| Failure::file(folder, &error))?,
    };
    let name = |entry: std::io::Result<fs::DirEntry>| {
        Some(entry.ok()?.file_name().to_str()?.strip_suffix(".log")?.to_owned())
    };
    let mut names: Vec<String> = entries.filter_map(name).collect();
    names.sort();
    Ok(names)
}

/// Lines of several logs as they were written. A line without a time of its own goes with the one
/// before it.
fn in_order_of_time(lines: Vec<(String, String)>) -> Vec<(String, String)> {
    let mut time = String::new();
    let mut dated: Vec<(String, (String, String))> = Vec::with_capacity(lines.len());
    let mut service = String::new();
    for line in lines {
        if line.0 != service {
            service.clone_from(&line.0);
            time.clear();
        }
        if let Some(own) = time_of(&line.1) {
            time = own.to_owned();
        }
        dated.push((time.clone(), line));
    }
    dated.sort_by(|a, b| a.0.cmp(&b.0));
    dated.into_iter().map(|(_, line)| line).collect()
}

/// The time that a line begins with: as in RFC 3339, always UTC, so that texts compare as times.
fn time_of(line: &str) -> Option<&str> {
    let line = line.strip_prefix("{\"timestamp\":\"").unwrap_or(line);
    let end = line.find(|c: char| !matches!(c, '0'..='9' | '-' | ':' | '.' | 'T' | 'Z'))?;
    let time = &line[..end];
    let shape = time.as_bytes();
    (time.len() >= 20 && shape[4] == b'-' && shape[10] == b'T' && time.ends_with('Z'))
        .then_some(time)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;
