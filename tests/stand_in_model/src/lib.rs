//! A service that stands in for a model, for tests: it answers requests on loopback as a closure says.

use std::io::{self, BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use serde_json::{Value as Json, json};

/// Answer to one request.
#[derive(Clone, Debug)]
pub enum Reply {
    /// A completion with this text.
    Content(String),
    /// A completion with this text after a while.
    Slow(Duration, String),
    /// Another status, with this body.
    Status(u16, String),
    /// The connection is closed.
    Close,
}

type Answers = dyn FnMut(&Json) -> Reply + Send;

/// The service; it ends when it is dropped.
#[derive(Debug)]
pub struct StandIn {
    address: SocketAddr,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    answers: Mutex<Box<Answers>>,
    requests: Mutex<Vec<(String, Json)>>,
    ends: AtomicBool,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl StandIn {
    /// Starts a service on a free port.
    ///
    /// # Errors
    /// The operating system gives no port or thread.
    pub fn start(answers: impl FnMut(&Json) -> Reply + Send + 'static) -> io::Result<Self> {
        Self::start_at(SocketAddr::from(([127, 0, 0, 1], 0)), answers)
    }

    /// Starts a service at an address, as that of one that has ended.
    ///
    /// # Errors
    /// As [`StandIn::start`].
    pub fn start_at(
        address: SocketAddr,
        answers: impl FnMut(&Json) -> Reply + Send + 'static,
    ) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared {
            answers: Mutex::new(Box::new(answers)),
            requests: Mutex::default(),
            ends: AtomicBool::new(false),
        });
        let own = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("stand-in".to_owned());
        let thread = thread.spawn(move || serve(&listener, &own))?;
        Ok(Self { address, shared, thread: Some(thread) })
    }

    /// Its address.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The URL of its completions.
    pub fn url(&self) -> String {
        format!("http://{}/v1/chat/completions", self.address)
    }

    /// The requests so far: head and body of each.
    pub fn requests(&self) -> Vec<(String, Json)> {
        self.shared.requests.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for StandIn {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Release);
        // Wakes the thread that accepts.
        let _ = TcpStream::connect(self.address);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The text of the utterance in a request's body: its likeliest hypothesis.
pub fn heard(request: &Json) -> String {
    let user = request["messages"][1]["content"].as_str().unwrap_or_default();
    let user: Json = serde_json::from_str(user).unwrap_or_default();
    user["heard"][0]["text"].as_str().unwrap_or_default().to_owned()
}

/// Content of an answer with one certain reading, for no question: these values, and nothing else.
pub fn wants(base: &[&str]) -> String {
    json!({ "readings": [reading(Json::Null, 1.0, base, "none")] }).to_string()
}

/// One reading in an answer, which informs.
pub fn reading(question: Json, weight: f64, base: &[&str], response: &str) -> Json {
    json!({
        "question": question, "weight": weight, "base": base, "excluded": [], "response": response,
        "intent": "inform", "refers": "none", "further": [],
    })
}

fn serve(listener: &TcpListener, shared: &Arc<Shared>) {
    for stream in listener.incoming() {
        if shared.ends.load(Ordering::Acquire) {
            return;
        }
        let Ok(stream) = stream else { continue };
        let shared = Arc::clone(shared);
        // A slow answer does not keep the next request waiting. A broken connection is the client's business.
        std::thread::spawn(move || drop(answer(stream, &shared)));
    }
}

fn answer(stream: TcpStream, shared: &Shared) -> io::Result<()> {
    let mut reader = BufReader::new(stream.try_clone()?);
    let (head, body) = request(&mut reader)?;
    let json: Json = serde_json::from_slice(&body).unwrap_or_default();
    let locked = |_| io::Error::other("a test has failed");
    shared.requests.lock().map_err(locked)?.push((head, json.clone()));
    let locked = |_| io::Error::other("a test has failed");
    let reply = (shared.answers.lock().map_err(locked)?)(&json);
    let (status, body) = match reply {
        Reply::Content(text) => (200, completion(&text)),
        Reply::Slow(pause, text) => {
            std::thread::sleep(pause);
            (200, completion(&text))
        }
        Reply::Status(status, body) => (status, body),
        Reply::Close => return Ok(()),
    };
    let length = body.len();
    let head = format!("HTTP/1.1 {status} Answer\r\ncontent-type: application/json\r\n");
    let head = format!("{head}content-length: {length}\r\nconnection: close\r\n\r\n");
    (&stream).write_all(format!("{head}{body}").as_bytes())
}

fn completion(text: &str) -> String {
    let message = json!({ "role": "assistant", "content": text });
    json!({ "choices": [{ "index": 0, "finish_reason": "stop", "message": message }] }).to_string()
}

fn request(reader: &mut impl BufRead) -> io::Result<(String, Vec<u8>)> {
    let mut head = String::new();
    while !head.ends_with("\r\n\r\n") {
        if reader.read_line(&mut head)? == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
    }
    let head = head.to_ascii_lowercase();
    let length = head.lines().find_map(|line| line.strip_prefix("content-length:"));
    let length = length.and_then(|text| text.trim().parse().ok()).unwrap_or(0);
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    Ok((head, body))
}
