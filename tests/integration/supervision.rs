//! What an operator does, and what the supervisor does by itself.

use rustix::process::Signal;
use whichone_tests::{Group, wait_for};

#[test]
fn status_shows_what_an_operator_needs() {
    let group = Group::up(&[]);
    for service in ["speech", "grounding", "policy", "arm"] {
        let row = group.service(service);
        assert_eq!(row["actual"], "ready", "{row}");
        for key in ["pid", "incarnation", "restarts", "uptime_s", "version", "rss_kib", "cpu_s"] {
            assert!(!row[key].is_null(), "{key} in {row}");
        }
    }
    assert_eq!(group.call(&["status"]).code, Some(0));
    group.down();
}

#[test]
fn a_killed_service_is_back_and_the_others_never_left() {
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
fn a_stopped_process_is_noticed_and_replaced() {
    let group = Group::up(&["group.services.grounding.watchdog_s=1.0"]);
    let before = group.incarnation("grounding");
    group.signal("grounding", Signal::STOP);
    group.wait_for_restart("grounding", before);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn hold_keeps_a_service_down_until_it_is_released() {
    let group = Group::up(&[]);
    group.must(&["hold", "speech"]);
    wait_for("the hold", 10.0, || (group.service("speech")["actual"] == "held").then_some(()));
    assert_eq!(group.call(&["status"]).code, Some(1), "not everything is ready");
    group.must(&["release", "speech"]);
    wait_for("the release", 10.0, || (group.service("speech")["actual"] == "ready").then_some(()));
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn a_service_that_keeps_dying_is_given_up_and_the_rest_stays() {
    let group = Group::up(&["group.restart.exits_max=3", "group.restart.backoff_first_ms=10"]);
    wait_for("the arm to be given up", 20.0, || {
        let row = group.service("arm");
        if row["actual"] == "held" {
            return Some(());
        }
        if row["actual"] == "ready" {
            group.signal("arm", Signal::KILL);
        }
        None
    });
    assert_eq!(group.service("policy")["actual"], "ready");
    group.must(&["start", "arm"]);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn logs_are_there_to_be_read() {
    let group = Group::up(&[]);
    let ended = group.must(&["logs", "policy", "--tail", "5"]);
    assert!(ended.stdout.contains("ready"), "{}", ended.stdout);
    group.down();
}

#[test]
fn an_unknown_service_is_named_with_the_known_ones() {
    let group = Group::up(&[]);
    let ended = group.call(&["restart", "legs"]);
    assert_ne!(ended.code, Some(0));
    assert!(ended.stderr.contains("legs") && ended.stderr.contains("arm"), "{}", ended.stderr);
    group.down();
}
