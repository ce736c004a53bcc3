//! Journals folded, exported and added up.

use serde_json::json;

use crate::Protocol;
use crate::Verdict;
use crate::event::{Drawn, Entry, Event, Fault, parse};
use crate::participant::{Participant, Stage, Status};
use crate::testing::{finished, interaction, journal, protocol};
use crate::{report, tables, to_json};

fn text(entries: &[Entry]) -> String {
    entries.iter().map(Entry::to_line).collect()
}

#[test]
fn study_journal_round_trips_and_ignores_a_torn_end() {
    let entries = journal("A", &protocol(), 3);
    let whole = text(&entries);
    assert_eq!(parse(&whole).unwrap(), entries);
    for cut in 0..whole.len() {
        let read = parse(&whole[..cut]).unwrap();
        assert_eq!(read, entries[..whole[..cut].matches('\n').count()], "cut at {cut}");
    }
    let spoilt = whole.replacen("instructed", "distracted", 1);
    let error = parse(&spoilt).unwrap_err();
    assert_eq!(error.line, 3);
    assert!(error.to_string().contains("restore"), "{error}");
    let newer = whole.replacen("\"version\":1", "\"version\":2", 1);
    assert!(parse(&newer).unwrap_err().what.contains("newer"));
}

#[test]
fn participant_fold_is_incremental() {
    let entries = journal("A", &protocol(), 2);
    let whole = Participant::fold(&entries).unwrap();
    for cut in 1..entries.len() {
        let mut participant = Participant::fold(&entries[..cut]).unwrap();
        entries[cut..].iter().for_each(|entry| participant.apply(entry));
        assert_eq!(participant, whole, "cut at {cut}");
    }
    assert_eq!((whole.stage, whole.status()), (Stage::Thanks, Status::Complete));
    assert_eq!(Participant::fold(&entries[1..]), None, "the first line is missing");
}

#[test]
fn trial_seconds_count_from_the_first_sound_to_the_end() {
    let person = finished("A", &protocol(), 3);
    let trial = &person.trials[1];
    assert_eq!((trial.seconds(), trial.talk_seconds()), (Some(11.0), Some(5.0)));
    assert_eq!((trial.questions(), trial.repeats()), (1, 1));
    // The robot did not end it: the console's observations count.
    let mut entries = journal("A", &protocol(), 3);
    for entry in &mut entries {
        if let Event::Ended(ending) = &mut entry.event {
            ending.seconds = None;
        }
    }
    assert_eq!(Participant::fold(&entries).unwrap().trials[1].seconds(), Some(11.0));
    entries.retain(|entry| !matches!(entry.event, Event::Heard(_)));
    assert_eq!(Participant::fold(&entries).unwrap().trials[1].seconds(), None);
}

#[test]
fn trial_with_a_fault_is_repeated_and_does_not_count() {
    let mut entries = journal("A", &protocol(), 3);
    let at = entries.iter().position(|e| matches!(e.event, Event::Ended(_))).unwrap();
    let fault = Event::Faulted { fault: Fault::Service, why: "arm, gone".to_owned() };
    entries.truncate(at);
    entries.push(Entry { at: 1, event: fault });
    let mut person = Participant::fold(&entries).unwrap();
    assert_eq!((person.next_step(), person.counted().count()), (Some(0), 0));
    for event in interaction(0, Verdict::Right) {
        person.apply(&Entry { at: 2, event });
    }
    assert_eq!((person.next_step(), person.counted().count()), (Some(1), 1));
    let tables = tables(&[person.clone()]);
    let rows: Vec<&str> = tables.interactions.lines().collect();
    assert!(rows[1].contains(",fault,") && rows[1].ends_with("\"arm, gone\""), "{}", rows[1]);
    assert!(rows[2].contains(",right,1,10.0,5.0,1,1,1,0,1,1,"), "{}", rows[2]);
    assert_eq!(report(&[person]).faults, 1);
}

