use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixListener;
use std::thread;

use serde_json::{Value as Json, json};

use super::*;

/// Returns the request, the output and the outcome if the supervisor answers with `reply`.
fn run(
    reply: Json,
    json: bool,
    verb: impl FnOnce(&GroupPaths, &mut Output<'_>) -> Outcome,
) -> (Json, String, Result<Exit, (Exit, String)>) {
    let (_home, paths) = crate::verbs::lab();
    std::fs::create_dir_all(paths.run()).unwrap();
    let listener = UnixListener::bind(paths.control_socket()).unwrap();
    let supervisor = thread::spawn(move || {
        loop {
            let (stream, _) = listener.accept().unwrap();
            let mut line = String::new();
            BufReader::new(&stream).read_line(&mut line).unwrap();
            if line.contains("status") {
                let busy = json!({"reply": "refused", "kind": "not-reached", "message": "busy"});
                writeln!(&stream, "{busy}").unwrap();
            } else {
                writeln!(&stream, "{reply}").unwrap();
                return line;
            }
        }
    });
    let mut printed = Vec::new();
    let ended = verb(&paths, &mut Output::to(&mut printed, json))
        .map_err(|failure| (failure.exit, failure.message));
    let asked = serde_json::from_str(&supervisor.join().unwrap()).unwrap();
    (asked, String::from_utf8(printed).unwrap(), ended)
}

fn arm() -> ServiceArgs {
    ServiceArgs { service: "arm".into(), timeout: Duration::from_millis(1500) }
}

#[test]
fn verbs_send_their_requests() {
    let done = || json!({"reply": "done", "message": "arm is so"});
    let (asked, printed, ended) =
        run(done(), false, |paths, out| on_service(paths, Request::Hold, arm(), out));
    assert_eq!(asked, json!({"verb": "hold", "service": "arm", "wait_ms": 1500}));
    assert_eq!((printed.as_str(), ended), ("arm is so\n", Ok(Exit::Ok)));
    let (asked, printed, _) =
        run(done(), true, |paths, out| on_service(paths, Request::Start, arm(), out));
    assert_eq!(asked["verb"], "start");
    assert_eq!(printed, "{\"schema\":1,\"message\":\"arm is so\"}\n");
    let (asked, ..) = run(done(), false, |paths, out| {
        let (service, command) = ("arm".to_owned(), vec!["python3".to_owned()]);
        swap(paths, SwapArgs { service, command, timeout: Duration::from_secs(1) }, out)
    });
    assert_eq!(asked["command"], json!(["python3"]));
    assert!(asked["directory"].as_str().unwrap().starts_with('/'));
}

#[test]
fn refusal_is_printed_with_details_and_kind() {
    let kinds =
        [("usage", Exit::Usage), ("config", Exit::Config), ("not-reached", Exit::NotReached)];
    for (kind, exit) in kinds {
        let refused =
            json!({"reply": "refused", "kind": kind, "message": "no", "details": ["why"]});
        let (_, printed, ended) =
            run(refused, false, |paths, out| on_service(paths, Request::Release, arm(), out));
        assert_eq!((printed.as_str(), ended), ("", Err((exit, "no\n  why".to_owned()))));
    }
}

#[test]
fn reload_lists_the_restarted_services() {
    let args = |scene: Option<&str>| ReloadArgs {
        scene: scene.map(str::to_owned),
        timeout: Duration::ZERO,
    };
    let reloaded = |names: Json| {
        let reply = json!({"reply": "reloaded", "restarted": names});
        run(reply, false, |paths, out| reload(paths, args(None), out)).1
    };
    assert!(reloaded(json!(["policy", "arm"])).ends_with("restarted: policy, arm\n"));
    assert!(reloaded(json!([])).ends_with("no service had to be restarted\n"));
    let reply = json!({"reply": "reloaded", "restarted": []});
    let (asked, ..) = run(reply, false, |paths, out| reload(paths, args(Some("tools")), out));
    assert_eq!(asked, json!({"verb": "use-scene", "scene": "tools", "wait_ms": 0}));
}

#[test]
fn down_reports_killed_services_and_leftovers() {
    let report = json!({"reply": "down", "killed": ["arm"], "strays": [], "leftovers": ["/dev/x"],
                        "seconds": 0.25});
    let bring_down = |paths: &GroupPaths, out: &mut Output<'_>| down(paths, Duration::ZERO, out);
    let (_, printed, ended) = run(report, false, bring_down);
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines[0], "group lab is down after 250 ms");
    assert_eq!(lines[1], "  did not end when asked and were killed: arm");
    assert_eq!(lines[2], "  left in shared memory and removed: /dev/x");
    assert_eq!((lines.len(), ended), (3, Ok(Exit::Ok)));
}

#[test]
fn invalid_answer_is_an_error() {
    let reply = json!({"reply": "done", "message": "what?"});
    let (_, _, ended) = run(reply, false, |paths, out| down(paths, Duration::ZERO, out));
    assert!(ended.unwrap_err().1.contains("invalid answer of the supervisor"));
}

/// A process that holds the group, as a supervisor does that still checks its configuration.
fn starting(paths: &GroupPaths) -> std::process::Child {
    std::fs::create_dir_all(paths.root()).unwrap();
    let lock = safe_files::open_lock(&paths.supervisor_lock()).unwrap();
    lock.lock().unwrap();
    // It inherits the lock.
    let held = std::process::Stdio::from(lock.try_clone().unwrap());
    let process = std::process::Command::new("sleep").arg("600").stdin(held).spawn().unwrap();
    std::fs::write(paths.supervisor_lock(), format!("{}\n", process.id())).unwrap();
    process
}

#[test]
fn supervisor_that_starts_is_found_and_ended() {
    let (_home, paths) = super::super::lab();
    let mut process = starting(&paths);
    let pid = process.id();
    let printed = |verb: &dyn Fn(&mut Output<'_>) -> Outcome| {
        let mut bytes = Vec::new();
        let exit = verb(&mut Output::to(&mut bytes, false)).unwrap();
        (exit, String::from_utf8(bytes).unwrap())
    };
    let (exit, status) = printed(&|out| super::super::status::status(&paths, out));
    let expected = format!("group lab is starting: supervisor {pid} checks the configuration\n");
    assert_eq!((exit, status), (Exit::NotReached, expected));
    let reaper = std::thread::spawn(move || process.wait().unwrap());
    let (exit, down) = printed(&|out| super::down(&paths, Duration::from_secs(20), out));
    let expected = format!(
        "group lab was starting; its supervisor {pid} is ended\ngroup lab is not running\n"
    );
    assert_eq!((exit, down), (Exit::Ok, expected));
    assert!(!reaper.join().unwrap().success(), "it was asked to end");
    let (_, down) = printed(&|out| super::down(&paths, Duration::ZERO, out));
    assert_eq!(down, "group lab is not running\n");
}
