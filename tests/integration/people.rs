//! People who give their name: what is learned about them, and how it is forgotten.

use serde_json::Value;
use whichone_tests::{Group, wait_for};

/// Has an object fetched for a person.
fn fetch_for(group: &Group, name: &str, request: &str, object: &str) {
    group.must(&["say", "--from", name, request]);
    assert_eq!(group.await_pick(Some(object))["object"], object);
}

fn known(group: &Group) -> Vec<(String, u64)> {
    let listed = group.must(&["people", "list", "--json"]).json();
    assert_eq!(listed["schema"], 1);
    let people = listed["people"].as_array().expect("a list");
    let one = |person: &Value| {
        (person["name"].as_str().unwrap().to_owned(), person["deliveries"].as_u64().unwrap())
    };
    people.iter().map(one).collect()
}

/// Whether a file of the policy's journals has the word.
fn is_in_journals(group: &Group, word: &str) -> bool {
    let folder = group.paths().journal_file("policy");
    let files = std::fs::read_dir(folder.parent().unwrap()).unwrap().flatten();
    let of_policy = files.filter(|it| it.file_name().to_string_lossy().starts_with("policy."));
    of_policy
        .filter_map(|it| std::fs::read(it.path()).ok())
        .any(|bytes| bytes.windows(word.len()).any(|window| window == word.as_bytes()))
}

#[test]
fn people_are_known_by_their_deliveries_and_forgotten_by_order() {
    let group = Group::up(&[]);
    assert!(known(&group).is_empty());
    let refused = group.call(&["say", "--from", &"n".repeat(65), "the clear bowl"]);
    assert_eq!(refused.code, Some(64), "{refused:?}");
    assert!(refused.stderr.contains("at most 64 bytes"), "{refused:?}");

    fetch_for(&group, "Annika", "get me the bowl", "white2");
    fetch_for(&group, "guest", "get me the bowl", "metal");
    fetch_for(&group, "Bernd", "the clear bowl", "clear");
    let both = [("Annika".to_owned(), 1), ("Bernd".to_owned(), 1)];
    wait_for("both are known", 10.0, || (known(&group) == both).then_some(()));
    let listed = group.must(&["people"]).stdout;
    assert!(listed.contains("Annika  1 delivery"), "{listed}");
    let exported = group.must(&["people", "export", "Annika"]).stdout;
    let exported: Value = serde_json::from_str(&exported).unwrap();
    assert_eq!(exported[0]["fetched"]["white2"], 1, "{exported}");

    let unknown = group.must(&["people", "forget", "Zoe"]);
    assert!(unknown.stderr.contains("nothing was learned about Zoe"), "{unknown:?}");
    assert!(is_in_journals(&group, "Annika"));
    group.must(&["people", "forget", "Annika"]);
    wait_for("no journal of the policy has the name", 10.0, || {
        (!is_in_journals(&group, "Annika")).then_some(())
    });
    let bernd = [("Bernd".to_owned(), 1)];
    assert_eq!(known(&group), bernd);

    let before = group.incarnation("policy");
    group.must(&["restart", "policy"]);
    group.wait_for_restart("policy", before);
    assert_eq!(known(&group), bernd);
    group.verify_journals();
    fetch_for(&group, "Annika", "the clear bowl", "clear");
    wait_for("who comes back is new", 10.0, || {
        (known(&group).last() == Some(&("Annika".to_owned(), 1))).then_some(())
    });
    group.down();
}
