//! A link for one test: keys, a router, and robots that are mirrored on the same machine.

use crate::command::{Ended, find_program, program, run};
use crate::{Group, wait_for};
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Keys and their router, which ends with it.
#[derive(Debug)]
pub struct Relay {
    folder: tempfile::TempDir,
    router: Option<Child>,
}

/// A robot's group elsewhere as a group of this machine.
#[derive(Debug)]
pub struct Mirror {
    /// The local group.
    pub group: Group,
    process: Child,
}

impl Relay {
    /// Makes keys as `init` does with these arguments, and starts the router.
    pub fn start(arguments: &[&str]) -> Self {
        Self::at("localhost", arguments)
    }

    /// As [`Relay::start`], of a router that is reached under this name or address.
    pub fn at(host: &str, arguments: &[&str]) -> Self {
        let folder = tempfile::Builder::new().prefix("wo").tempdir().expect("a temporary folder");
        // Free a moment ago; the router takes the port at once.
        let probe = UdpSocket::bind("[::]:0").expect("a free port");
        let port = probe.local_addr().expect("an address").port();
        drop(probe);
        let mut relay = Self { folder, router: None };
        let router = format!("{host}:{port}");
        relay.init(&[&["--router", &router], arguments].concat());
        relay.start_router();
        relay
    }

    /// `whichone link init` for these keys.
    pub fn init(&self, arguments: &[&str]) {
        let mut command = Command::new(program("whichone"));
        command.args(["link", "init"]).arg(self.keys()).args(arguments);
        let ended = run(&mut command, "", 20.0);
        assert_eq!(ended.code, Some(0), "{arguments:?}: {ended:?}");
    }

    /// The folder of all keys.
    pub fn keys(&self) -> PathBuf {
        self.folder.path().join("keys")
    }

    /// The folder of a robot's keys.
    pub fn robot(&self, name: &str) -> PathBuf {
        self.keys().join("robots").join(name)
    }

    /// The folder of a person's keys.
    pub fn person(&self, name: &str) -> PathBuf {
        self.keys().join("people").join(name)
    }

    /// Kills the router.
    pub fn kill_router(&mut self) {
        if let Some(mut router) = self.router.take() {
            router.kill().expect("a child of ours");
            router.wait().expect("a child of ours");
        }
    }

    /// Starts the router.
    pub fn start_router(&mut self) {
        let mut command = Command::new(program("whichone-link"));
        command.arg("router").arg(self.keys().join("router")).stdin(Stdio::null());
        self.router = Some(command.spawn().expect("whichone-link was built by scripts/link"));
    }

    /// Settings of a group that is the robot with this name.
    pub fn settings(&self, robot: &str) -> [String; 2] {
        let keys = self.robot(robot).display().to_string();
        ["group.services.link.observer=true".to_owned(), format!("link.keys={keys}")]
    }

    /// Starts a group that is the robot with this name.
    pub fn robot_up(&self, robot: &str, settings: &[&str]) -> Group {
        let own = self.settings(robot);
        Group::up(
            &own.iter().map(String::as_str).chain(settings.iter().copied()).collect::<Vec<_>>(),
        )
    }

    /// `whichone fleet` with these keys.
    pub fn fleet(&self, keys: &Path) -> Ended {
        let mut command = Command::new(program("whichone"));
        run(command.args(["fleet", "--json", "--keys"]).arg(keys), "", 20.0)
    }
}

/// Returns whether `scripts/link` has built the link's programs.
pub fn is_built() -> bool {
    find_program("whichone-link").is_some_and(|path| path.is_file())
}

/// A peer with these keys that sends nonsense to a robot or in its name, for some seconds
/// (`services/link/examples/fuzzed_peer.rs`).
pub fn fuzzed_peer(keys: &Path, robot: &str, seed: u64, seconds: f64) -> Ended {
    let mut command = Command::new(program("examples/fuzzed_peer"));
    command.arg(keys).args([robot, &seed.to_string(), &seconds.to_string()]);
    run(&mut command, "", seconds + 30.0)
}

impl Drop for Relay {
    fn drop(&mut self) {
        self.kill_router();
    }
}

impl Mirror {
    /// Mirrors the robot until its group is ready here.
    pub fn start(robot: &str, keys: &Path) -> Self {
        let mirror = Self::launch(robot, keys);
        mirror.wait_ready(30.0);
        mirror
    }

    /// As [`Mirror::start`], with a console on a free port.
    pub fn start_with_console(robot: &str, keys: &Path) -> Self {
        let mirror = Self::launch_with(&["--listen", "127.0.0.1:0"], robot, keys);
        mirror.wait_ready(30.0);
        mirror
    }

    /// Begins to mirror the robot.
    pub fn launch(robot: &str, keys: &Path) -> Self {
        Self::launch_with(&["--no-console"], robot, keys)
    }

    fn launch_with(console: &[&str], robot: &str, keys: &Path) -> Self {
        let group = Group::new();
        let mut command = group.command(&["link", "--mirror", robot]);
        command.args(console).arg("--keys").arg(keys);
        let process = command.spawn().expect("whichone starts");
        Self { group, process }
    }

    /// Waits until the robot's group is ready here; returns how long that took, seconds.
    pub fn wait_ready(&self, seconds: f64) -> f64 {
        let began = std::time::Instant::now();
        wait_for("a mirrored group that is ready", seconds, || {
            let ended = self.group.call(&["status", "--json"]);
            (ended.code == Some(0) && ended.json()["state"] == "ready").then_some(())
        });
        began.elapsed().as_secs_f64()
    }

    /// Returns whether it has not ended.
    pub fn runs(&mut self) -> bool {
        self.process.try_wait().expect("a child of ours").is_none()
    }

    /// Ends it as an operator would, and checks that nothing is left.
    pub fn down(mut self) {
        self.group.must(&["down"]);
        wait_for("the mirror's end", 10.0, || self.process.try_wait().expect("a child of ours"));
        assert!(!self.group.paths().run().exists(), "run/ is left");
        let left = service::shm_cleanup::leftovers(self.group.paths());
        assert!(left.is_empty(), "shared memory is left: {left:?}");
    }
}

impl Drop for Mirror {
    fn drop(&mut self) {
        // Its group's shared memory goes with it.
        let _ = self.group.command(&["down"]).output();
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
