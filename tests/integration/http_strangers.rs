//! What the interface for programs does with strangers, other sites, slow clients and nonsense.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use serde_json::json;
use vocabulary::Rng;
use whichone_tests::Group;
use whichone_tests::console::http;
use whichone_tests::http_program::Program;

use crate::http::until_state;

#[test]
fn ten_thousand_wrong_tokens_are_refused_and_delay_no_one() {
    const GUESSES: usize = 10_000;
    /// More than are answered after a pause at a time.
    const GUESSERS: usize = 64;
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,talk,stop,resume");
    let right = program.console.token.clone().unwrap();
    let (next, counts) = (AtomicUsize::new(0), [const { AtomicUsize::new(0) }; 2]);
    let guess = || {
        while let Some(number) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|n| *n < GUESSES)
        {
            let token = match number % 3 {
                0 => format!("{number:032x}"),
                1 => right[..31 - number % 16].to_owned(),
                _ => format!("{right}{number}"),
            };
            let refused = program.with(token).get("/state");
            assert!(refused.status == 401 || refused.status == 429, "{refused:?}");
            counts[usize::from(refused.status == 429)].fetch_add(1, Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        (0..GUESSERS).for_each(|_| drop(scope.spawn(guess)));
        // Meanwhile whoever has a token is served.
        for _ in 0..20 {
            assert_eq!(program.get("/state").status, 200);
        }
        program.stop();
    });
    let [delayed, at_once] = counts.map(AtomicUsize::into_inner);
    assert_eq!(delayed + at_once, GUESSES);
    eprintln!("refused after a pause: {delayed}, at once: {at_once}");
    group.down();
}

#[test]
fn pages_of_other_sites_are_refused() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,talk,stop,resume");
    let place = program.console.place.clone();
    let body = json!({ "text": "get me the bowl" }).to_string();
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1"] {
        let origin = format!("Origin: {origin}");
        for (method, path) in [("GET", "/state"), ("POST", "/say"), ("POST", "/motion/stop")] {
            let refused = program.ask(method, path, &[&origin], &body);
            assert_eq!((refused.status, &refused.body["code"]), (403, &json!("origin")), "{path}");
        }
    }
    assert_eq!(program.ask("GET", "/state", &[&format!("Origin: http://{place}")], "").status, 200);
    assert_eq!(group.arm()["stopped"], false);
    group.down();
    // A name of another site's that leads to this machine, where no token is needed.
    let group = Group::up(&["console.access=open"]);
    let anyone = Program::with_token(&group, None);
    assert_eq!(anyone.get("/state").status, 200);
    let rebound = http(&anyone.console, "POST", "/api/v1/motion/stop", &["Host: evil.example"], "");
    assert_eq!(rebound.0, 421);
    group.down();
}

