//! A ROS 2 program of another implementation: rclpy, or Cyclone DDS with the layout of ROS 2.

use crate::{Group, program, wait_for};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicU16, Ordering};

/// A DDS domain for each test. Ports above 32767 may be those of other sockets, so there are 100.
static DOMAIN: AtomicU16 = AtomicU16::new(0);

/// An implementation of ROS 2.
#[derive(Clone, Copy, Debug)]
pub struct Implementation {
    /// Variable that names its Python interpreter.
    python: &'static str,
    script: &'static str,
    /// Mapping of its services.
    services: &'static str,
}

/// Cyclone DDS, whose `rmw` is `rmw_cyclonedds_cpp`.
pub const CYCLONE: Implementation = Implementation {
    python: "WHICHONE_CYCLONE",
    script: concat!(env!("CARGO_MANIFEST_DIR"), "/ros2/cyclone.py"),
    services: "cyclone",
};

/// rclpy with `rmw_fastrtps_cpp`.
pub const RCLPY: Implementation = Implementation {
    python: "WHICHONE_RCLPY",
    script: concat!(env!("CARGO_MANIFEST_DIR"), "/ros2/rclpy_peer.py"),
    services: "enhanced",
};

/// A program with subscriptions to everything that the node publishes.
#[derive(Debug)]
pub struct Ros2Peer {
    process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    implementation: Implementation,
    domain: u16,
}

impl Drop for Ros2Peer {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A domain that no other test of this process has.
pub fn own_domain() -> u16 {
    (std::process::id() as u16 % 50 * 2 + DOMAIN.fetch_add(1, Ordering::Relaxed)) % 100
}

impl Implementation {
    /// Starts a program and a group in a domain of their own, and waits until they have found each
    /// other.
    pub fn start(self, settings: &[&str]) -> (Ros2Peer, Group) {
        let mut peer = self.start_alone();
        let own = peer.settings();
        let own = own.iter().map(String::as_str);
        let group = Group::up(&own.chain(settings.iter().copied()).collect::<Vec<_>>());
        peer.wait_until_found(&group);
        (peer, group)
    }

    /// Starts a program in a domain of its own; a group finds it by [`Ros2Peer::settings`].
    pub fn start_alone(self) -> Ros2Peer {
        self.peer(own_domain())
    }

    /// Returns the path of its Python interpreter.
    pub(crate) fn interpreter(self) -> String {
        let name = self.python;
        std::env::var(name)
            .unwrap_or_else(|_| panic!("{name} is not set; help: run `scripts/ros2 test`"))
    }

    /// Starts a program in a domain.
    fn peer(self, domain: u16) -> Ros2Peer {
        let mut command = Command::new(self.interpreter());
        command
            .args([self.script, &domain.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        let mut process = command.spawn().expect("the interpreter starts");
        let to = process.stdin.take().expect("a pipe");
        let from = BufReader::new(process.stdout.take().expect("a pipe"));
        Ros2Peer { process, to, from, implementation: self, domain }
    }
}

impl Ros2Peer {
    /// Settings of a group that this program finds.
    pub fn settings(&self) -> [String; 4] {
        [
            format!("group.services.ros2.command=[\"{}\"]", program("whichone-ros2").display()),
            format!("ros2.services={}", self.implementation.services),
            format!("ros2.domain_id={}", self.domain),
            "ros2.network=loopback".to_owned(),
        ]
    }

    /// Waits until messages go both ways.
    pub fn wait_until_found(&mut self, group: &Group) {
        let is_found = |seen: &Value| {
            let joints = seen["count"]["/joint_states"].as_u64();
            seen["matched"] == true && joints.is_some_and(|count| count > 10)
        };
        let what = "the node and the peer find each other";
        wait_for(what, 30.0, || Some(self.tell("look")).filter(&is_found));
        assert_eq!(group.service("ros2")["actual"], "ready", "{}", group.logs());
    }

    /// Kills the program, which cannot take its leave, and starts another one.
    pub fn restart(&mut self) {
        self.process.kill().expect("a child of ours");
        *self = self.implementation.peer(self.domain);
    }

    /// Gives the program a command and returns its answer.
    pub fn tell(&mut self, command: &str) -> Value {
        writeln!(self.to, "{command}").expect("the peer reads");
        let mut line = String::new();
        self.from.read_line(&mut line).expect("the peer answers");
        serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}"))
    }

    /// Waits until what the program has seen fulfils a condition, and returns it.
    pub fn wait_for(&mut self, what: &str, holds: impl Fn(&Value) -> bool) -> Value {
        wait_for(what, 40.0, || Some(self.tell("look")).filter(&holds))
    }
}
