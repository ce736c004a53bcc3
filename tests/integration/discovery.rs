//! The robot in its local network, as python-zeroconf finds it from another machine.

use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use rustix::process::Signal;
use serde_json::{Value as Json, json};
use whichone_tests::Group;
use whichone_tests::console::Console;
use whichone_tests::http_program::Program;
use whichone_tests::slow_network::{Network, ip};

const ANNOUNCED: &str = "console.discovery=true";
const REACHED: &str = "console.listen=0.0.0.0:0";
/// Timeout of a wait for an event: addresses are looked at every 5 s.
const PATIENCE: Duration = Duration::from_secs(40);

/// Another implementation, in the network of the thread that started it.
struct Watcher {
    child: Child,
    events: Receiver<Json>,
}

impl Watcher {
    /// Starts one that registers robots with these names itself.
    fn start(names: &[&str]) -> Self {
        let python = std::env::var("WHICHONE_ZEROCONF").unwrap_or_else(|_| "python3".to_owned());
        let program = concat!(env!("CARGO_MANIFEST_DIR"), "/discovery/watch.py");
        let mut command = Command::new(python);
        command.arg(program).args(names).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let (sender, events) = channel();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let _ = sender.send(serde_json::from_str(&line).unwrap());
            }
        });
        Self { child, events }
    }

    /// Waits for an event.
    fn until(&self, what: &str, is: impl Fn(&Json) -> bool) -> Json {
        let mut seen = Vec::new();
        loop {
            let next = self.events.recv_timeout(PATIENCE);
            let event = next.unwrap_or_else(|_| panic!("{what}: not among {seen:#?}"));
            if is(&event) {
                return event;
            }
            seen.push(event);
        }
    }

    /// Waits for a robot with complete records.
    fn robot(&self, of: &Group) -> Json {
        let name = of.paths().name().as_str();
        self.until(name, |event| event["text"]["name"] == name)
    }

    fn removed(&self, name: &Json) {
        self.until("its end", |event| event["event"] == "removed" && event["name"] == *name);
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

#[test]
#[ignore = "needs root, TAP devices and python3 with zeroconf: WHICHONE_ZEROCONF"]
fn found_from_another_machine_through_restarts_and_new_addresses() {
    let network = Network::ethernet();
    let watch = || network.operator.run(|| Watcher::start(&[]));
    let watcher = watch();
    let group = network.robot.run(|| Group::up(&[REACHED, ANNOUNCED]));
    let name = group.paths().name().as_str();
    let found = watcher.robot(&group);
    assert_eq!(found["name"], format!("{name}._whichone._tcp.local."));
    assert_eq!(found["addresses"], json!(["10.77.0.2"]), "no address of the machine alone");

    let place = format!("10.77.0.2:{}", found["port"]);
    let console = Console { place, token: None };
    let info = network.operator.run(|| Program::at(console, "").get("/info").body);
    let expected = json!({
        "api": "1", "id": info["id"], "name": name, "version": info["version"],
        "scheme": "http", "path": "/api/v1",
    });
    assert_eq!(found["text"], expected);

    // Neither an orderly end nor a kill changes it: what others remember of it is no other robot.
    let before = group.incarnation("console");
    group.must(&["restart", "console"]);
    group.wait_for_restart("console", before);
    let before = group.incarnation("console");
    group.signal("console", Signal::KILL);
    group.wait_for_restart("console", before);
    let again = watch();
    let same = again.robot(&group);
    let of = |event: &Json| ["name", "host", "port", "text"].map(|key| event[key].clone());
    assert_eq!(of(&same), of(&found));

    network.robot.run(|| ip(&["addr", "add", "10.77.0.3/24", "dev", "wo0"]));
    let both = json!(["10.77.0.2", "10.77.0.3"]);
    again.until("the new address", |event| event["addresses"] == both);
    group.down();
    again.removed(&found["name"]);
}

#[test]
#[ignore = "needs root, TAP devices and python3 with zeroconf: WHICHONE_ZEROCONF"]
fn found_from_another_machine_beside_a_robot_of_the_same_name() {
    let network = Network::ethernet();
    let mut group = Group::new();
    let name = group.paths().name().as_str().to_owned();
    let watcher = network.operator.run(|| Watcher::start(&[&name]));
    watcher.until("the first one", |event| event["text"]["id"] == "another");
    let ended = network.robot.run(|| group.start(&[REACHED, ANNOUNCED]));
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let found = watcher.robot(&group);
    assert_eq!(found["name"], format!("{name} (2)._whichone._tcp.local."));
    group.wait_for_log("console", "another robot in the local network has this name");
    group.down();
    watcher.removed(&found["name"]);
}

/// A response that claims these names: an address for each, for the rest of time.
fn claims(names: std::ops::Range<u32>) -> Vec<u8> {
    let count = u16::try_from(names.len()).unwrap().to_be_bytes();
    let mut packet = vec![0, 0, 0x84, 0, 0, 0, count[0], count[1], 0, 0, 0, 0];
    for name in names {
        let label = format!("{name:08x}");
        packet.push(8);
        packet.extend(label.bytes());
        packet.extend(b"\x05local\0\0\x01\0\x01\x7f\xff\xff\xff\0\x04\x0a\x4d\0\x01");
    }
    packet
}

/// Whoever claims names without end fills no memory, and the robot is still found.
#[test]
#[ignore = "needs root, TAP devices and python3 with zeroconf: WHICHONE_ZEROCONF"]
fn found_from_another_machine_after_a_flood_of_claims() {
    const NAMES: u32 = 20_000;
    const OF_A_PACKET: usize = 32;
    let network = Network::ethernet();
    let group = network.robot.run(|| Group::up(&[REACHED, ANNOUNCED]));
    group.wait_for_log("console", "the robot is announced in the local network");
    network.operator.run(|| {
        let socket = UdpSocket::bind("10.77.0.1:5353").unwrap();
        for first in (0..NAMES).step_by(OF_A_PACKET) {
            socket.send_to(&claims(first..first + OF_A_PACKET as u32), "10.77.0.2:5353").unwrap();
            std::thread::sleep(Duration::from_millis(2));
        }
    });
    group.wait_for_log("console", "the responder of the local network is replaced: Full(");
    let watcher = network.operator.run(|| Watcher::start(&[]));
    let found = watcher.robot(&group);
    assert_eq!(found["addresses"], json!(["10.77.0.2"]));
    group.down();
    watcher.removed(&found["name"]);
}

#[test]
fn console_of_this_machine_alone_is_not_announced() {
    let group = Group::up(&[ANNOUNCED]);
    let log = group.wait_for_log("console", "the robot is not announced");
    assert!(log.contains("the console listens at 127.0.0.1; help: set console.listen"), "{log}");
    let warned = group.must(&["check", "--set", ANNOUNCED]).stderr;
    assert!(warned.contains("console.discovery: nothing is announced"), "{warned}");
    group.down();
}
