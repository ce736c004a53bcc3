//! A journal is lost or damaged between two starts: the group refuses by name, setting it aside is the
//! way out, and afterwards nothing old counts and nothing is delivered that was not fetched.

use std::fs;

use whichone_tests::Group;

/// A group that has fetched the clear bowl and is down.
fn fetched_and_down() -> Group {
    let group = Group::up(&[]);
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    group.must(&["down"]);
    group
}

/// The start is refused at once, with the way out.
fn assert_refused(group: &mut Group, service: &str, why: &str) {
    let refused = group.start(&[]);
    assert_eq!(refused.code, Some(74), "{refused:?}");
    assert!(refused.stderr.contains(why), "{refused:?}");
    let help = format!("`whichone journal set-aside {service}`");
    assert!(refused.stderr.contains(&help), "{refused:?}");
    let verified = group.call(&["journal", "--verify"]);
    assert_eq!(verified.code, Some(74), "{verified:?}");
    assert!(verified.stderr.contains(why) && verified.stderr.contains(&help), "{verified:?}");
}

/// What the arm has delivered, as its journal tells.
fn deliveries(group: &Group) -> usize {
    let listing = group.must(&["journal", "arm"]).stdout;
    listing
        .lines()
        .filter(|line| line.contains("pick ended: ") && line.contains("delivered"))
        .count()
}

#[test]
fn journal_of_any_service_is_lost_and_set_aside() {
    for service in ["speech", "policy", "arm"] {
        let mut group = fetched_and_down();
        let file = group.paths().journal_file(service);
        fs::remove_file(&file).unwrap();
        assert_refused(&mut group, service, "the file is missing");

        group.must(&["journal", "set-aside", service]);
        let started = group.start(&[]);
        assert_eq!(started.code, Some(0), "{started:?}\n{}", group.logs());
        let before = if service == "arm" { 0 } else { deliveries(&group) };
        if service == "arm" {
            // It may have been stopped, or hold something.
            group.wait_shown(true);
            group.release_stop();
        }
        let outcome = group.fetch("get me the bowl", "metal2");
        assert_eq!(outcome["outcome"], "delivered", "{service}: {outcome}\n{}", group.logs());
        assert_eq!(outcome["object"], "metal2", "{service}: {outcome}");
        assert_eq!(deliveries(&group), before + 1, "the arm has moved");
        assert_eq!(group.arm()["object"], "metal2");
        group.verify_journals();
        group.down();
    }
}

#[test]
fn journal_lost_in_the_middle_of_a_dialogue_ends_it_without_replay() {
    for service in ["speech", "policy"] {
        let mut group = Group::up(&[]);
        group.say("get me the white bowl");
        group.wait_for_decision("ask");
        group.must(&["down"]);
        group.must(&["journal", "set-aside", service]);
        assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
        let dialogue = group.dialogue();
        assert_eq!(dialogue["interaction"], 0, "{service}: {dialogue}");
        if service == "speech" {
            let outcome = group.await_pick(None);
            assert_eq!(outcome["outcome"], "abandoned", "{outcome}");
        }
        let outcome = group.fetch("get me the bowl", "clear");
        assert_eq!(
            (&outcome["outcome"], &outcome["object"]),
            (&"delivered".into(), &"clear".into())
        );
        group.verify_journals();
        group.down();
    }
}

#[test]
fn journal_that_is_empty_or_damaged_is_refused_and_kept() {
    let mut group = fetched_and_down();
    let file = group.paths().journal_file("policy");
    let whole = fs::read(&file).unwrap();
    fs::write(&file, "").unwrap();
    assert_refused(&mut group, "policy", "the file is empty");
    let mut flipped = whole.clone();
    let in_the_last_record = whole.len() - 40;
    flipped[in_the_last_record] ^= 8;
    fs::write(&file, &flipped).unwrap();
    assert_refused(&mut group, "policy", "damaged at byte");

    let told = group.must(&["journal", "set-aside", "policy", "--json"]).json();
    let folder = told["folder"].as_str().expect("a folder");
    assert_eq!(fs::read(format!("{folder}/policy.journal")).unwrap(), flipped);
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    group.down();
}

