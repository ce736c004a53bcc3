//! The simulated user: says what it wants and answers until it has it, through every fault.

use serde_json::Value;
use std::io::Read;
use std::process::{Child, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use whichone_tests::Group;

/// Longest dialogue, faults included.
const PATIENCE: Duration = Duration::from_secs(240);

/// The process through which the person speaks; chaos kills it.
#[derive(Debug, Default)]
pub(crate) struct Client(Mutex<Option<Child>>);

impl Client {
    /// Kills the process, if there is one.
    pub(crate) fn kill(&self) {
        if let Some(child) = self.0.lock().expect("no panic under this lock").as_mut() {
            // It may have ended by itself.
            let _ = child.kill();
        }
    }

    /// Runs `whichone WORDS…` to its end. Returns its exit code, none if it was killed, and its output.
    fn run(&self, group: &Group, words: &[&str]) -> (Option<i32>, String) {
        let mut command = group.command(words);
        let spawned = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = spawned.spawn().expect("whichone starts");
        let mut stdout = child.stdout.take().expect("piped");
        *self.0.lock().expect("no panic under this lock") = Some(child);
        let mut text = String::new();
        // What is no text is no answer.
        let _ = stdout.read_to_string(&mut text);
        let child = self.0.lock().expect("no panic under this lock").take();
        let code = child.and_then(|mut child| child.wait().ok()?.code());
        (code, text)
    }
}

/// Has `bowl` fetched and returns the outcome.
///
/// # Panics
/// The dialogue does not end in time.
pub(crate) fn fetch(group: &Group, bowl: &str, client: &Client) -> Value {
    let until = Instant::now() + PATIENCE;
    let in_time = |what: &str| {
        assert!(Instant::now() < until, "{what}: no end\n{}\n{}", state(group), group.logs());
        std::thread::sleep(Duration::from_millis(20));
    };
    while client.run(group, &["say", "get me the bowl"]).0 != Some(0) {
        in_time("saying the request");
    }
    loop {
        let words = ["await", "pick", "--json", "--timeout", "20", "--answer-as", bowl];
        let (_, text) = client.run(group, &words);
        match serde_json::from_str::<Value>(&text) {
            // A failure has none: the group is down for a moment.
            Ok(ended) if ended["outcome"].is_string() && ended["outcome"] != "timeout" => {
                return ended;
            }
            _ => in_time("waiting for the pick"),
        }
    }
}

fn state(group: &Group) -> String {
    let watch = group.call(&["watch", "--once", "--json"]);
    format!("{}\n{}\n{watch:?}", group.call(&["status"]).stdout, bus(group))
}

fn bus(group: &Group) -> String {
    format!("processes: {:?}", group.processes())
}
