//! The operator's verbs and the supervisor's automatic restarts.

use rustix::process::{Pid, Signal, kill_process};
use service::shm_cleanup;
use std::fs::File;
use std::process::Stdio;
use whichone_tests::{Group, wait_for};

#[test]
fn status_and_logs_show_services_and_restart_names_an_unknown_one() {
    let group = Group::up(&[]);
    for service in ["speech", "grounding", "policy", "arm"] {
        let row = group.service(service);
        assert_eq!(row["actual"], "ready", "{row}");
        for key in ["pid", "incarnation", "restarts", "uptime_s", "version", "rss_kib", "cpu_s"] {
            assert!(!row[key].is_null(), "{key} in {row}");
        }
    }
    assert_eq!(group.call(&["status"]).code, Some(0));
    group.wait_for_log("policy", "ready");
    let log = group.must(&["logs", "policy", "--tail", "5"]).stdout;
    assert!(log.contains("ready"), "{log}");
    let unknown = group.call(&["restart", "legs"]);
    assert_ne!(unknown.code, Some(0));
    assert!(unknown.stderr.contains("legs") && unknown.stderr.contains("arm"), "{unknown:?}");
    group.down();
}

#[test]
fn killed_service_is_restarted_alone() {
    let group = Group::up(&[]);
    let others: Vec<u64> = ["speech", "arm"].iter().map(|s| group.incarnation(s)).collect();
    let before = group.incarnation("policy");
    group.signal("policy", Signal::KILL);
    group.wait_for_restart("policy", before);
    let now: Vec<u64> = ["speech", "arm"].iter().map(|s| group.incarnation(s)).collect();
    assert_eq!(others, now);
    assert_eq!(group.service("policy")["restarts"], 1);
    group.down();
}

#[test]
fn watchdog_replaces_a_stopped_process() {
    let group = Group::up(&["group.services.grounding.watchdog_s=1.0"]);
    let before = group.incarnation("grounding");
    group.signal("grounding", Signal::STOP);
    group.wait_for_restart("grounding", before);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn hold_keeps_a_service_down_until_release() {
    let group = Group::up(&[]);
    group.must(&["hold", "speech"]);
    wait_for("the hold", 10.0, || (group.service("speech")["actual"] == "held").then_some(()));
    assert_eq!(group.service("speech")["state"], "held");
    let status = group.call(&["status"]);
    assert_eq!(status.code, Some(1), "not everything is ready");
    assert!(status.stdout.contains("whichone release speech"), "{status:?}");
    for verb in [&["say", "hello", "--timeout", "30"][..], &["await", "pick", "--timeout", "30"]] {
        let refused = group.call(verb);
        assert_eq!(refused.code, Some(1), "{refused:?}");
        let why = "error: speech is held by the operator; help: whichone release speech\n";
        assert_eq!(refused.stderr, why);
    }
    group.must(&["release", "speech"]);
    group.say("hello");
    group.must(&["hold", "policy"]);
    let kept = group.must(&["say", "a bowl"]);
    assert!(kept.stderr.contains("policy is held by the operator"), "{kept:?}");
    group.must(&["release", "policy"]);
    wait_for("the release", 10.0, || (group.service("speech")["actual"] == "ready").then_some(()));
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn listening_to_a_stream_ends_with_the_reason_once_speech_is_held() {
    let group = Group::up(&[]);
    let mut listen = group.command(&["listen", "-"]);
    let mut listen = listen.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    group.must(&["hold", "speech"]);
    // The stream itself does not end.
    let _sound = listen.stdin.take();
    wait_for("the end of listening", 20.0, || listen.try_wait().unwrap());
    let ended = listen.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    let why = "error: speech is held by the operator; help: whichone release speech\n";
    assert_eq!(String::from_utf8_lossy(&ended.stderr), why);
    group.must(&["release", "speech"]);
    group.down();
}

#[test]
fn restart_limit_holds_a_failing_service_alone() {
    let group = Group::up(&["group.restart.exits_max=3", "group.restart.backoff_first_ms=10"]);
    wait_for("the arm to be given up", 20.0, || {
        let row = group.service("arm");
        if row["actual"] == "held" {
            return Some(());
        }
        // It may be dead already, and be given up between two looks.
        if let Some(pid) = row["pid"].as_i64().filter(|_| row["actual"] == "ready") {
            let _ = kill_process(Pid::from_raw(pid as i32).unwrap(), Signal::KILL);
        }
        None
    });
    assert_eq!(group.service("policy")["actual"], "ready");
    group.must(&["start", "arm"]);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn damaged_shared_memory_is_an_error_and_then_renewed() {
    let group = Group::up(&[]);
    let before = group.incarnation("speech");
    let of_group = shm_cleanup::leftovers(group.paths());
    let management = of_group.iter().find(|path| path.to_string_lossy().ends_with("global_mgmt"));
    File::create(management.expect("iceoryx2's bookkeeping")).unwrap();
    // Its timeout is what shows that it does not hang.
    let ended = group.call(&["say", "the clear bowl"]);
    assert!(ended.code == Some(0) || ended.stderr.contains("help:"), "{ended:?}");
    wait_for("the group to start again", 30.0, || {
        (group.incarnation("speech") > before && group.call(&["status"]).code == Some(0))
            .then_some(())
    });
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn logs_of_supervisor_and_services_are_json_where_that_is_configured() {
    let group = Group::up(&["group.log.format=json"]);
    group.must(&["restart", "grounding"]);
    for service in ["supervisor", "grounding"] {
        let log = group.wait_for_log(service, "\n");
        // The last line may be half written.
        let (whole, _) = log.rsplit_once('\n').expect("there is a line");
        let lines: Vec<serde_json::Value> =
            whole.lines().map(|line| serde_json::from_str(line).expect(line)).collect();
        for line in &lines {
            assert!(line["fields"]["message"].is_string() && line["level"].is_string(), "{line}");
            assert!(line["timestamp"].is_string() && line["target"].is_string(), "{line}");
        }
    }
    group.down();
}
