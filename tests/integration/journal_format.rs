//! Journals of earlier versions: a group continues those that it can read, and rejects others with the offer of a fresh
//! start that keeps them.

use std::path::{Path, PathBuf};

use whichone_tests::Group;

fn old_journal() -> Vec<u8> {
    let path = "fixtures/journals/format_1/policy.journal";
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// Journals of the policy in the folders that fresh starts put aside.
fn kept_journals(group: &Group) -> Vec<PathBuf> {
    let folders = std::fs::read_dir(group.paths().root()).unwrap().map(|entry| entry.unwrap());
    let old = folders.filter(|entry| entry.file_name().to_string_lossy().starts_with("journal-"));
    old.map(|entry| entry.path().join("policy.journal")).filter(|path| path.is_file()).collect()
}

#[test]
fn journal_of_format_1_stops_the_start_until_a_fresh_start_keeps_it_aside() {
    let old = old_journal();
    let mut group = Group::new();
    let journal = group.paths().journal_file("policy");
    std::fs::create_dir_all(group.paths().journal()).unwrap();
    std::fs::write(&journal, &old).unwrap();

    let rejected = group.start(&[]);
    assert_ne!(rejected.code, Some(0), "{rejected:?}");
    assert!(rejected.stderr.contains("expected journal format 3, found 1"), "{rejected:?}");
    assert!(
        rejected.stderr.contains("`whichone up --fresh`, which keeps the old file"),
        "{rejected:?}"
    );
    assert_eq!(std::fs::read(&journal).unwrap(), old, "the old journal is unchanged");
    assert!(kept_journals(&group).is_empty());
    group.must(&["down"]);

    let started = group.start_fresh();
    assert_eq!(started.code, Some(0), "{started:?}\n{}", group.logs());
    let [kept] = &kept_journals(&group)[..] else { panic!("{:?}", kept_journals(&group)) };
    assert_eq!(std::fs::read(kept).unwrap(), old);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.verify_journals();
    group.down();
}

/// Journals of earlier versions, each of a group that was ended while it asked which of the white bowls is wanted. A
/// change of what a journal holds adds those of the version before.
const VERSIONS: [&str; 1] = ["2cb64e52"];

#[test]
fn groups_of_earlier_versions_go_on_where_they_were() {
    for version in VERSIONS {
        let mut group = Group::with_journals_of(version);
        let started = group.start(&[]);
        assert_eq!(started.code, Some(0), "{version}: {started:?}\n{}", group.logs());
        let outcome = group.await_pick(Some("white2"));
        assert_eq!(outcome["object"], "white2", "{version}: {outcome}");
        let said = group.must(&["say", "the clear bowl", "--json"]).json();
        assert!(said["utterance"].as_u64() > Some(8), "{version}: numbers go on: {said}");
        group.verify_journals();
        // The present version has written into them, and reads them again.
        group.must(&["down"]);
        let again = group.start(&[]);
        assert_eq!(again.code, Some(0), "{version}: {again:?}\n{}", group.logs());
        group.down();
    }
}
