//! Ears and voice behind the Wyoming protocol: the server classes of its own package, and a server that is slow.

use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use messages::{PresentationState, Presented, topics};
use service::client::Client;
use speech_engines::audio::{read_wav, write_wav};
use whichone_tests::{Group, wait_for};
use wyoming::stand_in::{Manner, StandIn};

use crate::speech::{answer_by_voice, spoken};

/// The peer, with the sounds that it knows.
struct Peer {
    folder: tempfile::TempDir,
    port: u16,
    process: Option<Child>,
}

impl Peer {
    fn start() -> Self {
        let free = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = free.local_addr().unwrap().port();
        let mut peer = Self { folder: tempfile::tempdir().unwrap(), port, process: None };
        drop(free);
        peer.start_again();
        peer
    }

    fn start_again(&mut self) {
        let python = std::env::var("WHICHONE_WYOMING").unwrap_or_else(|_| "python3".to_owned());
        let server = Path::new(env!("CARGO_MANIFEST_DIR")).join("wyoming/server.py");
        let mut command = Command::new(python);
        command.arg(server).arg(self.port.to_string()).arg(self.folder.path());
        self.process = Some(command.spawn().unwrap());
        let address = ("127.0.0.1", self.port);
        wait_for("the server's port", 20.0, || TcpStream::connect(address).ok());
    }

    fn end(&mut self) {
        let Some(mut process) = self.process.take() else { return };
        process.kill().unwrap();
        process.wait().unwrap();
    }

    /// Returns a recording of `sound`, which the server takes for `words`.
    fn knows(&self, sound: &str, words: &str) -> String {
        let said = spoken(sound, self.folder.path());
        let samples = read_wav(Path::new(&said), 20.0).unwrap();
        // At the service's rate, so that the same samples arrive at the server.
        write_wav(Path::new(&said), &[vec![0; 8_000], samples, vec![0; 8_000]].concat()).unwrap();
        std::fs::write(PathBuf::from(&said).with_extension("txt"), words).unwrap();
        said
    }

    fn log(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("log")).unwrap_or_default()
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        self.end();
    }
}

fn settings(address: &str, answer_ms: u32) -> Vec<String> {
    vec![
        "speech.recogniser=wyoming".to_owned(),
        "speech.voice=wyoming".to_owned(),
        "speech.player=[\"none\"]".to_owned(),
        format!("speech.wyoming.recogniser={address}"),
        format!("speech.wyoming.voice={address}"),
        format!("speech.wyoming.answer_ms={answer_ms}"),
        "speech.wyoming.synthesis_ms=20000".to_owned(),
    ]
}

fn up(settings: &[String]) -> Group {
    Group::up(&settings.iter().map(String::as_str).collect::<Vec<_>>())
}

/// What the speech service says to operators.
fn says(group: &Group) -> String {
    group.service("speech")["says"].as_str().unwrap_or_default().to_owned()
}

#[test]
#[ignore = "needs espeak-ng, pocketsphinx and wyoming for Python, which scripts/test installs: WHICHONE_WYOMING"]
fn wyoming_servers_hear_and_speak_and_are_replaced_while_they_are_away() {
    let mut peer = Peer::start();
    let group = up(&settings(&format!("tcp://127.0.0.1:{}", peer.port), 20_000));
    let client = Client::join(group.paths()).unwrap();
    let presented = client.bus().reader::<Presented>(&topics::PRESENTED).unwrap();
    // The built-in recogniser knows none of these words.
    let request = peer.knows("my uncle plays the violin", "Get me the small white bowl, please.");
    let heard = group.must(&["listen", &request, "--json"]).json();
    assert_eq!(heard["note"], "get me the small white bowl please", "{heard}");
    let mut latest = 0;
    answer_by_voice(&group, |answer| {
        // An answer counts for a question that has sounded.
        latest = wait_for("the question's sound", 20.0, || {
            let said = presented.latest().unwrap()?;
            let is_new = said.prompt > latest && said.state == PresentationState::Ended;
            is_new.then_some(said.prompt)
        });
        group.must(&["listen", &peer.knows(&format!("{answer} my dear uncle"), answer)]);
    });
    let outcome = group.await_pick(None);
    assert_eq!((&outcome["outcome"], &outcome["object"]), (&"delivered".into(), &"white2".into()));
    let log = peer.log();
    assert!(log.contains("transcribe en ") && log.contains("dishwasher"), "{log}");
    assert!(log.contains("synthesize ") && log.contains("I will get the white bowl"), "{log}");
    assert_eq!(says(&group), "");

    peer.end();
    let recording = spoken("get me the clear bowl", peer.folder.path());
    let heard = group.must(&["listen", &recording, "--json"]).json();
    assert!(heard["note"].as_str().unwrap().contains("clear bowl"), "{heard}");
    let status = says(&group);
    assert!(status.contains("built-in recogniser in place of tcp://127.0.0.1:"), "{status}");
    assert_eq!(group.await_pick(Some("clear"))["object"], "clear");
    // The answer to this is no line that was foreseen, and so cached.
    group.say("get me the red bowl");
    wait_for("the voice in the server's place", 20.0, || {
        says(&group).contains("built-in voice in place of").then_some(())
    });

    peer.start_again();
    wait_for("the server's return", 30.0, || {
        (!says(&group).contains("built-in recogniser")).then_some(())
    });
    drop(presented);
    drop(client);
    group.verify_journals();
    group.down();
}

/// A server has 20 s for its words here: far more than a stop may take.
#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn stop_does_not_wait_for_a_wyoming_server() {
    let folder = tempfile::tempdir().unwrap();
    let server = StandIn::start(Manner::Bytes(Vec::new()));
    let mut settings = settings(&server.address.to_string(), 20_000);
    settings[1] = "speech.voice=print".to_owned();
    let group = up(&settings);
    let request = spoken("get me the small white bowl", folder.path());
    let stop = spoken("stop", folder.path());
    std::thread::scope(|scope| {
        let first = scope.spawn(|| group.must(&["listen", &request, "--live", "--json"]).stdout);
        wait_for("a request to the server", 20.0, || server.requests().first().cloned());
        let began = Instant::now();
        group.must(&["listen", &stop, "--live"]);
        wait_for("a stopped arm", 20.0, || (group.arm()["stopped"] == true).then_some(()));
        assert!(began.elapsed() < Duration::from_secs(15), "{:?}", began.elapsed());
        let first = first.join().unwrap();
        assert!(first.contains("small white bowl"), "by the built-in recogniser: {first}");
    });
    group.down();
}
