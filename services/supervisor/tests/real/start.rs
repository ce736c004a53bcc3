use rustix::process::Signal;
use serde_json::json;
use service::control::{RefusalKind, Request};
use service::status::GroupState;
use service::status::{Actual, Wanted};

use crate::harness::{Group, fixture, service, wait_for, with};

#[test]
fn services_start_in_order_and_status_lists_them() {
    let group = Group::ready(vec![
        with(service("speech", &[]), "after", json!(["policy"])),
        with(service("policy", &[]), "after", json!(["arm"])),
        with(service("arm", &[]), "watchdog_ms", json!(5000)),
    ]);
    assert_eq!(group.events(), ["arm 1 ready", "policy 1 ready", "speech 1 ready"]);
    let beaten =
        wait_for("a beat", || Some(group.service("arm")).filter(|s| s.beat_age_ms.is_some()));
    assert_eq!((beaten.wanted, beaten.actual, beaten.incarnation), (Wanted::Up, Actual::Ready, 1));
    assert_eq!(beaten.version.as_deref(), Some("fixture"));
    assert_eq!(beaten.says.as_deref(), Some("all well"));
    assert!(beaten.input_age_ms.is_some_and(|age| age >= 7));
    assert!(beaten.rss_kib.is_some_and(|kib| kib > 100));
    assert_eq!((beaten.restarts, beaten.last_exit), (0, None));
    let status = group.status();
    assert_eq!(status.state, GroupState::Ready);
    assert_eq!(status.supervisor_pid, group.supervisor_pid());
    assert_eq!(status.scene, "bowls");
}

#[test]
fn services_receive_their_identity_and_have_their_own_process_group() {
    let group = Group::ready(vec![with(service("arm", &[]), "watchdog_ms", json!(5000))]);
    let pid = group.pid("arm");
    let environment = std::fs::read(format!("/proc/{pid}/environ")).unwrap();
    let has = |variable: String| {
        let found = environment.split(|&byte| byte == 0).any(|v| v == variable.as_bytes());
        assert!(found, "{variable}");
    };
    has("WHICHONE_GROUP=lab".into());
    has("WHICHONE_SERVICE=arm".into());
    has("WHICHONE_INCARNATION=1".into());
    has(format!("WHICHONE_EPOCH={}", group.status().epoch));
    has(format!("NOTIFY_SOCKET={}", group.paths.notify_socket("arm", 1).display()));
    has("WATCHDOG_USEC=5000000".into());
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    let fields: Vec<&str> = stat.rsplit_once(") ").unwrap().1.split(' ').collect();
    assert_eq!(fields[2], pid.to_string(), "process group");
    let limits = std::fs::read_to_string(format!("/proc/{pid}/limits")).unwrap();
    let core = limits.lines().find(|line| line.starts_with("Max core file size")).unwrap();
    assert!(core.contains(" 0 "), "{core}");
}

#[test]
fn service_that_is_never_ready_delays_dependents_and_is_restarted() {
    let group = Group::start(vec![
        with(service("arm", &["never-ready"]), "start_ms", json!(200)),
        with(service("policy", &[]), "after", json!(["arm"])),
    ]);
    let again =
        wait_for("a second start", || Some(group.service("arm")).filter(|s| s.incarnation > 1));
    assert_eq!(again.last_exit.unwrap().text, "signal TERM, was not ready in time");
    let waiting = group.service("policy");
    assert_eq!((waiting.wanted, waiting.actual), (Wanted::Up, Actual::Down));
    assert_eq!(waiting.why.as_deref(), Some("waits for arm"));
    let late = group.refused(&Request::WaitReady { wait_ms: 1 });
    assert_eq!(late.kind, RefusalKind::NotReached);
    assert!(late.message.contains("policy waits for arm"), "{}", late.message);
}

