//! Processes as `/proc` lists them.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

use rustix::param::page_size;
use rustix::process::Pid;

/// Clock ticks per second in `/proc`. Fixed by the kernel's interface at 100 on every architecture
/// that Rust's standard library is shipped for.
const TICKS_PER_S: f64 = 100.0;

/// Longest `stat` line: some fifty numbers of up to twenty digits, and a name.
const STAT_BYTES_MAX: usize = 2048;

/// One process, from its `stat` line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Process {
    pub(crate) pid: Pid,
    /// Name of the program, at most 15 bytes.
    pub(crate) name: String,
    /// True if it has ended and waits to be reaped.
    pub(crate) is_zombie: bool,
    /// Its parent's number.
    pub(crate) parent: i32,
    /// Its process group's number.
    pub(crate) group: i32,
    /// Processor time used, seconds.
    pub(crate) cpu_s: f64,
    /// Resident memory, KiB.
    pub(crate) rss_kib: u64,
}

/// All processes that exist. One that comes or goes meanwhile may or may not be among them.
pub(crate) fn processes() -> Vec<Process> {
    let Ok(entries) = fs::read_dir("/proc") else { return Vec::new() };
    entries
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok())
        .filter_map(|number| process(Pid::from_raw(number)?))
        .collect()
}

/// This process's children, also those that it has inherited, for which all processes need not be looked through.
/// `None` where the kernel does not list them. None is missed as long as the caller is who reaps them.
pub(crate) fn children() -> Option<Vec<Pid>> {
    let mut children = Vec::new();
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let listed = fs::read_to_string(thread.ok()?.path().join("children")).ok()?;
        let numbers = listed.split_whitespace().map(|number| number.parse().ok());
        children.extend(numbers.map(|number| Pid::from_raw(number?)).collect::<Option<Vec<_>>>()?);
    }
    Some(children)
}

/// One process, if it exists.
pub(crate) fn process(pid: Pid) -> Option<Process> {
    // The kernel hands out the whole line at once; there may be many processes to ask for.
    let mut line = [0; STAT_BYTES_MAX];
    let mut file = File::open(format!("/proc/{pid}/stat")).ok()?;
    let length = file.read(&mut line).ok()?;
    parse_stat(&String::from_utf8_lossy(&line[..length]))
}

/// Numbers of the signals that this process ignores; none where the kernel does not tell.
pub(crate) fn ignored_signals() -> Vec<i32> {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    (1..=64).filter(|number| mask >> (number - 1) & 1 == 1).collect()
}

/// The environment that a process was started with; empty if it may not be read.
pub(crate) fn environment(pid: Pid) -> Environment {
    Environment(fs::read(format!("/proc/{pid}/environ")).unwrap_or_default())
}

/// Returns true if a process has the file at `path` open.
pub(crate) fn has_open(pid: Pid, path: &Path) -> bool {
    let Ok(entries) = fs::read_dir(format!("/proc/{pid}/fd")) else { return false };
    entries.flatten().any(|entry| fs::read_link(entry.path()).is_ok_and(|target| target == path))
}

/// See [`environment`].
#[derive(Clone, Debug)]
pub(crate) struct Environment(Vec<u8>);

impl Environment {
    /// The value of one variable.
    pub(crate) fn get(&self, key: &str) -> Option<&OsStr> {
        self.0.split(|&byte| byte == 0).find_map(|variable| {
            let value = variable.strip_prefix(key.as_bytes())?.strip_prefix(b"=")?;
            Some(OsStr::from_bytes(value))
        })
    }
}

/// `pid (name) state ppid pgrp … utime stime … rss …`; the name may hold spaces and parentheses.
fn parse_stat(line: &str) -> Option<Process> {
    let (pid, rest) = line.split_once(" (")?;
    let (name, rest) = rest.rsplit_once(") ")?;
    let fields: Vec<&str> = rest.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field)?.parse::<f64>().ok();
    Some(Process {
        pid: Pid::from_raw(pid.parse().ok()?)?,
        name: name.to_owned(),
        is_zombie: matches!(*fields.first()?, "Z" | "X"),
        parent: fields.get(1)?.parse().ok()?,
        group: fields.get(2)?.parse().ok()?,
        cpu_s: (ticks(11)? + ticks(12)?) / TICKS_PER_S,
        rss_kib: fields.get(21)?.parse::<u64>().ok()? * (page_size() as u64 >> 10),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn procfs_stat_line_with_special_characters_is_parsed() {
        let line = "42 (a (b) c) S 7 9 9 0 -1 4194560 1 0 0 0 150 50 0 0 20 0 1 0 100 0 3";
        let expected = Process {
            pid: Pid::from_raw(42).unwrap(),
            name: "a (b) c".into(),
            is_zombie: false,
            parent: 7,
            group: 9,
            cpu_s: 2.0,
            rss_kib: 3 * page_size() as u64 / 1024,
        };
        assert_eq!(parse_stat(line), Some(expected));
        assert_eq!(parse_stat("42 (a"), None);
    }

    #[test]
    fn this_very_process_is_found() {
        let me = rustix::process::getpid();
        let found = processes().into_iter().find(|process| process.pid == me).unwrap();
        assert_eq!(
            Some(found.parent),
            rustix::process::getppid().map(|p| p.as_raw_nonzero().get())
        );
        assert!(!found.is_zombie);
        assert!(found.rss_kib > 100);
        let file = tempfile::NamedTempFile::new().unwrap();
        let path = file.path().canonicalize().unwrap();
        assert!(has_open(me, &path));
        drop(file);
        assert!(!has_open(me, &path));
    }

    #[test]
    fn children_are_listed_until_they_are_reaped() {
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let pid = Pid::from_child(&child);
        // Threads of other tests end while they are read.
        let is_listed = || loop {
            if let Some(children) = children() {
                return children.contains(&pid);
            }
        };
        assert!(is_listed());
        child.kill().unwrap();
        while !process(pid).unwrap().is_zombie {
            std::thread::yield_now();
        }
        assert!(is_listed(), "it waits to be reaped");
        child.wait().unwrap();
        assert!(!is_listed());
    }

    #[test]
    fn environment_variables_are_matched_by_full_name() {
        let environment = Environment(b"AB=1\0A=2\0C=\0".to_vec());
        assert_eq!(environment.get("A"), Some(OsStr::new("2")));
        assert_eq!(environment.get("C"), Some(OsStr::new("")));
        assert_eq!(environment.get("B"), None);
    }
}