#[test]
fn study_tables_have_every_column_of_the_dictionary() {
    let people = [finished("A", &protocol(), 3), finished("B", &protocol(), 0)];
    let tables = tables(&people);
    let heads: Vec<&str> = tables.interactions.lines().next().unwrap().split(',').collect();
    for row in tables.interactions.lines().skip(1) {
        assert_eq!(row.split(',').count(), heads.len(), "{row}");
    }
    assert_eq!(tables.interactions.lines().count(), 7);
    let people_heads: Vec<&str> = tables.participants.lines().next().unwrap().split(',').collect();
    assert_eq!(people_heads[people_heads.len() - 2..], ["q_quick", "q_remarks"]);
    assert!(tables.participants.contains(",4,\"fine, \"\"really\"\"\nyes\"\n"));
    for (file, heads) in [("interactions", heads), ("participants", people_heads)] {
        for head in heads {
            assert!(tables.dictionary.contains(&format!("\n{file}.csv,{head},")), "{head}");
        }
    }
    let json = to_json(&people);
    assert_eq!(json["participants"][1]["trials"][2]["outcome"], "wrong");
    assert_eq!(json["participants"][0]["answers"]["quick"], 4);
}

#[test]
fn report_omits_withdrawn_participants_but_counts_those_who_left() {
    let with_last = |id: &str, event| {
        let mut entries = journal(id, &protocol(), 3);
        entries.truncate(entries.len() - 1);
        entries.push(Entry { at: 9, event });
        Participant::fold(&entries).unwrap()
    };
    let withdrawn = with_last("W", Event::Withdrawn);
    let people = [withdrawn.clone(), with_last("L", Event::Left), finished("A", &protocol(), 1)];
    let report = report(&people);
    assert_eq!((report.all.interactions(), report.all.right()), (6, 4));
    assert_eq!(report.participants[0], ("complete", 1));
    let rows = tables(&[withdrawn]).interactions;
    assert!(rows.lines().skip(1).all(|row| row.contains(",withdrawn,")), "{rows}");
    assert!(!rows.contains(",right,1,"), "no success is counted: {rows}");
}

#[test]
fn report_reproduces_the_paper_figures_from_its_counts() {
    // 15 participants, 45 interactions, 36 of them right.
    let rights = [3, 3, 2, 2, 2, 3, 3, 2, 2, 2, 3, 3, 2, 2, 2];
    let people: Vec<Participant> =
        rights.iter().map(|right| finished("P", &protocol(), *right)).collect();
    let report = report(&people);
    assert_eq!((report.all.interactions(), report.all.right()), (45, 36));
    assert!((report.all.success() - 0.8).abs() < 1e-12);
    let interval = report.all.success_interval();
    assert!((interval.low - 0.6618).abs() < 1e-3 && (interval.high - 0.8910).abs() < 1e-3);
    assert_eq!(report.policies[0].policy, "lookahead");
    assert_eq!(report.all.seconds.mean(), 11.0);
    assert_eq!(report.scenes, [("bowls".to_owned(), "00000000000000ab".to_owned())]);
    let json = report.to_json();
    assert_eq!(json["all"]["outcomes"]["wrong"], 9);
    assert_eq!(json["questionnaire"][0]["counts"]["4"], 15);
    assert_eq!(json["questionnaire"][1]["mean"], json!(null));
}

#[test]
fn report_compares_policies_within_participants() {
    let policies = vec!["lookahead".to_owned(), "entropy".to_owned()];
    let protocol = Protocol { policies, interactions: 2, ..protocol() };
    // The first two interactions are right, and the later ones take longer by two seconds.
    let people: Vec<Participant> = (0..3).map(|_| finished("A", &protocol, 2)).collect();
    let paired = report(&people).paired;
    assert_eq!((paired.len(), paired[0].success.count()), (1, 3));
    assert_eq!((paired[0].policy.as_str(), paired[0].with.as_str()), ("entropy", "lookahead"));
    assert_eq!((paired[0].success.mean(), paired[0].seconds.mean()), (-1.0, 2.0));
    let mut unfinished = people;
    for person in &mut unfinished {
        person.trials.pop();
    }
    assert!(report(&unfinished).paired.is_empty(), "no participant has completed both");
}

#[test]
fn participant_ignores_trials_beyond_the_plan() {
    let mut person = finished("A", &protocol(), 3);
    let before = person.trials.len();
    let Event::Drawn(drawn) = &interaction(0, Verdict::Right)[0] else { unreachable!() };
    let drawn = Drawn { step: 99, ..drawn.clone() };
    person.apply(&Entry { at: 1, event: Event::Drawn(drawn) });
    assert_eq!(person.trials.len(), before);
}
