//! The ways to give a stop, and what they need.

use crate::documents::is_installed;
use crate::speech::spoken;
use messages::MotionOrder;
use serde_json::{Value as Json, json};
use service::stop_socket;
use service::{Span, Time, clock};
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use whichone_tests::console::{Console, Page, Visitor};
use whichone_tests::gateway::Gateway;
use whichone_tests::link::{Mirror, Relay, is_built};
use whichone_tests::ros2::{CYCLONE, Ros2Peer};
use whichone_tests::{EARS, Ended, Group, run};

/// Time for a way that repeats its order.
const PATIENCE: Duration = Duration::from_secs(60);
/// The secret of the participant's page.
const PARTICIPANT: &str = "00112233445566778899aabbccddeeff";
/// The robot's name for its mirrors.
const ROBOT: &str = "r1";
const STUDY: [&str; 2] = ["study.enabled=true", "study.consent=I agree."];

/// A way to give a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    CommandLine,
    Words,
    /// A recording of the word.
    Spoken,
    Chat,
    Page,
    /// The page of a participant.
    Study,
    /// A page behind the gateway.
    Gateway,
    /// What the clients in Rust and C call.
    Socket,
    Python,
    Ros2,
    /// The command line at a mirror of the robot.
    Mirror,
    /// The page at that mirror.
    MirrorPage,
}

const WAYS: [Way; 12] = [
    Way::CommandLine,
    Way::Words,
    Way::Chat,
    Way::Page,
    Way::Socket,
    Way::Python,
    Way::Spoken,
    Way::Study,
    Way::Gateway,
    Way::Ros2,
    Way::Mirror,
    Way::MirrorPage,
];

/// What a way reported of its order.
#[derive(Clone, Debug)]
pub(super) struct Report {
    /// The order was accepted: it must be carried out.
    pub(super) is_accepted: bool,
    /// When the way reported that the arm is stopped.
    pub(super) stopped: Option<Time>,
    pub(super) text: String,
}

impl Way {
    /// The ways for which this machine has what they need.
    pub(super) fn all_here() -> Vec<Self> {
        let (here, missing): (Vec<_>, Vec<_>) = WAYS.into_iter().partition(|way| way.is_here());
        if !missing.is_empty() {
            println!("not tried, as this machine lacks what they need: {missing:?}");
        }
        here
    }

    fn is_here(self) -> bool {
        match self {
            Self::Spoken => is_installed("espeak-ng") && has_recogniser(),
            Self::Python => std::env::var_os("WHICHONE_PYTHON").is_some(),
            Self::Ros2 => std::env::var_os("WHICHONE_CYCLONE").is_some(),
            Self::Mirror | Self::MirrorPage => is_built(),
            _ => true,
        }
    }

    /// Returns whether the robot itself says that it has stopped.
    pub(super) fn is_words(self) -> bool {
        matches!(self, Self::Words | Self::Spoken | Self::Chat)
    }
}

fn has_recogniser() -> bool {
    let listed = Command::new("ldconfig").arg("-p").output();
    listed.is_ok_and(|it| String::from_utf8_lossy(&it.stdout).contains("libpocketsphinx.so.3"))
}

/// Those who give stops in a group. A program of ROS 2 and the link's router are there before the group.
pub(super) struct Givers {
    settings: Vec<String>,
    ros2: Option<Mutex<Ros2Peer>>,
    gateway: Option<(Gateway, Console)>,
    mirror: Option<Mirror>,
    relay: Option<Relay>,
    /// The recording of the word, and its folder.
    recording: Option<(tempfile::TempDir, String)>,
}

impl Givers {
    /// Begins with these ways, for a group with these settings.
    pub(super) fn of(ways: &[Way], settings: &[&str]) -> Self {
        let ros2 = ways.contains(&Way::Ros2).then(|| CYCLONE.start_alone());
        let mut settings: Vec<String> = settings.iter().map(|it| (*it).to_owned()).collect();
        settings.extend(ros2.iter().flat_map(Ros2Peer::settings));
        let is_mirrored = ways.contains(&Way::Mirror) || ways.contains(&Way::MirrorPage);
        let relay = is_mirrored.then(|| Relay::start(&["--robot", ROBOT, "--operator", "ann"]));
        settings.extend(relay.iter().flat_map(|relay| relay.settings(ROBOT)));
        if ways.contains(&Way::Study) {
            settings.extend(STUDY.map(str::to_owned));
        }
        let recording = ways.contains(&Way::Spoken).then(|| {
            let folder = tempfile::tempdir().unwrap();
            let path = spoken("stop", folder.path());
            (folder, path)
        });
        settings.extend(recording.iter().map(|_| EARS.to_owned()));
        let ros2 = ros2.map(Mutex::new);
        Self { settings, ros2, gateway: None, mirror: None, relay, recording }
    }

    pub(super) fn settings(&self) -> Vec<&str> {
        self.settings.iter().map(String::as_str).collect()
    }

    /// Goes on with the group that was started.
    pub(super) fn join(&mut self, ways: &[Way], group: &Group) {
        if let Some(peer) = &mut self.ros2 {
            peer.get_mut().unwrap().wait_until_found(group);
        }
        if ways.contains(&Way::Gateway) {
            let robot = group.paths().name().as_str();
            let gateway = Gateway::start(group.paths().home(), &["--group", robot]);
            let secret = gateway.add("ann", &["--operator", robot]);
            let console = gateway.console(robot, &secret);
            self.gateway = Some((gateway, console));
        }
        if let Some(relay) = &self.relay {
            self.mirror = Some(Mirror::start_with_console(ROBOT, &relay.person("ann")));
        }
        if ways.contains(&Way::Study) {
            let mut page = group.page(&participant());
            for verb in ["study.begin", "study.consent"] {
                let done = page.ask(verb, &json!({ "page": PARTICIPANT }));
                assert_eq!(done["ok"], true, "{verb}: {done}");
            }
        }
    }

