//! A program that talks to a robot over HTTP. Each of its answers is checked against the description that the console
//! serves.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use dialogue::Model;
use evaluation::simulation::SimulatedUser;
use evaluation::simulation::users::Domain;
use scene::{Scene, question_from_json};
use serde_json::{Value as Json, json};
use vocabulary::Params;

use crate::console::{Console, http};
use crate::openapi::Description;
use crate::{Group, wait_for};

/// Timeout of a wait for an event.
const PATIENCE: Duration = Duration::from_secs(80);

/// A program with a token.
#[derive(Clone, Debug)]
pub struct Program {
    /// Where it asks, and its token.
    pub console: Console,
    /// Before `/api/v1` in an address: behind a gateway, the robot.
    pub folder: String,
    description: Description,
}

/// An answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Status.
    pub status: u16,
    /// Status line and headers.
    pub head: String,
    /// Body.
    pub body: Json,
}

impl Answer {
    /// Returns a header's value.
    pub fn header(&self, name: &str) -> Option<String> {
        let mut lines = self.head.lines().filter_map(|line| line.split_once(": "));
        lines.find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.to_owned())
    }

    /// Returns the reply to words.
    ///
    /// # Panics
    /// If there is none.
    pub fn reply(&self) -> &Json {
        assert!([200, 202].contains(&self.status), "{self:?}");
        &self.body["reply"]
    }
}

impl Program {
    /// Makes a token with these rights, and a program that has it.
    pub fn new(group: &Group, name: &str, may: &str) -> Self {
        let made = group.must(&["token", "add", name, "--may", may, "--json"]).json();
        let token = made["token"].as_str().expect("a new token").to_owned();
        Self::with_token(group, Some(token))
    }

    /// Makes a program with a token, or without one.
    pub fn with_token(group: &Group, token: Option<String>) -> Self {
        let console = Console { token, ..group.console() };
        Self::at(console, "")
    }

    /// The same program with another token.
    pub fn with(&self, token: String) -> Self {
        let console = Console { token: Some(token), ..self.console.clone() };
        Self { console, ..self.clone() }
    }

    /// Makes a program that asks at this place.
    pub fn at(console: Console, folder: &str) -> Self {
        let (status, _, text) =
            http(&console, "GET", &format!("{folder}/api/v1/openapi.json"), &[], "");
        assert_eq!(status, 200, "{text}");
        Self { console, folder: folder.to_owned(), description: Description::new(&text) }
    }

    /// Asks.
    ///
    /// # Panics
    /// If the answer is not as described.
    pub fn ask(&self, method: &str, path: &str, headers: &[&str], body: &str) -> Answer {
        let place = format!("{}/api/v1{path}", self.folder);
        let (status, head, text) = http(&self.console, method, &place, headers, body);
        let answer = Answer { status, head, body: serde_json::from_str(&text).unwrap_or_default() };
        let kind = answer.header("content-type").unwrap_or_default();
        self.description.check(method, path, status, &kind, &text);
        answer
    }

