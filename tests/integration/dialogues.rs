//! Ambiguous requests end with the right object.

use whichone_tests::{Group, UR5E, number};

const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];

fn assert_delivered(outcome: &serde_json::Value, object: &str, questions_max: u64) {
    assert_eq!(outcome["outcome"], "delivered", "{outcome}");
    assert_eq!(outcome["object"], object, "{outcome}");
    assert!(outcome["questions"].as_u64().unwrap() <= questions_max, "{outcome}");
}

/// `rounds` dialogues over all six bowls, starting from no information.
fn fetch_all(group: &Group, rounds: usize, questions_max: u64) {
    for bowl in BOWLS.iter().cycle().take(rounds) {
        assert_delivered(&group.fetch("get me the bowl", bowl), bowl, questions_max);
    }
}

/// WHICHONE_DIALOGUES asks for more.
#[test]
fn remote_mode_delivers_in_many_dialogues() {
    let group = Group::up(&["dialogue.open_questions=false"]);
    fetch_all(&group, number("WHICHONE_DIALOGUES").unwrap_or(24) as usize, 3);
    group.verify_journals();
    group.down();
}

#[test]
fn every_kind_of_question_delivers_every_bowl() {
    let pointing = ["dialogue.planner=no-attribute", "dialogue.mode=present"];
    let measured = [&pointing[..], &["dialogue.costs.from=robot"]].concat();
    let open = ["dialogue.open_questions=true"];
    for (settings, questions_max) in [(&pointing[..], 5), (&measured, 5), (&open, 3)] {
        let group = Group::up(settings);
        fetch_all(&group, 6, questions_max);
        group.verify_journals();
        group.down();
    }
}

/// Questions cost the seconds of this robot's voice and arm: the promises are the same, and a policy
/// that is restarted keeps the costs that it had.
#[test]
fn measured_costs_deliver_every_bowl() {
    let own = ["dialogue.costs.from=robot", "dialogue.mode=present", "dialogue.planner=optimal"];
    let group = Group::up(&own);
    fetch_all(&group, 3, 3);
    let before = group.incarnation("policy");
    group.must(&["restart", "policy"]);
    group.wait_for_restart("policy", before);
    fetch_all(&group, 6, 3);
    group.verify_journals();
    group.down();
}

#[test]
fn only_ambiguous_requests_are_clarified() {
    let group = Group::up(&[]);
    let outcome = group.fetch("the small white plastic bowl from the dishwasher", "white");
    assert_delivered(&outcome, "white", 1);
    group.say("get me the small white bowl");
    let asked = group.wait_for_decision("ask")["text"].as_str().unwrap().to_owned();
    // Two bowls are small and white, and only their places differ.
    assert!(asked.contains("counter") || asked.contains("dishwasher"), "{asked}");
    assert_delivered(&group.await_pick(Some("white2")), "white2", 3);
    group.down();
}

#[test]
fn other_scenes_are_fetched() {
    for (scene, request, objects, questions_max) in [
        ("markers", "hand me the marker", &["red", "blue"][..], 2),
        ("tools", "I need a tool", &["m_red", "p_black", "w_red"], 6),
    ] {
        let group = Group::up(&[&format!("group.scene={scene}")]);
        for object in objects {
            assert_delivered(&group.fetch(request, object), object, questions_max);
        }
        group.down();
    }
}

/// One arm of six joints: in the kinematic world, and behind the robot's topics.
#[test]
fn single_arm_delivers() {
    let group = Group::up(&UR5E);
    for block in ["red_small", "green_large", "yellow_small"] {
        assert_delivered(&group.fetch("get me a block", block), block, 6);
    }
    group.verify_journals();
    group.down();
    let robot = ["group.services.baxter.nice=0", "arm.driver=baxter", "arm.time_scale=1.0"];
    let group = Group::up(&[&UR5E[..], &robot].concat());
    assert_delivered(&group.fetch("the small blue block", "blue_small"), "blue_small", 2);
    group.verify_journals();
    group.down();
}

#[test]
fn paper_language_delivers() {
    let group = Group::up(&["dialogue.language=paper"]);
    assert_delivered(&group.fetch("the white one", "white3"), "white3", 3);
    group.down();
}

/// Says the words, and returns the number of the question that follows, a later one than `before`.
pub(crate) fn asked_by_line(group: &Group, words: &str, before: u64) -> u64 {
    group.follow_from(
        "a question",
        20.0,
        || group.say(words),
        |state| {
            let dialogue = &state["dialogue"];
            let prompt = dialogue["prompt"].as_u64().filter(|prompt| *prompt > before)?;
            (dialogue["expects_answer"] == true).then_some(prompt)
        },
    )
}

/// Returns the words that were accepted last, and the lines that they may answer.
pub(crate) fn last_heard(group: &Group) -> (String, Vec<u64>) {
    let journal = group.must(&["journal", "speech", "--json"]).stdout;
    let records = journal.lines().map(|line| serde_json::from_str(line).unwrap());
    let records: Vec<serde_json::Value> = records.collect();
    let mut accepted = records.iter().filter(|line| line["record"]["type"] == "accepted");
    let last = &accepted.next_back().unwrap()["record"];
    let asked = last["asked"].as_array().unwrap().iter();
    let prompts = asked.map(|asked| asked["prompt"].as_u64().unwrap()).collect();
    (last["text"].as_str().unwrap().to_owned(), prompts)
}

#[test]
fn words_answer_the_line_that_the_command_line_names() {
    let group = Group::up(&[]);
    let first = asked_by_line(&group, "get me the bowl", 0);
    let second = asked_by_line(&group, "white", first);
    assert_eq!(group.status()["prompt"], second);
    let early = group.call(&["say", "--seen", "999", "no"]);
    assert_eq!(early.code, Some(64), "{early:?}");
    assert!(early.stderr.contains(&format!("a line that was said, up to {second}")), "{early:?}");
    group.must(&["say", "--seen", &first.to_string(), "yes"]);
    assert_eq!(last_heard(&group), ("yes".to_owned(), vec![first]));
    let waited = group.call(&["await", "pick", "--timeout", "0.5", "--json"]).json();
    assert!(waited["prompt"].as_u64() >= Some(second), "{waited}");
    group.down();
}