    pub(super) fn give(&self, way: Way, group: &Group) -> Report {
        match way {
            Way::CommandLine => confirmed(&group.call(&["stop-motion"])),
            Way::Words => said(&group.call(&["say", "stop"])),
            Way::Spoken => {
                let (_, recording) = self.recording.as_ref().expect("a recording");
                accepted(&group.call(&["listen", recording]))
            }
            Way::Chat => by_chat(group),
            Way::Page => by_page(|| Some(group.page(&Visitor::operator(1)))),
            Way::Study => by_page(|| Some(group.page(&participant()))),
            Way::Gateway => {
                let (_, console) = self.gateway.as_ref().expect("a gateway");
                by_page(|| Page::open(console, &Visitor::operator(3)).ok())
            }
            Way::Socket => by_socket(group),
            Way::Python => by_python(group),
            Way::Ros2 => by_ros2(&mut self.ros2.as_ref().expect("a peer").lock().unwrap()),
            Way::Mirror => confirmed(&self.mirrored().call(&["stop-motion"])),
            Way::MirrorPage => by_page(|| Some(self.mirrored().page(&Visitor::operator(4)))),
        }
    }

    fn mirrored(&self) -> &Group {
        &self.mirror.as_ref().expect("a mirror").group
    }
}

fn participant() -> Visitor<'static> {
    Visitor::operator(2)
}

fn accepted(ended: &Ended) -> Report {
    let text = format!("{}{}", ended.stdout, ended.stderr);
    Report { is_accepted: ended.code == Some(0), stopped: None, text }
}

/// Words that were typed: the arm's confirmation, or else their receipt, counts.
fn said(ended: &Ended) -> Report {
    let report = accepted(ended);
    let is_stopped = report.text.contains("the arm is stopped, at rest");
    let is_accepted = is_stopped || report.text.contains("heard as utterance");
    Report { is_accepted, stopped: is_stopped.then(clock::now), ..report }
}

fn confirmed(ended: &Ended) -> Report {
    let report = accepted(ended);
    Report { stopped: report.is_accepted.then(clock::now), ..report }
}

/// A user at a terminal, who types "stop" and waits for the robot's report.
fn by_chat(group: &Group) -> Report {
    let mut command = group.command(&["chat"]);
    let mut chat = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut keys = chat.stdin.take().unwrap();
    keys.write_all(b"stop\n").unwrap();
    let mut lines = BufReader::new(chat.stdout.take().unwrap()).lines().map_while(Result::ok);
    let line = lines.find(|line| line.contains("I have stopped"));
    let stopped = line.is_some().then(clock::now);
    keys.write_all(b"quit\n").unwrap();
    let text = format!("{line:?}, {:?}", chat.wait());
    Report { is_accepted: stopped.is_some(), stopped, text }
}

/// A page repeats a stop over every connection until it is confirmed, as its scripts do.
fn by_page(open: impl Fn() -> Option<Page>) -> Report {
    let until = Instant::now() + PATIENCE;
    loop {
        assert!(Instant::now() < until, "no confirmation on the page");
        let Some(mut page) = open() else { continue };
        let id = page.begin("stop", &Json::Null);
        while page.closed.is_none() && Instant::now() < until {
            page.look();
            let answer = page.messages.iter().find(|message| message["id"] == id).cloned();
            let is_confirmed = |answer: &Json| answer["ok"] == true;
            if let Some(answer) = answer.filter(is_confirmed) {
                let text = answer.to_string();
                return Report { is_accepted: true, stopped: Some(clock::now()), text };
            }
            // A stop that is late stays with the console, which shows when it is confirmed.
            let arm = page.parts.get("arm").filter(|arm| arm["stopped"] == true);
            let motion = page.parts.get("motion").filter(|motion| motion["unconfirmed"].is_null());
            if let Some((arm, _)) = arm.zip(motion) {
                return Report { is_accepted: true, stopped: None, text: arm.to_string() };
            }
        }
    }
}

fn by_socket(group: &Group) -> Report {
    let patience = Span::from_s(PATIENCE.as_secs_f64());
    let stopped = stop_socket::give(group.paths(), MotionOrder::Stop, patience, &mut |_| true);
    let (is_accepted, text) = (stopped.is_ok(), format!("{stopped:?}"));
    Report { is_accepted, stopped: is_accepted.then(clock::now), text }
}

fn by_python(group: &Group) -> Report {
    let python =
        std::env::var_os("WHICHONE_PYTHON").expect("a Python with the package's dependencies");
    let mut command = Command::new(python);
    command.args(["-c", "import sys, whichone\nwhichone.Client(sys.argv[1]).stop()"]);
    command.arg(group.paths().name().as_str()).env("WHICHONE_HOME", group.paths().home());
    command.env("PYTHONPATH", concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/sdk/python"));
    confirmed(&run(&mut command, "", 60.0))
}

/// A program of ROS 2 calls until the node answers; what is not confirmed yet, the node repeats.
fn by_ros2(peer: &mut Ros2Peer) -> Report {
    let until = Instant::now() + PATIENCE;
    loop {
        let answer = peer.tell("call stop");
        let text = answer.to_string();
        match answer["success"].as_bool() {
            Some(true) => {
                return Report { is_accepted: true, stopped: Some(clock::now()), text };
            }
            Some(false) if text.contains("not confirmed yet") => {
                return Report { is_accepted: true, stopped: None, text };
            }
            _ => assert!(Instant::now() < until, "no answer of the node: {text}"),
        }
    }
}
