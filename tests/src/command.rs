//! Execution of the built programs with a timeout.

use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use service::launch::host_of;

/// A command that has ended.
#[derive(Debug)]
pub struct Ended {
    /// Its exit code; `None` if a signal ended it.
    pub code: Option<i32>,
    /// Its standard output.
    pub stdout: String,
    /// Its standard error.
    pub stderr: String,
}

impl Ended {
    /// Parses its output as one JSON value.
    ///
    /// # Panics
    /// If it is not valid JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e}: {self:?}"))
    }
}

/// Returns the path of a program of the group in this build; `whichone` may run in its place.
///
/// # Panics
/// If it is not built: `cargo build --workspace` does that, and `scripts/test` does it first.
pub fn program(name: &str) -> PathBuf {
    find_program(name).unwrap_or_else(|| panic!("{name} is not built: cargo build --workspace"))
}

/// As [`program`]; none if it is not built.
pub(crate) fn find_program(name: &str) -> Option<PathBuf> {
    let test = std::env::current_exe().expect("the test's own path");
    let mut paths = test.ancestors().map(|folder| folder.join(name));
    paths.find(|path| path.is_file() || host_of(path).is_some())
}

/// Returns `command`, run by a shell that does `first` before: a limit or a mask of that process alone.
pub fn after(first: &str, command: &Command) -> Command {
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(format!("{first}; exec \"$0\" \"$@\""));
    shell.arg(command.get_program()).args(command.get_args());
    shell.envs(command.get_envs().filter_map(|(key, value)| Some((key, value?))));
    shell
}

/// Runs `command` to its end, giving it `input`.
///
/// # Panics
/// When it takes longer than `seconds`; it is killed then.
pub fn run(command: &mut Command, input: &str, seconds: f64) -> Ended {
    let started = Instant::now();
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let mut stdin = child.stdin.take().expect("piped");
    let input = input.to_owned();
    // A program that reads nothing may end before it is given everything.
    let writer = std::thread::spawn(move || drop(stdin.write_all(input.as_bytes())));
    let stdout = drain(child.stdout.take().expect("piped"));
    let stderr = drain(child.stderr.take().expect("piped"));
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child of ours") {
            break status;
        }
        if started.elapsed() > Duration::from_secs_f64(seconds) {
            child.kill().expect("a child of ours");
            let _ = child.wait();
            let (out, err) = (stdout.join(), stderr.join());
            panic!("{command:?}: still running after {seconds} s\n{out:?}\n{err:?}");
        }
        std::thread::sleep(Duration::from_millis(3));
    };
    writer.join().expect("the writer ends with its pipe");
    let text = |reader: std::thread::JoinHandle<String>| reader.join().expect("a reader of ours");
    Ended { code: status.code(), stdout: text(stdout), stderr: text(stderr) }
}

fn drain(mut pipe: impl Read + Send + 'static) -> std::thread::JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let _ = pipe.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
