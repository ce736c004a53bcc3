//! Groups are isolated from each other and leave nothing behind.

use rustix::process::{Pid, Signal, kill_process};
use whichone_tests::{Group, wait_for};

#[test]
fn two_groups_run_side_by_side() {
    let (one, two) = (Group::up(&[]), Group::up(&["group.scene=markers"]));
    let (bowl, marker) = std::thread::scope(|scope| {
        let bowl = scope.spawn(|| one.fetch("get me the bowl", "white3"));
        let marker = scope.spawn(|| two.fetch("get me the marker", "blue"));
        (bowl.join().expect("a dialogue"), marker.join().expect("a dialogue"))
    });
    assert_eq!((&bowl["object"], &marker["object"]), (&"white3".into(), &"blue".into()));
    one.down();
    assert_eq!(two.fetch("get me the marker", "red")["object"], "red", "the other group continues");
    two.down();
}

#[test]
fn a_running_group_is_not_started_twice() {
    let mut group = Group::up(&[]);
    let again = group.start(&[]);
    assert_eq!(again.code, Some(1), "{again:?}");
    assert!(again.stderr.contains("already"), "{}", again.stderr);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn killed_supervisor_leaves_no_processes() {
    let mut group = Group::up(&[]);
    let supervisor = group.status()["supervisor_pid"].as_i64().expect("its pid");
    let supervisor = Pid::from_raw(i32::try_from(supervisor).unwrap()).unwrap();
    kill_process(supervisor, Signal::KILL).unwrap();
    wait_for("the services to end by themselves", 20.0, || {
        group.processes().is_empty().then_some(())
    });
    // What it could not tidy up any more, the next one does.
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn verbs_without_a_group_suggest_up() {
    let group = Group::new();
    for words in [&["status"][..], &["say", "hello"], &["await", "pick"], &["restart", "arm"]] {
        let ended = group.call(words);
        assert_ne!(ended.code, Some(0), "{words:?}");
        let text = format!("{}{}", ended.stdout, ended.stderr);
        assert!(text.contains("whichone up") || text.contains("not running"), "{words:?}: {text}");
    }
}
