//! Who gets to the console, and that it stays reachable.

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::MetadataExt;

use rustix::process::{Pid, Resource, Rlimit, prlimit};
use serde_json::{Value as Json, json};
use whichone_tests::Group;
use whichone_tests::console::{Console, Page, Visitor, http};

fn ok(done: &Json) -> bool {
    assert!(done["ok"].as_bool().is_some(), "{done}");
    done["ok"] == true
}

#[test]
fn foreign_origins_are_refused() {
    let group = Group::up(&[]);
    let place = group.console();
    let foreign = |name, value: &str| Visitor {
        headers: vec![(name, value.to_owned())],
        ..Visitor::operator(1)
    };
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1"] {
        let refused = Page::connect(&place, &foreign("origin", origin)).unwrap_err();
        assert!(refused.contains("403"), "{refused}");
    }
    // A name of another site's that leads to this machine; its page has no session here.
    let without = place.without_token();
    assert_eq!(http(&without, "GET", "/api/state", &["Host: evil.example"], "").0, 401);
    let (_, head, _) = http(&place, "GET", "/", &[], "");
    assert!(head.to_lowercase().contains("content-security-policy: default-src 'self'"), "{head}");
    group.down();
}

#[test]
fn page_is_for_those_with_the_token() {
    let group = Group::up(&[]);
    let owner = group.console();
    let place = owner.without_token();
    let html = "Accept: text/html";
    for path in ["/api/state", "/metrics", "/robot.urdf", "/study/export.json", "/ws"] {
        assert_eq!(http(&place, "GET", path, &[], "").0, 401, "{path}");
    }
    let (status, head, _) = http(&place, "GET", "/", &[html], "");
    assert!(status == 303 && head.contains("/login"), "{head}");
    assert_eq!(http(&place, "GET", "/login", &[html], "").0, 200);
    assert_eq!(http(&place, "GET", "/healthz", &[], "").0, 200);
    assert!(Page::connect(&place, &Visitor::operator(1)).unwrap_err().contains("401"));
    let stranger = Console { token: Some("wrong-token-0123".to_owned()), ..place.clone() };
    for (place, why) in [(&place, "token required; help:"), (&stranger, "wrong token; help:")] {
        let (status, _, body) = http(place, "GET", "/api/state", &[], "");
        assert!(status == 401 && body.starts_with(why), "{status} {body}");
    }
    let token = owner.token.clone().expect("a token");
    let own = format!("Origin: http://{place}");
    let wrong = http(&place, "POST", "/login", &[&own], "token=guess");
    assert!(wrong.1.contains("/login?wrong") && !wrong.1.to_lowercase().contains("set-cookie"));
    let form = format!("token={token}");
    assert_eq!(http(&place, "POST", "/login", &[], &form).0, 403);
    for link in
        [("GET", format!("/?{form}&lang=de"), String::new()), ("POST", "/login".to_owned(), form)]
    {
        let (method, path, body) = link;
        let (status, head, _) = http(&place, method, &path, &[&own], &body);
        assert_eq!(status, 303, "{head}");
        assert!(!head.contains(&token), "neither cookie nor address is the token: {head}");
        let lower = head.to_lowercase();
        let (_, cookie) = lower.split_once("set-cookie: ").unwrap_or_else(|| panic!("{head}"));
        let cookie = cookie.split(';').next().unwrap().to_owned();
        let visitor = Visitor { headers: vec![("cookie", cookie)], ..Visitor::operator(1) };
        drop(Page::open(&place, &visitor).unwrap());
    }
    assert_eq!(http(&owner, "GET", "/api/state", &[], "").0, 200);
    let link = group.must(&["console"]).stdout;
    assert_eq!(link.trim(), format!("http://{place}/?token={token}"));
    group.down();
}

#[test]
fn token_is_private_and_can_be_renewed() {
    let group = Group::up(&[]);
    let before = group.console();
    let token = before.token.clone().expect("a token");
    let file = service::console_link::token_file(group.paths());
    assert_eq!(std::fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
    let log = group.paths().log_file("supervisor");
    assert_eq!(std::fs::metadata(log).unwrap().mode() & 0o777, 0o600);
    // Not even in the arguments of a process, which every user can read.
    for process in std::fs::read_dir("/proc").unwrap() {
        let arguments = process.unwrap().path().join("cmdline");
        let arguments = std::fs::read(arguments).unwrap_or_default();
        assert!(!String::from_utf8_lossy(&arguments).contains(&token));
    }
    let renewed = group.must(&["console", "--renew", "--json"]).json();
    assert_ne!(renewed["token"], token.as_str());
    assert_eq!(http(&before, "GET", "/api/state", &[], "").0, 401);
    assert_eq!(http(&group.console(), "GET", "/api/state", &[], "").0, 200);
    // A word of the owner's own outlives the logins before the restart that makes it count.
    std::fs::write(&file, "my-own-word-123\n").unwrap();
    let running =
        Console { token: renewed["token"].as_str().map(str::to_owned), ..group.console() };
    let own = format!("Origin: http://{running}");
    let form = format!("token={}", running.token.as_deref().unwrap());
    assert_eq!(http(&running.without_token(), "POST", "/login", &[&own], &form).0, 303);
    group.must(&["restart", "console"]);
    assert_eq!(group.console().token.as_deref(), Some("my-own-word-123"));
    assert_eq!(http(&group.console(), "GET", "/api/state", &[], "").0, 200);
    group.down();
}

#[test]
fn page_is_open_where_the_configuration_says_so() {
    let group = Group::up(&["console.access=open"]);
    let anyone = group.console().without_token();
    assert_eq!(http(&anyone, "GET", "/api/state", &[], "").0, 200);
    assert_eq!(http(&anyone, "GET", "/api/state", &["Host: evil.example"], "").0, 421);
    drop(Page::open(&anyone, &Visitor::operator(1)).unwrap());
    group.wait_for_log("console", "every user of this machine can operate the robot");
    group.down();
}

#[test]
fn port_in_use_is_avoided() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let listen = format!("console.listen=127.0.0.1:{port}");
    let group = Group::up(&[&listen]);
    let place = group.console();
    assert!(!place.place.ends_with(&format!(":{port}")), "{place}");
    group.wait_for_log("console", "another one is used");
    assert_eq!(group.status()["console"], format!("http://{place}/"));
    group.down();
}

