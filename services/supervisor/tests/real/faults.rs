use std::fs::File;
use std::io::Write;
use std::process::Stdio;
use std::time::{Duration, Instant};

use rustix::process::Signal;
use serde_json::json;
use service::control::{RefusalKind, Request, Target};
use service::exit::ProcessExit;
use service::status::{GroupState, ServiceState};
use supervisor::machine::{Actual, Failure};

use crate::harness::{Group, WAIT_MS, fixture, send, service, wait_for, with};

#[test]
fn service_that_rejects_its_configuration_is_held() {
    let group = Group::start(vec![service("arm", &["exits", "78"]), service("policy", &[])]);
    let held = group.until("arm", Actual::Held);
    assert_eq!(held.incarnation, 1);
    assert_eq!(held.why.as_deref(), Some("exit 78 (configuration or schema refused)"));
    group.until("policy", Actual::Ready);
    assert_eq!(group.status().state, GroupState::Degraded);
    let refused = group.refused(&Request::WaitReady { wait_ms: WAIT_MS });
    assert_eq!(refused.kind, RefusalKind::NotReached);
    assert!(refused.message.starts_with("arm has failed"), "{}", refused.message);
}

#[test]
fn crash_loop_backs_off_and_is_held_with_the_log() {
    let begun = Instant::now();
    let shell = json!({ "name": "arm", "command": ["sh", "-c", "echo so it goes >&2; exit 3"] });
    let group = Group::start(vec![shell, service("policy", &[])]);
    let held = group.until("arm", Actual::Held);
    assert_eq!(held.incarnation, 5);
    assert_eq!(held.why.as_deref(), Some("5 exits in a short time"));
    assert_eq!(held.last_exit.unwrap().exit, ProcessExit::Code(3));
    assert_eq!(held.log_tail, ["so it goes"]);
    let pauses = Duration::from_millis(100 + 200 + 400 + 800);
    assert!(begun.elapsed() >= pauses, "{:?}", begun.elapsed());
    group.until("policy", Actual::Ready);
    group.done(&Request::Release(Target::new("arm", 0)));
    wait_for("a sixth start", || Some(group.service("arm")).filter(|s| s.incarnation > 5));
}

#[test]
fn shortage_is_waited_out_without_limit_and_without_a_person() {
    let home = tempfile::tempdir().unwrap();
    let room = home.path().join("room");
    let script = format!(
        "[ -e {0} ] || {{ echo disk full >&2; exit 74; }}; exec {1}",
        room.display(),
        fixture("fixture_service").display()
    );
    let short = json!({ "name": "arm", "command": ["sh", "-c", script] });
    let group = Group::start_with(json!({
        "services": [short, with(service("policy", &[]), "after", json!(["arm"]))],
        "exits_max": 3,
    }));
    let waiting = wait_for("a fifth start", || {
        Some(group.service("arm")).filter(|arm| arm.incarnation > 4 && arm.pid.is_none())
    });
    assert_eq!(waiting.state, ServiceState::Short);
    assert_eq!(waiting.log_tail.last().map(String::as_str), Some("disk full"));
    let why = waiting.why.unwrap();
    assert!(why.starts_with("waits for disk: ") && why.contains("KiB free in "), "{why}");
    let refused = group.refused(&Request::WaitReady { wait_ms: 100 });
    assert!(refused.message.contains("arm waits for disk: "), "{}", refused.message);
    assert!(refused.message.contains("policy waits for arm"), "{}", refused.message);
    std::fs::write(&room, "").unwrap();
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
}

#[test]
fn bus_error_and_a_reported_shortage_are_waits_and_a_hold_is_neither() {
    let bus = json!({ "name": "arm", "command": ["sh", "-c", "kill -BUS $$"] });
    let group = Group::start_with(json!({
        "services": [bus, service("policy", &["short-of", "room"]), service("speech", &[])],
        "exits_max": 2,
    }));
    let arm = wait_for("a fourth start", || {
        Some(group.service("arm")).filter(|arm| arm.incarnation > 3 && arm.pid.is_none())
    });
    assert_eq!(arm.state, ServiceState::Short);
    assert!(arm.why.unwrap().starts_with("waits for shared memory: "));
    group.until("policy", Actual::Backoff);
    let policy = group.service("policy");
    assert_eq!(policy.why.as_deref(), Some("waits for room"));
    group.done(&Request::Hold(Target::new("speech", WAIT_MS)));
    let held = group.service("speech");
    assert_eq!((held.state, held.log_tail.len()), (ServiceState::Held, 0));
    assert!(held.unavailable().unwrap().contains("held by the operator; help: whichone release"));
}