    /// Asks for something to read.
    pub fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, &[], "")
    }

    /// Stops the arm, and returns the answer to the first order that was confirmed in time. On a busy machine one may be
    /// late, which its answer says.
    pub fn stop(&self) -> Answer {
        wait_for("a confirmed stop", 20.0, || {
            Some(self.post("/motion/stop")).filter(|answer| answer.status == 200)
        })
    }

    /// Orders something.
    pub fn post(&self, path: &str) -> Answer {
        self.ask("POST", path, &[], "")
    }

    /// Says something under a key.
    pub fn say_under(&self, key: &str, body: &Json) -> Answer {
        self.ask("POST", "/say", &[&format!("Idempotency-Key: {key}")], &body.to_string())
    }

    /// Says something.
    pub fn say(&self, text: &str) -> Answer {
        self.ask("POST", "/say", &[], &json!({ "text": text }).to_string())
    }

    /// Says something under a key until it is answered, through refusals that invite to try again.
    ///
    /// # Panics
    /// If it never is.
    pub fn say_until_answered(&self, key: &str, body: &Json) -> Answer {
        wait_for("an answer", 60.0, || {
            let answer = self.try_to_say(key, body)?;
            (answer.status == 200).then_some(answer)
        })
    }

    /// As [`Program::say_under`]; `None` if the console is away, or invites to try again.
    pub fn try_to_say(&self, key: &str, body: &Json) -> Option<Answer> {
        let place = self.console.place.split('/').next().unwrap_or_default();
        TcpStream::connect(place).ok()?;
        let asked = std::panic::catch_unwind(|| self.say_under(key, body)).ok()?;
        (asked.header("retry-after").is_none()).then_some(asked)
    }

    /// Answers the robot's questions truthfully, as a user who wants the object, until it fetches something; returns the
    /// last reply.
    ///
    /// # Panics
    /// If it never does.
    pub fn converse(&self, scene: &Scene, request: &str, object: &str) -> Json {
        let mut reply = self.say(request).reply().clone();
        for _ in 0..20 {
            if reply["kind"] != "question" {
                return reply;
            }
            assert_eq!(reply["expects_answer"], true, "{reply}");
            let text = true_answer(scene, &reply["question"], object);
            reply = self.say(&text).reply().clone();
        }
        panic!("it asks on and on: {reply}")
    }

    /// Opens the stream of events, after the event `last` where there is one.
    ///
    /// # Panics
    /// If it is refused.
    pub fn events(&self, last: Option<&str>) -> EventStream {
        let place = self.console.place.split('/').next().unwrap_or_default();
        let mut stream = TcpStream::connect(place).expect("the console listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let token = self.console.token.as_deref().unwrap_or_default();
        let last = last.map(|id| format!("Last-Event-ID: {id}\r\n")).unwrap_or_default();
        let folder = &self.folder;
        write!(
            stream,
            "GET {folder}/api/v1/events HTTP/1.1\r\nHost: {place}\r\nAuthorization: Bearer {token}\r\n{last}\r\n"
        )
        .expect("the console reads");
        let mut lines = BufReader::new(stream).lines();
        let status = lines.next().and_then(Result::ok).unwrap_or_default();
        assert!(status.contains(" 200 "), "{status}");
        EventStream { lines, description: self.description.clone(), last: None }
    }
}

/// The true answer of a user who wants an object to a question in JSON.
///
/// # Panics
/// If the question is not one of the scene.
pub fn true_answer(scene: &Scene, question: &Json, object: &str) -> String {
    let question = question_from_json(scene, question).unwrap_or_else(|e| panic!("{e}"));
    let model = Model::new(scene, Params::default());
    let mut user = SimulatedUser::truthful(scene.object_named(object));
    let turn = user.answer(Domain { scene, model: &model }, question);
    turn.reply.text().unwrap_or("I do not know").to_owned()
}

/// An open stream of events.
#[derive(Debug)]
pub struct EventStream {
    lines: std::io::Lines<BufReader<TcpStream>>,
    description: Description,
    /// Identifier of the latest event.
    pub last: Option<String>,
}

impl EventStream {
    /// Returns the next event, name and data; none at the end.
    pub fn next_event(&mut self) -> Option<(String, Json)> {
        let (mut name, mut data) = (None, None);
        while name.is_none() || data.is_none() {
            let line = self.lines.next()?.ok()?;
            match line.split_once(": ") {
                Some(("id", id)) => self.last = Some(id.to_owned()),
                Some(("event", word)) => name = Some(word.to_owned()),
                Some(("data", text)) => data = Some(serde_json::from_str(text).expect("JSON")),
                _ => {}
            }
        }
        let (name, data): (String, Json) = (name?, data?);
        match name.as_str() {
            "snapshot" => self.description.check_named("State", &data),
            "state" => self.description.check_named("StateEvent", &data),
            "question" => self.description.check_named("QuestionEvent", &data),
            "line" => self.description.check_named("LineEvent", &data),
            "ended" => self.description.check_named("Ended", &data),
            "gap" => assert_eq!(data, json!({})),
            other => panic!("event {other} is not described"),
        }
        Some((name, data))
    }

    /// Reads until an event satisfies `is`, and returns it with the names of those before.
    ///
    /// # Panics
    /// If the stream ends first, or takes too long.
    pub fn until(&mut self, what: &str, is: impl Fn(&str, &Json) -> bool) -> (Json, Vec<String>) {
        let (mut before, began) = (Vec::new(), Instant::now());
        loop {
            let event = self.next_event().filter(|_| began.elapsed() < PATIENCE);
            let (name, data) = event.unwrap_or_else(|| panic!("{what}: not among {before:?}"));
            if is(&name, &data) {
                return (data, before);
            }
            before.push(name);
        }
    }
}
