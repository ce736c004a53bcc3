//! Journals explain themselves: records for programs, and verification across a change of settings.

use crate::config::edited;
use serde_json::Value;
use service::journal_record::{JournalLine, JournalRecord, PolicyCause, SpeechRecord};
use service::wall_time;
use std::time::{SystemTime, UNIX_EPOCH};
use whichone_tests::Group;

const SERVICES: [&str; 3] = ["speech", "policy", "arm"];
/// Longest run of this test that is believed, milliseconds.
const RUN_MS: u64 = 600_000;

fn journal(group: &Group, service: &str, since: &str) -> Vec<JournalLine> {
    let listed = group.must(&["journal", service, "--json", "--since", since]).stdout;
    listed.lines().map(|line| serde_json::from_str(line).expect("a typed record")).collect()
}

fn unix_ms() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_millis() as u64
}

#[test]
fn journals_are_typed_named_and_verified_under_the_settings_of_their_time() {
    let began_ms = unix_ms();
    let folder = edited("dialogue.toml", |text| format!("{text}\n"));
    let mut group = Group::with_config(folder.path().to_owned());
    let ended = group.start(&[]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    group.fetch("get me the bowl", "white2");
    // Other settings decide from here on.
    let dialogue = folder.path().join("dialogue.toml");
    let text = std::fs::read_to_string(&dialogue).unwrap();
    let line = text.lines().find(|line| line.starts_with("epsilon")).expect("a key").to_owned();
    std::fs::write(&dialogue, text.replace(&line, "epsilon = 0.031")).unwrap();
    let before = group.incarnation("policy");
    group.must(&["reload"]);
    group.wait_for_restart("policy", before);
    group.fetch("the clear bowl", "clear");

    for service in SERVICES {
        let lines = journal(&group, service, "1");
        assert!(lines.len() > 3, "{service}: {}", lines.len());
        for (line, seq) in lines.iter().zip(1..) {
            assert!(line.seq == seq && !line.text.is_empty(), "{service}: {line:?}");
            let wall_ms = line.unix_ms.expect("noted with the first record");
            assert!(wall_ms + RUN_MS > began_ms && wall_ms < unix_ms() + 1_000, "{line:?}");
        }
        let last = lines.last().unwrap();
        let since = journal(&group, service, &last.seq.to_string());
        assert_eq!(since.first(), Some(last), "{service}");
    }
    listing_says_when_and_what_is_missing(&group);
    beliefs_and_words(&group);

    let verified = group.must(&["journal", "--verify"]).stdout;
    assert!(
        verified.contains("reproduced bit for bit from the one before under 2 settings"),
        "{verified}"
    );
    assert!(!verified.contains("not reproduced"), "{verified}");
    let verified = group.must(&["journal", "--verify", "--json"]).stdout;
    let last: Value = serde_json::from_str(verified.lines().last().unwrap()).unwrap();
    assert!(last["together"].as_str().is_some_and(|it| it.contains("epoch")), "{verified}");
    // Without the former settings their states are counted, and nothing else fails.
    let settings = group.paths().kept_settings();
    let mut kept: Vec<_> = std::fs::read_dir(settings).unwrap().flatten().collect();
    kept.sort_by_key(|entry| entry.metadata().unwrap().modified().unwrap());
    std::fs::remove_dir_all(kept[0].path()).unwrap();
    let verified = group.must(&["journal", "--verify"]).stdout;
    assert!(
        verified.contains("not reproduced: the settings of that time are no longer kept"),
        "{verified}"
    );
    group.down();
}

/// The text form has the wall time, and a number beyond the end is named.
fn listing_says_when_and_what_is_missing(group: &Group) {
    let last = journal(group, "arm", "1").pop().unwrap();
    let listed = group.must(&["journal", "arm", "--since", &last.seq.to_string()]);
    let wall = wall_time::text(last.unix_ms.unwrap() * 1_000_000);
    assert!(listed.stdout.contains(&format!(" s  {wall}  ")), "{listed:?}");
    assert_eq!(listed.stderr, "");
    let beyond = group.must(&["journal", "arm", "--since", "1000000"]);
    assert_eq!(beyond.stdout, "");
    let expected = format!("the last one is {}, written at ", last.seq);
    assert!(beyond.stderr.contains(&expected) && beyond.stderr.contains(&wall), "{beyond:?}");
}

/// What was said and believed, with the scene's names, in both parts.
fn beliefs_and_words(group: &Group) {
    let said: Vec<String> = journal(group, "speech", "1")
        .into_iter()
        .filter_map(|line| match line.record {
            JournalRecord::Speech(record) => match *record {
                SpeechRecord::Accepted(accepted) => Some(accepted.text),
                _ => None,
            },
            other => panic!("{other:?} in the journal of speech"),
        })
        .collect();
    assert!(said.contains(&"get me the bowl".to_owned()), "{said:?}");
    let mut utterances = 0;
    let mut delivered = Vec::new();
    for line in journal(group, "policy", "1") {
        let JournalRecord::Policy(record) = line.record else { panic!("{line:?}") };
        if record.interaction != 0 {
            let sum: f64 = record.belief.0.iter().map(|(_, p)| p).sum();
            assert!((sum + record.absent - 1.0).abs() < 1e-9, "{record:?}");
            assert!(record.belief.get("white2").is_some() && record.objects.get("clear").is_some());
        }
        if let PolicyCause::Utterance { interpretations, .. } = &record.cause {
            utterances += 1;
            assert!(interpretations.iter().all(|one| !one.text.is_empty()), "{record:?}");
        }
        delivered.extend(record.ended.and_then(|ended| ended.object));
    }
    assert_eq!(utterances, said.len(), "every accepted utterance was applied");
    delivered.dedup();
    assert_eq!(delivered, ["white2", "clear"]);
}