#[test]
fn service_without_heartbeats_is_aborted_and_restarted() {
    let group = Group::start(vec![with(service("arm", &["hangs"]), "watchdog_ms", json!(400))]);
    let again =
        wait_for("a second start", || Some(group.service("arm")).filter(|s| s.incarnation > 1));
    let last = again.last_exit.unwrap();
    assert_eq!(last.failure, Some(Failure::NoBeat));
    assert_eq!(last.exit, ProcessExit::Signal(6), "it leaves a trace of where it hung");
}

#[test]
fn held_critical_service_stops_the_group() {
    let mut group = Group::start(vec![
        with(service("arm", &["exits", "78"]), "critical", json!(true)),
        service("policy", &[]),
    ]);
    assert_eq!(group.wait_end().code(), Some(78));
    group.check_nothing_left();
}

#[test]
fn missing_program_is_held_with_the_reason() {
    let missing = json!({ "name": "arm", "command": ["/no/such/arm"] });
    let group = Group::start(vec![missing, service("policy", &[])]);
    let held = group.until("arm", Actual::Held);
    assert_eq!(held.last_exit.unwrap().text, "/no/such/arm: no such program");
    group.until("policy", Actual::Ready);
}

#[test]
fn flooded_log_is_bounded_and_blocks_no_service() {
    let bytes_max = 1 << 20;
    let group = Group::start_with(json!({
        "services": [service("arm", &["floods"]), service("policy", &[])],
        "log_bytes_max": bytes_max,
    }));
    let log = group.paths.log_file("arm");
    let aside = log.with_extension("log.1");
    let kept = wait_for("the log to be cut", || aside.metadata().ok().map(|meta| meta.len()));
    assert!(kept <= bytes_max, "{kept}");
    group.until("policy", Actual::Ready);
    group.done(&Request::Stop(Target::new("arm", WAIT_MS)));
}

/// The life of a group whose supervisor logs to `stderr`.
fn check_life_with_log(stderr: impl Into<Stdio>) {
    let mut group = Group::ready(vec![service("arm", &[])]);
    group.ask(&Request::Down);
    group.wait_end();
    let mut command = group.command();
    command.stderr(stderr);
    group.run_as(command);
    group.until_ready("arm", 1);
    send(group.pid("arm"), Signal::KILL);
    group.until_ready("arm", 2);
    group.ask(&Request::Down);
    assert_eq!(group.wait_end().code(), Some(0));
    group.check_nothing_left();
}

#[test]
fn full_log_disk_does_not_end_the_supervisor() {
    check_life_with_log(File::options().write(true).open("/dev/full").unwrap());
}

#[test]
fn log_pipe_that_nobody_reads_does_not_delay_the_supervisor() {
    let (reader, writer) = std::io::pipe().unwrap();
    rustix::io::ioctl_fionbio(&writer, true).unwrap();
    while (&writer).write(&[b'x'; 4096]).is_ok() {}
    rustix::io::ioctl_fionbio(&writer, false).unwrap();
    check_life_with_log(writer);
    drop(reader);
}

#[test]
fn service_without_a_place_for_its_log_is_started_nevertheless() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    group.ask(&Request::Down);
    group.wait_end();
    let log = group.paths.log_file("arm");
    std::fs::remove_file(&log).unwrap();
    std::fs::create_dir(&log).unwrap();
    group.run();
    group.until_ready("arm", 1);
    group.wait_for_log("it runs without a log");
}

#[test]
fn suspension_of_the_machine_counts_against_no_service() {
    let watched = |name| with(service(name, &[]), "watchdog_ms", json!(2000));
    let group = Group::ready(vec![watched("arm"), watched("policy")]);
    let (arm, supervisor) = (group.pid("arm"), group.supervisor_pid());
    // The policy keeps beating into a full queue; the arm does not even beat.
    send(arm, Signal::STOP);
    send(supervisor, Signal::STOP);
    std::thread::sleep(Duration::from_secs(3));
    send(supervisor, Signal::CONT);
    group.wait_for_log("time stood still");
    send(arm, Signal::CONT);
    let status = group.status();
    assert_eq!(status.state, GroupState::Ready);
    assert!(status.services.iter().all(|service| service.incarnation == 1));
}

#[test]
fn files_removed_by_hand_restart_the_group_once() {
    let group = Group::ready(vec![service("arm", &[]), service("policy", &[])]);
    std::fs::remove_dir_all(group.paths.run()).unwrap();
    wait_for("the group to be recreated", || {
        group.call(&Request::WaitReady { wait_ms: WAIT_MS }).ok()
    });
    for name in ["arm", "policy"] {
        group.until_ready(name, 2);
    }
    group.wait_for_log("files of the running group are gone");
}
