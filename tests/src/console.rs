//! A console page without a browser: its socket and the messages that it received.

use crate::http_program::true_answer;
use crate::{Group, wait_for};
use scene::Scene;
use serde_json::{Map, Value as Json, json};
use service::console_link;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket, client};

/// Timeout of one read of the socket.
const LOOK: Duration = Duration::from_millis(20);
/// Timeout of a wait.
const PATIENCE: Duration = Duration::from_secs(80);

/// An open page.
#[derive(Debug)]
pub struct Page {
    socket: WebSocket<TcpStream>,
    /// The console's first message.
    pub welcome: Json,
    /// The current sections.
    pub parts: Map<String, Json>,
    /// The transcript, by number.
    pub lines: Vec<Json>,
    /// All other messages, oldest first.
    pub messages: Vec<Json>,
    /// Number of received frames.
    pub frames: u64,
    /// Bytes of their texts.
    pub bytes: usize,
    /// Code and reason, once the console has closed the socket.
    pub closed: Option<(u16, String)>,
    next: u64,
}

/// Identity of a page.
#[derive(Clone, Debug)]
pub struct Visitor<'a> {
    /// 32 hexadecimal digits.
    pub session: String,
    /// `operator`, `viewer` or `screen`.
    pub role: &'a str,
    /// The latest line received.
    pub last_line: u64,
    /// More headers of the request.
    pub headers: Vec<(&'static str, String)>,
}

impl Visitor<'_> {
    /// An operator in the session of this number.
    pub fn operator(number: u32) -> Self {
        let session = format!("{number:032x}");
        Self { session, role: "operator", last_line: 0, headers: Vec::new() }
    }
}

/// Where a console is, and the token that lets one in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Console {
    /// `127.0.0.1:PORT`, behind a gateway `127.0.0.1:PORT/ROBOT`.
    pub place: String,
    /// None: the console is asked without it.
    pub token: Option<String>,
}

impl std::fmt::Display for Console {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.place)
    }
}

impl Console {
    /// The console for one who does not have the token.
    pub fn without_token(&self) -> Self {
        Self { token: None, ..self.clone() }
    }

    fn bearer(&self) -> Option<String> {
        self.token.as_ref().map(|token| format!("Bearer {token}"))
    }
}

impl Group {
    /// The group's console, for its owner.
    pub fn console(&self) -> Console {
        let place = wait_for("the console's address", 10.0, || {
            let url = console_link::address(self.paths())?;
            Some(url.strip_prefix("http://")?.trim_end_matches('/').to_owned())
        });
        Console { place, token: console_link::token(self.paths()) }
    }

    /// Opens a page.
    pub fn page(&self, visitor: &Visitor<'_>) -> Page {
        wait_for("the console's welcome", 20.0, || Page::open(&self.console(), visitor).ok())
    }
}