#[test]
fn slow_large_and_unreadable_requests_get_typed_answers() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,talk,stop,resume");
    until_state(&program, "idle");
    let say = |body: &str| {
        let answer = program.ask("POST", "/say", &[], body);
        (answer.status, answer.body["code"].as_str().unwrap_or_default().to_owned())
    };
    let long = "bowl ".repeat(201);
    for (body, status, code) in [
        (String::new(), 400, "unreadable"),
        ("{".to_owned(), 400, "unreadable"),
        ("[]".to_owned(), 400, "unreadable"),
        (r#"{"text":7}"#.to_owned(), 400, "unreadable"),
        (r#"{"txt":"yes"}"#.to_owned(), 400, "unreadable"),
        ("[".repeat(5_000), 400, "unreadable"),
        (r#"{"text":" \n "}"#.to_owned(), 422, "invalid"),
        (json!({ "text": long }).to_string(), 422, "invalid"),
        (r#"{"text":"yes","wait_s":61}"#.to_owned(), 422, "invalid"),
        (r#"{"text":"yes","wait_s":-1}"#.to_owned(), 422, "invalid"),
        (r#"{"text":"yes","conversation":""}"#.to_owned(), 422, "invalid"),
        (r#"{"text":"yes","from":"a\u0007b"}"#.to_owned(), 422, "invalid"),
        // A line that the robot has not said yet.
        (r#"{"text":"yes","seen":999}"#.to_owned(), 422, "invalid"),
        (format!(r#"{{"text":"{}"}}"#, "x".repeat(20_000)), 413, "too_large"),
    ] {
        assert_eq!(say(&body), (status, code.to_owned()), "{body:.80}");
    }
    for (method, path) in [("GET", "/state"), ("POST", "/motion/resume"), ("POST", "/cancel")] {
        let twice = program.ask(method, path, &["Authorization: Bearer 0123456789abcdef"], "");
        assert_eq!((twice.status, &twice.body["code"]), (400, &json!("unreadable")), "{path}");
    }
    let stop = r#"{"text":"stop","seen":999}"#;
    assert_eq!(program.ask("POST", "/say", &[], stop).reply()["kind"], "stopped");
    let odd = http(&program.console, "GET", "/api/v1/nothing", &[], "");
    assert!(odd.0 == 404 && odd.2.contains("not_found"), "{odd:?}");
    let odd = http(&program.console, "DELETE", "/api/v1/say", &[], "");
    assert!(odd.0 == 405 && odd.2.contains("method"), "{odd:?}");

    // A body that does not come, while another request is answered.
    let mut slow = TcpStream::connect(&program.console.place).unwrap();
    slow.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    let token = program.console.token.as_deref().unwrap();
    write!(
        slow,
        "POST /api/v1/say HTTP/1.1\r\nHost: {}\r\nAuthorization: Bearer {token}\r\n\
         Content-Length: 20\r\n\r\n{{",
        program.console.place
    )
    .unwrap();
    program.stop();
    let mut text = [0; 4_096];
    let count = slow.read(&mut text).unwrap();
    let text = String::from_utf8_lossy(&text[..count]);
    assert!(text.starts_with("HTTP/1.1 408") && text.contains("problem+json"), "{text}");
    assert_eq!(group.dialogue()["interaction"], 0, "nothing was said");
    group.down();
}

#[test]
fn fuzzed_requests_crash_nothing() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,talk,stop,resume");
    let before = group.pid("console");
    let seed = std::env::var("WHICHONE_SEED").ok().and_then(|seed| seed.parse().ok());
    let seed = seed.unwrap_or_else(|| u64::from(std::process::id()));
    eprintln!("WHICHONE_SEED={seed}");
    let mut rng = Rng::new(seed);
    let mut below = |bound: usize| (rng.next_u64() % bound as u64) as usize;
    let token = program.console.token.clone().unwrap();
    let words = [
        "POST",
        "GET",
        " ",
        "/api/v1/say",
        "/api/v1/events",
        "/api/v1/motion/resume",
        "HTTP/1.1",
        "\r\n",
        "Host: localhost",
        "Authorization: Bearer ",
        &token,
        "Idempotency-Key: ",
        "Last-Event-ID: ",
        "Content-Length: 9",
        "Transfer-Encoding: chunked",
        "{\"text\":",
        "\"\\ud800\"",
        "1e999",
        "}",
        "\0",
        "ÿ",
        "whichone-person: ann",
    ];
    for _ in 0..600 {
        let mut bytes = Vec::new();
        if below(2) == 0 {
            let head = "POST /api/v1/say HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nAuthorization: Bearer";
            bytes.extend_from_slice(format!("{head} {token}\r\n").as_bytes());
        }
        for _ in 0..below(24) {
            match below(5) {
                0 => bytes.push(below(256) as u8),
                _ => bytes.extend_from_slice(words[below(words.len())].as_bytes()),
            }
        }
        let mut stream = TcpStream::connect(&program.console.place).unwrap();
        stream.set_read_timeout(Some(Duration::from_millis(5))).unwrap();
        // The console may close it at any moment.
        let _ = stream.write_all(&bytes);
        let _ = stream.read(&mut [0; 512]);
    }
    assert_eq!(program.get("/state").status, 200, "seed {seed}");
    assert_eq!(group.pid("console"), before, "seed {seed}");
    group.down();
}
