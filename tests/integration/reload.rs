//! The scene is edited and reloaded while a question stands; the dialogue continues with the new
//! scene.

use crate::config::edited;
use std::path::Path;
use whichone_tests::Group;

/// The seventh bowl.
const WHITE4: &str = r#"
[[objects]]
name = "white4"
attributes = { color = "white", material = "plastic", size = "small", shape = "round", location = "cabinet" }
xyz = [0.60, 0.40, 0.125]
size = [0.12, 0.12, 0.05]
grasp_width = 0.006
form = "hollow"
"#;

/// Takes the objects of these names out of the scene file, and puts `more` behind the others.
fn edit(config: &Path, gone: &[&str], more: &str) {
    let path = config.join("scenes/bowls.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let mut parts = text.split("[[objects]]");
    let head = parts.next().unwrap().to_owned();
    let named = |part: &str, name: &&str| part.contains(&format!("name = \"{name}\"\n"));
    let kept: Vec<&str> = parts.filter(|part| !gone.iter().any(|name| named(part, name))).collect();
    let objects: String = kept.iter().map(|part| format!("[[objects]]{part}")).collect();
    std::fs::write(&path, format!("{head}{objects}\n{more}")).unwrap();
}

/// A group on a copy of the shipped configuration that may be edited.
fn group() -> (Group, tempfile::TempDir) {
    let folder = edited("dialogue.toml", |text| format!("{text}\n"));
    let mut group = Group::with_config(folder.path().to_owned());
    let ended = group.start(&[]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    (group, folder)
}

fn reload(group: &Group) {
    let before = group.incarnation("policy");
    group.must(&["reload"]);
    group.wait_for_restart("policy", before);
}

#[test]
fn reload_replaces_an_object_within_the_interaction() {
    let (group, folder) = group();
    group.say("get me the small white bowl");
    let before = group.wait_for_decision("ask");
    edit(folder.path(), &["white"], WHITE4);
    reload(&group);
    let after = group.wait_for_decision("ask");
    assert_eq!(after["interaction"], before["interaction"], "the interaction continues: {after}");
    assert!(after["belief"]["white"].is_null(), "{after}");
    let p = |name: &str| after["belief"][name].as_f64().unwrap();
    assert!((p("white4") - p("white2")).abs() < 1e-9, "it counts with what was said: {after}");
    assert!(p("white4") > 3.0 * p("metal2"), "{after}");
    let text = after["text"].as_str().unwrap();
    assert!(text.contains("is gone") && text.contains("is new"), "{text}");
    let outcome = group.await_pick(Some("white4"));
    assert_eq!((&outcome["object"], &outcome["outcome"]), (&"white4".into(), &"delivered".into()));
    group.verify_journals();
    // And back again, with nothing open: the next dialogue is about the shipped bowls.
    edit(folder.path(), &["white4"], "");
    reload(&group);
    assert_eq!(group.fetch("get me the bowl", "metal2")["object"], "metal2");
    group.verify_journals();
    group.down();
}

#[test]
fn reload_keeps_the_answers_of_a_simulated_user() {
    let (group, folder) = group();
    group.say("get me the bowl");
    group.wait_for_decision("ask");
    std::thread::scope(|scope| {
        // `white2` is object 1 before and object 0 after.
        let person = scope.spawn(|| group.await_pick(Some("white2")));
        edit(folder.path(), &["white", "metal"], WHITE4);
        group.must(&["reload"]);
        let outcome = person.join().unwrap();
        assert_eq!(outcome["object"], "white2", "{outcome}\n{}", group.logs());
    });
    group.verify_journals();
    group.down();
}

#[test]
fn reload_of_a_disjoint_scene_ends_the_interaction() {
    let (group, folder) = group();
    group.say("get me the bowl");
    group.wait_for_decision("ask");
    let scene = folder.path().join("scenes/bowls.toml");
    std::fs::copy(folder.path().join("scenes/markers.toml"), scene).unwrap();
    reload(&group);
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "scene_changed", "{outcome}");
    assert_eq!(group.fetch("hand me the marker", "red")["object"], "red");
    group.verify_journals();
    group.down();
}

#[test]
fn reload_of_other_settings_keeps_the_question() {
    let (group, folder) = group();
    group.say("the white one");
    let before = group.wait_for_decision("ask");
    let path = folder.path().join("dialogue.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("epsilon = 0.01", "epsilon = 0.03")).unwrap();
    reload(&group);
    let after = group.wait_for_decision("ask");
    assert_eq!((&after["text"], &after["belief"]), (&before["text"], &before["belief"]));
    assert_eq!(group.await_pick(Some("white3"))["object"], "white3");
    group.verify_journals();
    group.down();
}
