//! Replacement of a running service.

use whichone_tests::{Group, program};

pub(crate) fn swap(group: &Group, service: &str, command: &[&str]) -> whichone_tests::Ended {
    let mut words = vec!["swap", service, "--"];
    words.extend(command);
    group.call(&words)
}

#[test]
fn grounding_is_swapped_during_dialogues() {
    let group = Group::up(&[]);
    let grounding = program("whichone-grounding").display().to_string();
    for round in 0..6 {
        group.say("get me the bowl");
        let language = if round % 2 == 0 { "paper" } else { "careful" };
        let talk = std::thread::scope(|scope| {
            let talk = scope.spawn(|| group.await_pick(Some("metal2")));
            let ended = swap(&group, "grounding", &[&grounding, "--language", language]);
            assert_eq!(ended.code, Some(0), "{ended:?}");
            talk.join().expect("the dialogue")
        });
        assert_eq!(talk["object"], "metal2", "round {round}: {talk}");
    }
    group.verify_journals();
    group.down();
}

#[test]
fn planner_is_swapped_and_its_decisions_verify() {
    let group = Group::up(&[]);
    let policy = program("whichone-policy").display().to_string();
    for planner in ["never-ask", "entropy"] {
        let ended = swap(&group, "policy", &[&policy, "--planner", planner]);
        assert_eq!(ended.code, Some(0), "{ended:?}");
        assert_eq!(group.dialogue()["planner"], planner);
        assert_eq!(group.fetch("the big metal bowl", "metal2")["object"], "metal2");
        group.verify_journals();
    }
    group.must(&["restart", "policy", "--original"]);
    assert_eq!(group.dialogue()["planner"], "lookahead");
    group.down();
}

#[test]
fn swap_rolls_back_if_the_new_service_is_not_ready() {
    let group = Group::up(&["group.services.grounding.start_deadline_s=1.0"]);
    let grounding = program("whichone-grounding").display().to_string();
    for command in [
        &["/bin/sleep", "60"][..],
        &["/bin/false"],
        &["/no/such/program"],
        &[&grounding, "--language", "klingon"],
    ] {
        let ended = swap(&group, "grounding", command);
        assert_ne!(ended.code, Some(0), "{command:?}");
        assert!(!ended.stderr.is_empty(), "it says why");
        assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear", "{command:?}");
    }
    group.down();
}