/// One request over HTTP: status, headers and body as text. The request has these further lines.
///
/// # Panics
/// If no response arrives.
pub fn http(
    console: &Console,
    method: &str,
    path: &str,
    more: &[&str],
    body: &str,
) -> (u16, String, String) {
    let place = console.place.split('/').next().unwrap_or(&console.place);
    let mut stream = TcpStream::connect(place).expect("the console listens");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    let host = if more.iter().any(|line| line.starts_with("Host:")) { "" } else { place };
    let host = if host.is_empty() { String::new() } else { format!("Host: {host}\r\n") };
    let bearer = console.bearer().map(|bearer| format!("Authorization: {bearer}"));
    let more = more.iter().copied().chain(bearer.as_deref());
    let more: String = more.map(|line| format!("{line}\r\n")).collect();
    let length = body.len();
    write!(
        stream,
        "{method} {path} HTTP/1.1\r\n{host}{more}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    )
    .expect("the console reads");
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    let status = head.split(' ').nth(1).and_then(|code| code.parse().ok());
    (status.unwrap_or_else(|| panic!("{head}")), head.to_owned(), body.to_owned())
}

impl Page {
    /// Opens a page and waits for its welcome.
    ///
    /// # Errors
    /// The console rejects the page, or does not answer.
    pub fn open(console: &Console, visitor: &Visitor<'_>) -> Result<Self, String> {
        let mut page = Self::connect(console, visitor)?;
        let Visitor { session, role, last_line, .. } = visitor;
        page.send(&json!({ "t": "hello", "protocol": 2, "session": session, "name": "test",
                           "last_line": last_line, "role": role }));
        let until = Instant::now() + PATIENCE;
        while page.welcome.is_null() {
            page.look();
            if let Some((code, why)) = &page.closed {
                return Err(format!("{code} {why}"));
            }
            if Instant::now() > until {
                return Err("no welcome".to_owned());
            }
        }
        Ok(page)
    }

    /// Opens a socket without a greeting.
    ///
    /// # Errors
    /// The console rejects the connection.
    pub fn connect(console: &Console, visitor: &Visitor<'_>) -> Result<Self, String> {
        let place = &console.place;
        // Behind a gateway a console has a folder.
        let host = place.split('/').next().unwrap_or(place);
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let stream = TcpStream::connect(host).map_err(|e| text(&e))?;
        stream.set_read_timeout(Some(PATIENCE)).map_err(|e| text(&e))?;
        stream.set_write_timeout(Some(Duration::from_secs(1))).map_err(|e| text(&e))?;
        let mut request = format!("ws://{place}/ws").into_client_request().map_err(|e| text(&e))?;
        let headers = request.headers_mut();
        let origin = HeaderValue::from_str(&format!("http://{host}")).map_err(|e| text(&e))?;
        headers.insert("origin", origin);
        let bearer = console.bearer().map(|bearer| ("authorization", bearer));
        for (name, value) in bearer.iter().chain(&visitor.headers) {
            headers.insert(*name, HeaderValue::from_str(value).map_err(|e| text(&e))?);
        }
        let (socket, _) = client(request, stream).map_err(|e| text(&e))?;
        socket.get_ref().set_read_timeout(Some(LOOK)).map_err(|e| text(&e))?;
        Ok(Self {
            socket,
            welcome: Json::Null,
            parts: Map::new(),
            lines: Vec::new(),
            messages: Vec::new(),
            frames: 0,
            bytes: 0,
            closed: None,
            next: 0,
        })
    }

    /// Sends a message.
    pub fn send(&mut self, message: &Json) {
        self.send_raw(Message::Text(message.to_string().into()));
    }

    /// Sends any frame.
    pub fn send_raw(&mut self, frame: Message) {
        if self.socket.send(frame).is_err() {
            self.closed.get_or_insert((0, "it does not read".to_owned()));
        }
    }

    /// Receives one message, if one arrives within a short timeout.
    pub fn look(&mut self) {
        match self.socket.read() {
            Ok(Message::Text(text)) => {
                self.frames += 1;
                self.bytes += text.len();
                self.hear(serde_json::from_str(&text).expect("frames are JSON"));
            }
            Ok(Message::Close(frame)) => {
                let closed = frame.map(|frame| (frame.code.into(), frame.reason.to_string()));
                self.closed = Some(closed.unwrap_or_default());
            }
            Ok(_) => {}
            Err(tungstenite::Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) => {
                self.closed.get_or_insert((0, error.to_string()));
                std::thread::sleep(LOOK);
            }
        }
    }

    fn hear(&mut self, message: Json) {
        match message["t"].as_str() {
            Some("welcome") => self.welcome = message,
            Some("state") => {
                let parts = message["parts"].as_object().expect("parts");
                self.parts.extend(parts.clone());
            }
            Some("lines") => {
                for line in message["lines"].as_array().expect("lines") {
                    self.lines.retain(|known| known["id"] != line["id"]);
                    self.lines.push(line.clone());
                }
                self.lines.sort_by_key(|line| line["id"].as_u64());
            }
            _ => self.messages.push(message),
        }
    }

    /// Receives until `found` returns a value, and returns it.
    ///
    /// # Panics
    /// After [`PATIENCE`].
    pub fn until<R>(&mut self, what: &str, mut found: impl FnMut(&Self) -> Option<R>) -> R {
        let until = Instant::now() + PATIENCE;
        loop {
            if let Some(found) = found(self) {
                return found;
            }
            let Self { parts, lines, messages, closed, .. } = self;
            assert!(
                Instant::now() < until,
                "no {what} within {PATIENCE:?}\n{parts:?}\n{lines:?}\n{messages:?}\n{closed:?}"
            );
            self.look();
        }
    }

    /// Receives until the section `part` satisfies `is`.
    pub fn until_part(&mut self, part: &str, is: impl Fn(&Json) -> bool) -> Json {
        self.until(part, |page| page.parts.get(part).filter(|value| is(value)).cloned())
    }

    /// Receives until a line satisfies `is`.
    pub fn until_line(&mut self, what: &str, is: impl Fn(&Json) -> bool) -> Json {
        self.until(what, |page| page.lines.iter().find(|line| is(line)).cloned())
    }

    /// Sends a command and waits for its answer.
    pub fn ask(&mut self, verb: &str, more: &Json) -> Json {
        let id = self.begin(verb, more);
        self.until(verb, |page| page.messages.iter().find(|message| message["id"] == id).cloned())
    }

    /// Stops the arm, and returns what the first order that was confirmed in time is answered. On a busy machine one may
    /// be late, which its answer says.
    pub fn stop(&mut self) -> Json {
        wait_for("a confirmed stop", 20.0, || {
            Some(self.ask("stop", &Json::Null)).filter(|answer| answer["ok"] == true)
        })
    }

    /// Sends a command and returns its number.
    pub fn begin(&mut self, verb: &str, more: &Json) -> u64 {
        self.next += 1;
        let mut message = json!({ "t": "do", "id": self.next, "do": verb });
        if let (Some(message), Some(more)) = (message.as_object_mut(), more.as_object()) {
            message.extend(more.clone());
        }
        self.send(&message);
        self.next
    }

    /// The viewer's name, e.g. `v3`.
    pub fn viewer(&self) -> String {
        self.welcome["viewer"].as_str().unwrap_or_default().to_owned()
    }

    /// The latest line received.
    pub fn last_line(&self) -> u64 {
        self.lines.last().and_then(|line| line["id"].as_u64()).unwrap_or(0)
    }

    /// Answers truthfully as a user who wants the object, until the interaction ends, and returns
    /// its outcome.
    ///
    /// # Panics
    /// If it does not end.
    pub fn converse(&mut self, object: &str) -> Json {
        let over = |dialogue: &Json| dialogue["interaction"] == 0 && !dialogue["last"].is_null();
        self.answer_until(object, over)["last"].clone()
    }

    /// Answers truthfully as a user who wants the object, until the dialogue satisfies `over`.
    ///
    /// # Panics
    /// If it never does.
    pub fn answer_until(&mut self, object: &str, over: impl Fn(&Json) -> bool) -> Json {
        let (mut answered, mut said) = (None, 0);
        loop {
            let (seen, asked) = self.until("question or end", |page| {
                let (dialogue, turn) = (page.parts.get("dialogue")?, page.parts.get("turn")?);
                let speaking = page.parts.get("speaking")?;
                let asked = (speaking["prompt"].as_u64(), speaking["presentation"].as_u64());
                let is_asked = turn["state"] == "asked"
                    && dialogue["prompt"].as_u64() == asked.0
                    && dialogue["applied"].as_u64() >= Some(said)
                    && answered != Some(asked);
                (over(dialogue) || is_asked).then(|| (dialogue.clone(), asked))
            });
            if over(&seen) {
                return seen;
            }
            answered = Some(asked);
            let text = self.answer_for(&seen["question"], object);
            let done = self.ask("say", &json!({ "text": text }));
            assert!(done["ok"] == true, "{text}: {done}");
            said = done["seq"].as_u64().unwrap_or(said);
        }
    }

    /// The true answer of a user who wants the object.
    fn answer_for(&self, question: &Json, object: &str) -> String {
        let objects = self.parts["scene"]["objects"].as_array().expect("objects").iter();
        let named = |one: &Json| json!({ "name": one["name"], "attributes": one["attributes"] });
        let objects: Vec<Json> = objects.map(named).collect();
        let scene = Scene::from_json("the page's scene", &json!({ "objects": objects }))
            .unwrap_or_else(|problems| panic!("{problems:?}"));
        true_answer(&scene, question, object)
    }
}
