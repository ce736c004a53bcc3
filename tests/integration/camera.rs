//! Objects that the camera of the simulated Baxter sees, while a person puts and takes some of them.

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Group, wait_for};

const ROBOT: &[&str] = &[
    "group.perception.enabled=true",
    "group.services.baxter.nice=0",
    "arm.driver=baxter",
    "arm.time_scale=1.0",
    "arm.restock=false",
];
const CAMERA: &str = "arm.simulated.camera.enabled=true";
/// Places in which no other bowl stands, as words.
const FREE: [[&str; 2]; 2] = [["0.58", "-0.38"], ["0.58", "0.36"]];

/// The objects on the table, without those that a person has. A policy that starts again may not know them yet.
fn table(group: &Group) -> Vec<Value> {
    let table = wait_for("the objects", 20.0, || {
        Some(group.call(&["objects", "--json"])).filter(|ended| ended.code == Some(0))
    });
    let table = table.json();
    let objects = table["objects"].as_array().unwrap().iter();
    objects.filter(|object| object["taken"] == false && object["gone"] == false).cloned().collect()
}

fn names(objects: &[Value]) -> Vec<&str> {
    objects.iter().map(|object| object["name"].as_str().unwrap()).collect()
}

/// The objects that were recognised as `class`.
fn of<'a>(objects: &'a [Value], class: &str) -> Vec<&'a Value> {
    let is_of = |object: &&Value| object["classes"][class].as_f64().is_some_and(|p| p > 0.9);
    objects.iter().filter(is_of).collect()
}

/// Waits for the table on which there is exactly one object of that class, and returns it.
fn wait_for_one(group: &Group, class: &str, holds: impl Fn(&Value) -> bool) -> Value {
    wait_for(class, 20.0, || match of(&table(group), class)[..] {
        [only] => Some(only.clone()).filter(&holds),
        _ => None,
    })
}

fn is_at(object: &Value, place: [&str; 2]) -> bool {
    let off =
        |axis: usize| object["xyz"][axis].as_f64().unwrap() - place[axis].parse::<f64>().unwrap();
    off(0).hypot(off(1)) < 0.01
}

/// Kills services; they resume as they were.
fn kill(group: &Group, services: [&str; 2]) {
    for service in services {
        let before = group.incarnation(service);
        group.signal(service, Signal::KILL);
        group.wait_for_restart(service, before);
    }
}

fn assert_delivered(group: &Group, outcome: &Value, object: &Value) {
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    assert_eq!(outcome["object"], object["name"], "{outcome}");
    group.verify_journals();
}

#[test]
fn bowls_under_the_camera_are_fetched_from_where_people_put_them() {
    let group = Group::up(&[ROBOT, &[CAMERA]].concat());
    let first = wait_for("six bowls", 20.0, || Some(table(&group)).filter(|it| it.len() == 6));
    let mut numbers: Vec<u64> = first.iter().map(|it| it["number"].as_u64().unwrap()).collect();
    numbers.sort_unstable();
    assert_eq!(numbers, [6, 7, 8, 9, 10, 11], "above those of the scene file");

    // It is moved between the request and the pick, and known as what it was.
    let white = of(&first, "white")[0];
    group.say("get me the bowl");
    group.wait_for_decision("ask");
    group.drill(&["put", "white", FREE[0][0], FREE[0][1]]);
    let moved = wait_for_one(&group, "white", |it| is_at(it, FREE[0]));
    assert_eq!(moved["name"], white["name"], "{}", group.logs());
    kill(&group, ["policy", "baxter"]);
    let outcome = group.await_pick(moved["name"].as_str());
    assert_delivered(&group, &outcome, &moved);
    assert!(of(&table(&group), "white").is_empty(), "a person has it");

    // One vanishes, and comes as another one.
    let metal = of(&first, "metal")[0];
    group.say("get me the bowl");
    group.wait_for_decision("ask");
    group.drill(&["take", "metal"]);
    wait_for("it is gone", 20.0, || of(&table(&group), "metal").is_empty().then_some(()));
    group.drill(&["put", "metal", FREE[1][0], FREE[1][1]]);
    let added = wait_for_one(&group, "metal", |it| is_at(it, FREE[1]));
    assert!(added["number"].as_u64() > metal["number"].as_u64().max(Some(11)), "{added}");
    let before = table(&group);
    kill(&group, ["baxter", "policy"]);
    assert_eq!(names(&table(&group)), names(&before));
    let outcome = group.await_pick(added["name"].as_str());
    assert_delivered(&group, &outcome, &added);
    group.down();
}

/// The fingers close on what stands on the robot's table, wherever it is believed to be.
#[test]
fn object_that_is_not_where_it_was_reported_is_missed() {
    let group = Group::up(ROBOT);
    group.must(&["objects", "add", "clear", "--at", "0.70", "0.25", "-0.12"]);
    group.say("get me the clear bowl");
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "failed", "{outcome}\n{}", group.logs());
    group.down();
}
