//! A gateway for one test, and its people.

use crate::command::{Ended, program, run};
use crate::console::Console;
use crate::wait_for;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};

/// A gateway that runs.
#[derive(Debug)]
pub struct Gateway {
    folder: tempfile::TempDir,
    process: Child,
    /// Host and port.
    pub place: String,
}

impl Gateway {
    /// Starts a gateway with these arguments; groups lie in `home`.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start(home: &Path, arguments: &[&str]) -> Self {
        Self::start_in(home, arguments, |_| {})
    }

    /// As [`Self::start`]; `prepare` gets the path of its folder before.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start_in(home: &Path, arguments: &[&str], prepare: impl FnOnce(&Path)) -> Self {
        let folder = tempfile::Builder::new().prefix("wo").tempdir().expect("a temporary folder");
        prepare(&folder.path().join("gw"));
        let mut command = Command::new(program("whichone-gateway"));
        command.arg("serve").arg(folder.path().join("gw")).args(arguments);
        command.args(["--listen", "127.0.0.1:0"]).env("WHICHONE_HOME", home);
        let mut process = command.stdout(Stdio::piped()).spawn().expect("whichone-gateway starts");
        let mut line = String::new();
        let output = process.stdout.take().expect("piped");
        BufReader::new(output).read_line(&mut line).expect("its address");
        let place = line.trim().strip_prefix("http://").map(|place| place.trim_end_matches('/'));
        let place = place.unwrap_or_else(|| panic!("no address: {line:?}")).to_owned();
        Self { folder, process, place }
    }

    /// Its folder.
    pub fn folder(&self) -> PathBuf {
        self.folder.path().join("gw")
    }

    /// `whichone gateway VERB FOLDER …`.
    pub fn call(&self, verb: &str, arguments: &[&str]) -> Ended {
        let mut command = Command::new(program("whichone"));
        run(command.args(["gateway", verb]).arg(self.folder()).args(arguments), "", 20.0)
    }

    /// Adds a person; returns the secret.
    ///
    /// # Panics
    /// If that fails.
    pub fn add(&self, person: &str, rights: &[&str]) -> String {
        let ended = self.call("add", &[&[person], rights].concat());
        assert_eq!(ended.code, Some(0), "{ended:?}");
        let (_, secret) = ended.stdout.trim().rsplit_once('=').expect("a link with the secret");
        secret.to_owned()
    }

    /// A robot's console as a person with this secret sees it.
    pub fn console(&self, robot: &str, secret: &str) -> Console {
        let place = match robot {
            "" => self.place.clone(),
            robot => format!("{}/{robot}", self.place),
        };
        Console { place, token: Some(secret.to_owned()) }
    }

    /// The audit's entries.
    pub fn audit(&self) -> Vec<Value> {
        let text = std::fs::read_to_string(self.folder().join("audit.jsonl")).unwrap_or_default();
        text.lines().map(|line| serde_json::from_str(line).expect("an entry")).collect()
    }

    /// Waits for an entry in the audit.
    pub fn wait_for_entry(&self, person: &str, what: &str, outcome: &str) -> Value {
        wait_for("an entry in the audit", 10.0, || {
            let found = |entry: &Value| {
                entry["person"] == person && entry["what"] == what && entry["outcome"] == outcome
            };
            self.audit().into_iter().find(found)
        })
    }

    /// Ends it as an administrator would.
    ///
    /// # Panics
    /// If it does not end.
    pub fn end(mut self) -> ExitStatus {
        kill_process(Pid::from_child(&self.process), Signal::TERM).expect("a child of ours");
        wait_for("the gateway's end", 20.0, || self.process.try_wait().expect("a child of ours"))
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        // Where a test has failed before its end.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
