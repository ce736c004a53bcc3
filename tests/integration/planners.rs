//! Planners in a real group.

use rustix::process::Signal;
use whichone_tests::Group;

#[test]
fn every_asking_planner_delivers_the_right_object() {
    for planner in dialogue::registry::names().into_iter().filter(|name| *name != "never-ask") {
        let planner_is = format!("dialogue.planner={planner}");
        let group = Group::up(&[&planner_is, "dialogue.mode=present"]);
        for object in ["metal2", "white"] {
            let outcome = group.fetch("get me the bowl", object);
            assert_eq!(outcome["outcome"], "delivered", "{planner}: {outcome}\n{}", group.logs());
            assert_eq!(outcome["object"], object, "{planner}: {outcome}");
        }
        // The check repeats every decision without the service's policy cache.
        group.verify_journals();
        group.down();
    }
}

#[test]
fn optimal_policy_cache_survives_a_restart() {
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
