//! Every planner drives the real group.

use rustix::process::Signal;
use whichone_tests::Group;

#[test]
fn every_planner_that_asks_finds_the_right_object() {
    for planner in dialogue::registry::names().into_iter().filter(|name| *name != "never-ask") {
        let planner_is = format!("dialogue.planner={planner}");
        let group = Group::up(&[&planner_is, "dialogue.mode=present"]);
        for object in ["metal2", "white"] {
            let outcome = group.fetch("get me the bowl", object);
            assert_eq!(outcome["outcome"], "delivered", "{planner}: {outcome}\n{}", group.logs());
            assert_eq!(outcome["object"], object, "{planner}: {outcome}");
        }
        // The check decides everything anew, without what the service has kept.
        group.verify_journals();
        group.down();
    }
}

#[test]
fn what_the_optimal_planner_worked_out_outlives_its_process() {
    let group = Group::up(&["dialogue.planner=optimal"]);
    let kept = || -> Vec<_> {
        let files = std::fs::read_dir(group.paths().policies()).unwrap().flatten();
        files.map(|file| (file.path(), std::fs::read(file.path()).unwrap())).collect()
    };
    let before = kept();
    assert_eq!(before.len(), 1, "one problem, one file");
    group.say("get me the bowl");
    let asked = group.wait_for_decision("ask");
    let incarnation = group.incarnation("policy");
    group.signal("policy", Signal::KILL);
    group.wait_for_restart("policy", incarnation);
    assert_eq!(group.wait_for_decision("ask")["text"], asked["text"]);
    let outcome = group.await_pick(Some("clear"));
    assert_eq!(outcome["object"], "clear", "{outcome}\n{}", group.logs());
    assert_eq!(kept(), before);
    group.verify_journals();
    group.down();
}

#[test]
fn a_planner_that_does_not_exist_is_refused_with_those_that_do() {
    let mut group = Group::new();
    let ended = group.start(&["dialogue.planner=oracle"]);
    assert_eq!(ended.code, Some(78), "{ended:?}");
    for name in dialogue::registry::names() {
        assert!(ended.stderr.contains(name), "{name}: {ended:?}");
    }
}
