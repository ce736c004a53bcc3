//! Follower of the services' growing logs.

use std::path::Path;

use service::wall_time;

use crate::foxglove::{Log, Time, level};
use crate::log_tail::LogFile;

/// End of the name of a log.
const EXTENSION: &str = "log";

/// Follows every log of a folder, from its end on.
#[derive(Debug, Default)]
pub(crate) struct LogLines {
    files: Vec<LogFile>,
    has_begun: bool,
}

impl LogLines {
    /// Takes the lines completed since the last look, with their times in nanoseconds since
    /// 1970. A line without one has that of the look, `now_ns`.
    pub(crate) fn take(&mut self, folder: &Path, now_ns: u64) -> Vec<(u64, Log)> {
        self.find(folder);
        let mut taken = Vec::new();
        for file in &mut self.files {
            // A log that cannot be read is not shown.
            let lines = file.new_lines().unwrap_or_default();
            taken.extend(lines.iter().map(|line| entry(file.service(), line, now_ns)));
        }
        taken
    }

    fn find(&mut self, folder: &Path) {
        for found in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = found.path();
            let name = path.file_stem().and_then(|name| name.to_str());
            let Some(name) = name.filter(|_| path.extension().is_some_and(|it| it == EXTENSION))
            else {
                continue;
            };
            if self.files.iter().any(|known| known.path() == path) {
                continue;
            }
            let mut file = LogFile::new(name, path.clone());
            if !self.has_begun {
                // Lines written before belong to no recording.
                let _ = file.last_lines(0);
            }
            self.files.push(file);
        }
        self.has_begun = true;
    }
}

/// A line as `service::logging` writes it: time, level, module and text, or one object of JSON.
fn entry(service: &str, line: &str, now_ns: u64) -> (u64, Log) {
    let json: Option<serde_json::Value> =
        line.starts_with('{').then(|| serde_json::from_str(line).ok()).flatten();
    let (stamp, level, file, message) = match &json {
        Some(json) => {
            let text = |key: &str| json[key].as_str().unwrap_or_default();
            (text("timestamp"), text("level"), text("target"), json["fields"].to_string())
        }
        None => {
            let (stamp, rest) = line.split_once(' ').unwrap_or_default();
            let (level, rest) = rest.trim_start().split_once(' ').unwrap_or_default();
            let (file, message) = rest.split_once(": ").unwrap_or(("", rest));
            (stamp, level, file, message.to_owned())
        }
    };
    let stamped = wall_time::parse(stamp);
    let (level, message) = match (stamped, number(level)) {
        (Some(_), Some(level)) => (level, message),
        // A panic, or the output of a library.
        _ => (level::UNKNOWN, line.to_owned()),
    };
    let at_ns = stamped.unwrap_or(now_ns);
    let is_unknown = level == level::UNKNOWN;
    let file = if is_unknown { String::new() } else { file.to_owned() };
    let timestamp = Time::at(at_ns);
    (at_ns, Log { timestamp, level, message, name: service.to_owned(), file, line: 0 })
}

fn number(name: &str) -> Option<u8> {
    Some(match name {
        "TRACE" | "DEBUG" => level::DEBUG,
        "INFO" => level::INFO,
        "WARN" => level::WARNING,
        "ERROR" => level::ERROR,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::OpenOptions;
    use std::io::Write;

    #[test]
    fn lines_of_logs_become_entries_with_time_and_level() {
        let line = "2025-11-25T10:08:19.250000Z  WARN policy::shell: a topic fails n=3";
        let (at_ns, log) = entry("policy", line, 7);
        assert_eq!(at_ns, 1_764_065_299_250_000_000);
        assert_eq!((log.level, log.name.as_str()), (level::WARNING, "policy"));
        assert_eq!(
            (log.file.as_str(), log.message.as_str()),
            ("policy::shell", "a topic fails n=3")
        );
        let (at_ns, log) = entry("arm", "thread 'main' panicked at src/main.rs:7:", 7);
        assert_eq!((at_ns, log.level, log.file.as_str()), (7, level::UNKNOWN, ""));
        assert!(log.message.starts_with("thread 'main' panicked"));
        let json = r#"{"timestamp":"2025-11-25T10:08:19.250000Z","level":"INFO","fields":{"message":"ready"},"target":"x"}"#;
        let (_, log) = entry("arm", json, 7);
        assert_eq!((log.level, log.message.as_str()), (level::INFO, r#"{"message":"ready"}"#));
    }

    #[test]
    fn logs_are_followed_from_their_end_and_new_ones_from_their_beginning() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            let mut file = OpenOptions::new().append(true).create(true).open(path).unwrap();
            file.write_all(text.as_bytes()).unwrap();
        };
        write("arm.log", "before\n");
        write("arm.log.1", "old\n");
        let mut lines = LogLines::default();
        assert_eq!(lines.take(folder.path(), 1), []);
        write("arm.log", "one\ntw");
        write("policy.log", "begins\n");
        let mut taken: Vec<_> =
            lines.take(folder.path(), 2).into_iter().map(|(_, log)| log.message).collect();
        taken.sort();
        assert_eq!(taken, ["begins", "one"]);
        write("arm.log", "o\n");
        let taken = lines.take(folder.path(), 3);
        assert_eq!(taken.iter().map(|(_, log)| log.message.as_str()).collect::<Vec<_>>(), ["two"]);
    }
}