#[test]
fn set_of_journals_that_is_lost_is_refused_until_a_fresh_start() {
    let mut group = fetched_and_down();
    fs::remove_file(group.paths().epoch_file()).unwrap();
    let why = "the file is missing beside journals";
    for refused in [group.start(&[]), group.call(&["journal", "--verify"])] {
        assert_eq!(refused.code, Some(74), "{refused:?}");
        assert!(refused.stderr.contains(why), "{refused:?}");
        assert!(refused.stderr.contains("`whichone up --fresh`"), "{refused:?}");
    }
    let fresh = group.start_fresh();
    assert_eq!(fresh.code, Some(0), "{fresh:?}\n{}", group.logs());
    group.verify_journals();
    group.down();
}

/// Delivers an object, copies the journals, delivers another one, and is down.
fn copied_between_deliveries() -> (Group, tempfile::TempDir) {
    let group = Group::up(&[]);
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    let copies = tempfile::tempdir().unwrap();
    for service in ["speech", "policy", "arm"] {
        fs::copy(group.paths().journal_file(service), copies.path().join(service)).unwrap();
    }
    assert_eq!(group.fetch("get me the bowl", "metal2")["object"], "metal2");
    group.must(&["down"]);
    (group, copies)
}

#[test]
fn journal_that_is_older_than_the_others_is_refused() {
    for service in ["speech", "policy", "arm"] {
        let (mut group, copies) = copied_between_deliveries();
        fs::copy(copies.path().join(service), group.paths().journal_file(service)).unwrap();
        assert_refused(&mut group, service, &format!("{service}.journal is older than"));
        group.must(&["journal", "set-aside", service]);
        assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
        group.down();
    }
    // All of them from one copy agree.
    let (mut group, copies) = copied_between_deliveries();
    for service in ["speech", "policy", "arm"] {
        fs::copy(copies.path().join(service), group.paths().journal_file(service)).unwrap();
    }
    group.verify_journals();
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    assert_eq!(group.fetch("get me the bowl", "white2")["object"], "white2");
    group.down();
}

#[test]
fn journal_that_is_a_pipe_or_a_device_is_refused_at_once() {
    let mut group = fetched_and_down();
    let file = group.paths().journal_file("policy");
    fs::remove_file(&file).unwrap();
    std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
    assert_refused(&mut group, "policy", "not a journal");
    fs::remove_file(&file).unwrap();
    let mode = rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR;
    rustix::fs::mknodat(rustix::fs::CWD, &file, rustix::fs::FileType::Fifo, mode, 0).unwrap();
    assert_refused(&mut group, "policy", "not a journal");
    group.must(&["journal", "set-aside", "policy"]);
    assert_eq!(group.start(&[]).code, Some(0), "{}", group.logs());
    group.down();
}

#[test]
fn journal_is_verified_without_saying_how_its_group_was_started() {
    let mut group = Group::new();
    let started = group.start(&["dialogue.alpha=0.3", "dialogue.planner=entropy"]);
    assert_eq!(started.code, Some(0), "{started:?}");
    assert_eq!(group.fetch("get me the bowl", "metal")["object"], "metal");
    group.verify_journals();
    group.must(&["down"]);
    let verified = group.must(&["journal", "--verify"]);
    assert!(!verified.stdout.contains("of other settings skipped"), "{verified:?}");
    assert!(verified.stdout.contains("reproduced bit for bit"), "{verified:?}");
    assert!(verified.stdout.contains("1 pick as ordered"), "{verified:?}");
    assert!(group.must(&["journal"]).stdout.contains("I will get the"), "words of the scene");
}
