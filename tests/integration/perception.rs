//! Objects from perception, reported through the command line.

use rustix::process::Signal;
use serde_json::{Value, json};
use whichone_tests::{Group, run, wait_for};

/// A pick lasts long enough to be observed on a busy machine.
const PERCEPTION: &[&str] = &["group.perception.enabled=true", "arm.time_scale=5.0"];

/// Puts an object of the scene on the table. Returns its name.
fn add(group: &Group, class: &str, [x, y]: [&str; 2]) -> String {
    let added = group.must(&["objects", "add", class, "--at", x, y, "-0.12", "--json"]);
    added.json()["name"].as_str().unwrap().to_owned()
}

fn names(group: &Group) -> Vec<String> {
    let table = group.must(&["objects", "--json", "--timeout=30"]).json();
    let objects = table["objects"].as_array().unwrap();
    objects.iter().map(|object| object["name"].as_str().unwrap().to_owned()).collect()
}

fn assert_delivered(group: &Group, outcome: &Value, object: &str) {
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    assert_eq!(outcome["object"], object, "{outcome}");
    group.verify_journals();
}

#[test]
fn perceived_objects_appear_move_and_vanish_in_a_dialogue() {
    let group = Group::up(PERCEPTION);
    let white = add(&group, "white", ["0.7", "0.2"]);
    let metal = add(&group, "metal", ["0.7", "-0.2"]);
    group.say("get me the bowl");
    group.wait_for_decision("ask");
    let clear = add(&group, "clear", ["0.6", "0.4"]);
    let before = group.incarnation("policy");
    group.signal("policy", Signal::KILL);
    group.wait_for_restart("policy", before);
    assert_eq!(names(&group), [white.as_str(), &metal, &clear]);
    group.must(&["objects", "remove", &metal]);
    group.must(&["objects", "move", &clear, "--at", "0.65", "0.3", "-0.12"]);
    let outcome = group.await_pick(Some(&clear));
    assert_delivered(&group, &outcome, &clear);
    let before = group.incarnation("arm");
    let outcome = group.fetch_while("the white bowl", &white, || {
        group.signal("arm", Signal::KILL);
        group.wait_for_restart("arm", before);
    });
    assert_delivered(&group, &outcome, &white);
    group.must(&["down"]);
    // The journals of policy and arm agree on the objects' numbers.
    assert_eq!(group.start_again(PERCEPTION).code, Some(0), "{}", group.logs());
    group.down();
}

#[test]
fn answer_as_waits_until_something_is_on_the_table() {
    let group = Group::up(PERCEPTION);
    let none = group.call(&["await", "pick", "--answer-as", "white-6", "--timeout", "1"]);
    assert_eq!(none.code, Some(1), "{none:?}");
    assert!(none.stdout.starts_with("no object is known to be on the table within"), "{none:?}");
    let outcome = std::thread::scope(|scope| {
        let user = scope.spawn(|| group.await_pick(Some("white-6")));
        assert_eq!(add(&group, "white", ["0.7", "0.2"]), "white-6");
        add(&group, "metal", ["0.7", "-0.2"]);
        group.say("get me the bowl");
        user.join().unwrap()
    });
    assert_delivered(&group, &outcome, "white-6");
    let unknown = group.call(&["await", "pick", "--answer-as", "grey", "--timeout", "50"]);
    assert_eq!(unknown.code, Some(64), "{unknown:?}");
    assert!(unknown.stderr.contains("expected an object of the scene ("), "{unknown:?}");
    assert!(unknown.stderr.contains("metal-7"), "{unknown:?}");
    group.must(&["hold", "policy"]);
    wait_for("the hold", 10.0, || (group.service("policy")["actual"] == "held").then_some(()));
    for verb in [&["await", "pick", "--answer-as", "white-6"][..], &["objects"]] {
        let refused = group.call(verb);
        assert_eq!(refused.code, Some(1), "{refused:?}");
        let why = "error: policy is held by the operator; help: whichone release policy\n";
        assert_eq!(refused.stderr, why);
    }
    group.down();
}

#[test]
fn objects_of_a_feed_appear_after_a_few_looks() {
    let group = Group::up(PERCEPTION);
    let seen = json!({ "classes": { "white": 0.9, "metal": 0.1 }, "xyz": [0.7, 0.1, -0.12] });
    let look = json!({ "source": "camera", "seen": [seen] }).to_string();
    let feed = |lines: &str| run(&mut group.command(&["objects", "feed"]), lines, 10.0);
    wait_for("an object", 20.0, || {
        assert_eq!(feed(&look).code, Some(0));
        (!names(&group).is_empty()).then_some(())
    });
    let wrong = feed("{\"seen\": 3}\n");
    assert_eq!(wrong.code, Some(1), "{wrong:?}");
    let person = json!({ "classes": { "person": 0.9 }, "xyz": [1.0, 0.0, 0.0] });
    let refused = feed(&json!({ "seen": [person] }).to_string());
    assert_eq!(refused.code, Some(1), "{refused:?}");
    assert!(refused.stdout.contains("no object `person`"), "{refused:?}");
    assert_eq!(names(&group).len(), 1);
    group.down();
}