#[test]
fn groups_of_different_homes_do_not_meet() {
    let one = Group::ready(vec![service("arm", &[])]);
    let mut two = Group::ready(vec![service("arm", &[])]);
    two.ask(&Request::Down);
    two.wait_end();
    two.check_nothing_left();
    assert_eq!(one.service("arm").actual, Actual::Ready);
}

#[test]
fn invalid_configuration_ends_the_supervisor_before_any_start() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    group.ask(&Request::Down);
    group.wait_end();
    group.describe(&json!({ "servces": [] }));
    assert_eq!(group.command().status().unwrap().code(), Some(78));
    group.wait_for_log("servces");
    let lonely = with(service("arm", &[]), "after", json!(["leg"]));
    group.describe(&json!({ "services": [lonely] }));
    assert_eq!(group.command().status().unwrap().code(), Some(78));
    group.wait_for_log("arm comes after leg");
    group.check_nothing_left();
}

#[test]
fn without_room_in_shared_memory_nothing_starts_and_nothing_is_left() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    group.ask(&Request::Down);
    group.wait_end();
    let services = [service("arm", &[])];
    group.describe(&json!({ "services": services, "shared_memory_free_min_mib": 1u64 << 40 }));
    assert_eq!(group.command().status().unwrap().code(), Some(1));
    group.wait_for_log("MiB are needed");
    group.check_nothing_left();
}

#[test]
fn services_inherit_what_ties_them_to_the_supervisor_and_nothing_else() {
    let waits = json!({ "name": "arm", "command": ["sleep", "1000"] });
    let group = Group::start(vec![waits]);
    let pid = wait_for("a process", || group.service("arm").pid);
    let inherited = || {
        let folder = std::fs::read_dir(format!("/proc/{pid}/fd")).ok()?.flatten();
        let targets = folder.filter_map(|fd| std::fs::read_link(fd.path()).ok());
        let mut names: Vec<String> = targets.map(|to| to.display().to_string()).collect();
        names.sort();
        // Its libraries are open only while they are loaded.
        (names.len() <= 5).then_some(names)
    };
    let names = wait_for("five descriptors", inherited);
    let log = group.paths.log_file("arm").display().to_string();
    let lock = group.paths.alive_lock().display().to_string();
    let [null, a, b, c, pipe] = &names[..] else { panic!("{names:?}") };
    assert_eq!(null, "/dev/null");
    assert_eq!([a, b, c], [&lock, &log, &log]);
    assert!(pipe.starts_with("pipe:"));
}

#[test]
fn supervisor_notifies_an_init_system() {
    let home = tempfile::tempdir().unwrap();
    let socket = std::os::unix::net::UnixDatagram::bind(home.path().join("n")).unwrap();
    socket.set_read_timeout(Some(crate::harness::PATIENCE)).unwrap();
    let mut group = Group::ready(vec![service("arm", &[])]);
    group.ask(&Request::Down);
    group.wait_end();
    let mut supervisor =
        group.command().env("NOTIFY_SOCKET", home.path().join("n")).spawn().unwrap();
    let hear = || {
        let mut bytes = [0; 256];
        let count = socket.recv(&mut bytes).unwrap();
        String::from_utf8_lossy(&bytes[..count]).into_owned()
    };
    while hear() != "READY=1" {}
    crate::harness::send(supervisor.id(), Signal::TERM);
    while hear() != "STOPPING=1" {}
    assert_eq!(supervisor.wait().unwrap().code(), Some(0));
}

#[test]
fn supervisor_program_prints_help() {
    let program = fixture("fixture_group");
    let run = |words: &[&str]| std::process::Command::new(&program).args(words).output().unwrap();
    let help = run(&["--help"]);
    assert!(help.status.success());
    assert!(String::from_utf8_lossy(&help.stdout).contains("--group"));
    assert_eq!(run(&["--groop"]).status.code(), Some(64));
    assert_eq!(run(&["--group", "No Name"]).status.code(), Some(64));
    assert!(fixture("fixture_service").exists());
}