#[test]
fn operator_gets_in_beside_any_number_of_viewers() {
    let group = Group::up(&[]);
    let place = group.console();
    let viewer = |n| Visitor { role: "viewer", ..Visitor::operator(n) };
    let mut open: Vec<Page> = (1..=31).map(|n| group.page(&viewer(n))).collect();
    for n in 32..=40 {
        let refused = Page::open(&place, &viewer(n)).unwrap_err();
        assert!(refused.contains("1013") && refused.contains("viewers_max"), "{refused}");
    }
    let mut operator = group.page(&Visitor::operator(100));
    assert!(ok(&operator.ask("say", &json!({ "text": "get me the bowl" }))));
    // Also where idle pages that may operate hold every place.
    let mut next = group.page(&Visitor::operator(101));
    let code =
        open[0].until("the end of the page that was idle for longest", |p| p.closed.clone()).0;
    assert_eq!(code, 4002);
    next.stop();
    drop((open, operator, next));
    group.down();
}

/// At 256 descriptors, 400 visitors who begin a request and never end it.
#[test]
fn page_loads_among_half_open_connections() {
    const DESCRIPTORS: u64 = 256;
    let group = Group::up(&[]);
    let supervisor = group.status()["supervisor_pid"].as_u64().unwrap();
    let limit = Rlimit { current: Some(DESCRIPTORS), maximum: Some(DESCRIPTORS) };
    let pid = Pid::from_raw(i32::try_from(supervisor).unwrap());
    prlimit(pid, Resource::Nofile, limit).unwrap();
    group.must(&["restart", "console"]);
    let place = group.console();
    let begin = |_| {
        let mut stream = TcpStream::connect(&place.place).unwrap();
        stream.write_all(b"GET / HTTP/1.1\r\n").unwrap();
        stream
    };
    let mut crowd: Vec<TcpStream> = (0..400).map(begin).collect();
    let mut page = group.page(&Visitor::operator(1));
    for n in 2..6 {
        // Those who were shut out come back; the others send one more line.
        for stream in &mut crowd {
            if stream.write_all(b"X-More: please wait\r\n").is_err() {
                *stream = begin(0);
            }
        }
        let (status, _, body) = http(&place, "GET", "/", &["Accept: text/html"], "");
        assert!(status == 200 && body.contains("</html>"), "{status}");
        drop(Page::open(&place, &Visitor { role: "viewer", ..Visitor::operator(n) }).unwrap());
        // An open page works on.
        page.stop();
    }
    let console = group.pid("console").as_raw_nonzero();
    let used = std::fs::read_dir(format!("/proc/{console}/fd")).unwrap().count();
    assert!(used < DESCRIPTORS as usize, "{used}");
    drop((crowd, page));
    group.down();
}

/// Resident memory of a process, MiB.
fn resident_mib(pid: Pid) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", pid.as_raw_nonzero())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    let kib: u64 = line.trim().trim_end_matches(" kB").parse().unwrap();
    kib / 1024
}

/// Sixty uploads that never end, of one who has the token, first without control and then with it.
#[test]
fn large_bodies_take_no_memory_that_stays() {
    const BYTES: usize = 7 << 20;
    let group = Group::up(&[]);
    let place = group.console();
    let before = resident_mib(group.pid("console"));
    let bearer = place.token.clone().expect("a token");
    let chunk = vec![b' '; 1 << 16];
    let upload = |session: &str| {
        let mut stream = TcpStream::connect(&place.place).unwrap();
        stream.set_write_timeout(Some(std::time::Duration::from_millis(300))).unwrap();
        let head = format!(
            "POST /api/editor/check HTTP/1.1\r\nHost: {place}\r\nOrigin: http://{place}\r\n\
             Authorization: Bearer {bearer}\r\nX-Whichone-Session: {session}\r\n\
             Content-Length: {BYTES}\r\n\r\n"
        );
        // A server that does not want it closes the connection, or does not read.
        let mut sent = stream.write_all(head.as_bytes()).map(|()| head.len());
        for _ in 0..BYTES / chunk.len() - 1 {
            sent = sent.and_then(|_| stream.write_all(&chunk).map(|()| chunk.len()));
        }
        stream
    };
    let operator = Visitor::operator(1);
    let mut page = group.page(&operator);
    assert!(ok(&page.ask("take_control", &Json::Null)));
    for session in ["", operator.session.as_str()] {
        let held: Vec<TcpStream> = (0..60).map(|_| upload(session)).collect();
        let used = resident_mib(group.pid("console"));
        assert!(used < before + 64, "{before} MiB before, {used} MiB with {}", held.len());
        page.stop();
        assert_eq!(http(&place, "GET", "/api/state", &[], "").0, 200);
    }
    let used = resident_mib(group.pid("console"));
    assert!(used < before + 64, "{before} MiB before, {used} MiB after");
    drop(page);
    group.down();
}
