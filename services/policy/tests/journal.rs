//! Inspection of the policy's journal by its own program, on intact and manipulated journals.

use setup::DialogueSettings;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use config::Settings;
use dialogue::manager::{Cause, MotionStop, Record, State, Utterance};
use dialogue::{Belief, Posterior};
use journal::{Header, Journal};
use messages::{Interpretation, PromptId, Service, UtteranceSeq};
use scene::{Reading, Response};
use serde_json::Value;
use service::Time;
use service::journal_record::golden;
use vocabulary::{PickOutcome, Presentation};

/// A journal and a snapshot of the shipped settings in a temporary folder.
struct Lab(tempfile::TempDir);

fn shipped() -> Settings {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    preflight::load(&folder, None, &[]).expect("the shipped configuration")
}

impl Lab {
    fn with(records: &[Record]) -> Self {
        let lab = Self(tempfile::tempdir().expect("a folder"));
        shipped().write_snapshot(lab.0.path()).expect("a disk");
        let header =
            Header { record: "policy".into(), group: "lab".into(), epoch: 1, generation: 1 };
        let (mut journal, _) = Journal::open_or_create(&lab.file(), &header).expect("a journal");
        for record in records {
            journal.append(record).expect("room");
            journal.sync().expect("a disk");
        }
        lab
    }

    fn file(&self) -> PathBuf {
        self.0.path().join("policy.journal")
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let own = std::env::current_exe().expect("the test's own path");
        let program = own.ancestors().nth(2).expect("a folder of builds").join("examples/policy");
        let mut command = Command::new(program);
        command.arg("journal").arg(self.file()).arg("--settings").arg(self.0.path());
        command.args(arguments).output().expect("a process")
    }

    #[track_caller]
    fn check(&self, arguments: &[&str], code: i32, part: &str) {
        let output = self.run(arguments);
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.contains(part), "{text}");
    }
}

/// A request and an answer, as the policy records them.
fn dialogue() -> Vec<Record> {
    let settings = shipped();
    let mut manager = settings.manager().expect("its planner");
    let white = settings.scene.word_named("white").expect("a word of the bowls");
    let request = Reading { base: vec![white], ..Reading::default() };
    let answer = Reading { response: Response::Yes, ..Reading::default() };
    let mut state: State = manager.first();
    let mut records = Vec::new();
    for (seq, reading) in [request, answer].into_iter().enumerate() {
        let seq = seq as u64 + 1;
        let at = Time(seq * 1_000_000_000);
        let began = Time(at.ns() - 500_000_000);
        let prompt = PromptId(seq - 1);
        let presentation = Presentation {
            prompt,
            number: 1,
            began,
            ended: Some(began),
            complete: true,
            ..Presentation::default()
        };
        let heard = Utterance {
            seq: UtteranceSeq(seq),
            presentations: vec![presentation],
            typed: true,
            onset: at,
            end: at,
            accepted: at,
            interpretations: vec![Interpretation { weight: 1.0, answers: Some(0), reading }],
            ..Utterance::default()
        };
        let cause = Cause::Utterance(heard);
        manager.step(&mut state, &cause, at);
        records.push(Record { cause, at, state: state.clone() });
    }
    records
}

/// As [`dialogue`], and one record of each other cause.
fn every_cause() -> Vec<Record> {
    let mut records = dialogue();
    let mut manager = shipped().manager().expect("its planner");
    let mut state = records[1].state.clone();
    let mut add = |cause: Cause| {
        let at = Time(10_000_000_000 + state.act.id.0 * 1_000_000_000);
        manager.step(&mut state, &cause, at);
        records.push(Record { cause, at, state: state.clone() });
        state.last_order
    };
    for cause in [
        Cause::Silence,
        Cause::MotionStop(MotionStop::Stopped),
        Cause::MotionStop(MotionStop::Released),
    ] {
        add(cause);
    }
    let about = |word| Reading {
        base: vec![shipped().scene.word_named(word).expect("a word of the bowls")],
        ..Reading::default()
    };
    let reading = Reading { excluded: vec![about("white").base], ..about("clear") };
    let interpretations = vec![Interpretation { weight: 1.0, answers: None, reading }];
    let heard = Utterance {
        seq: UtteranceSeq(3),
        onset: Time(20_000_000_000),
        end: Time(21_000_000_000),
        accepted: Time(21_000_000_000),
        interpretations,
        gesture: Some([0.5, 0.25, 0.0]),
        ..Utterance::default()
    };
    let pick = add(Cause::Utterance(heard));
    add(Cause::Quiet);
    add(Cause::PickEnded { pick, outcome: PickOutcome::Delivered });
    add(Cause::Reconfigured);
    add(Cause::SetAside(1_000_000_000));
    add(Cause::Snapshot);
    records
}

/// Numbers to six digits: the last ones depend on the machine's library of functions.
fn rounded(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().expect("a number");
            *value = format!("{number:.6}").parse::<f64>().expect("a number").into();
        }
        Value::Array(all) => all.iter_mut().for_each(rounded),
        Value::Object(all) => all.values_mut().for_each(rounded),
        _ => {}
    }
}

/// Records are read by programs. `WHICHONE_BLESS=1` rewrites the golden file.
#[test]
fn records_for_programs_match_the_golden_file() {
    let lab = Lab::with(&every_cause());
    let clock = "{\"seq\":1,\"wall_minus_monotonic_ns\":1700000000000000000}\n";
    std::fs::write(lab.0.path().join("policy.clock"), clock).expect("a disk");
    let output = lab.run(&["--json"]);
    assert!(output.status.success(), "{output:?}");
    let lines = String::from_utf8(output.stdout).expect("text");
    let lines = lines.lines().map(|line| {
        let mut line: Value = serde_json::from_str(line).expect("JSON");
        rounded(&mut line);
        format!("{line}\n")
    });
    let found: String = lines.collect();
    golden::check(Service::Policy, &found);
}

#[test]
fn an_intact_journal_is_listed_and_verified() {
    let lab = Lab::with(&dialogue());
    lab.check(&[], 0, "utterance 2 → ");
    lab.check(
        &["--json"],
        0,
        "\"record\":{\"service\":\"policy\",\"cause\":{\"type\":\"utterance\",",
    );
    let since = lab.run(&["--since", "2"]);
    let since = String::from_utf8(since.stdout).expect("text");
    assert!(since.contains("utterance 2") && !since.contains("utterance 1"), "{since}");
    lab.check(&["--verify"], 0, "2 states reproduced bit for bit from the one before");
    lab.check(&["--verify", "--json"], 0, "{\"schema\":1,\"ok\":true,\"records\":2,");
}

#[test]
fn verification_finds_a_belief_that_differs_in_one_bit() {
    let mut records = dialogue();
    let open = records[1].state.open.as_mut().expect("an open interaction");
    let mut belief = open.belief().log_weights().to_vec();
    belief[0] = f64::from_bits(belief[0].to_bits() + 1);
    open.posterior = Posterior::Object(Belief::from_log(belief).expect("a belief"));
    let lab = Lab::with(&records);
    lab.check(&["--verify"], 70, "record 2: the state does not follow");
    lab.check(&["--verify", "--json"], 70, "\"ok\":false");
}

#[test]
fn verification_finds_an_utterance_that_was_applied_twice() {
    let records = dialogue();
    let lab = Lab::with(&[&records[..], &records[1..]].concat());
    lab.check(&["--verify"], 70, "record 3: utterance 2 applied after 2");
}

#[test]
fn verification_reports_the_place_of_damage() {
    let lab = Lab::with(&dialogue());
    let whole = std::fs::read(lab.file()).expect("a journal");
    std::fs::write(lab.file(), &whole[..whole.len() - 3]).expect("a disk");
    lab.check(&["--verify"], 0, "an unfinished write");
    let mut flipped = whole;
    let in_the_first_frame = flipped.len() / 4;
    flipped[in_the_first_frame] ^= 1;
    std::fs::write(lab.file(), &flipped).expect("a disk");
    lab.check(&["--verify"], 74, "damaged at byte");
}

#[test]
fn verification_does_not_repeat_what_a_swapped_program_decided() {
    let mut records = dialogue();
    let key = shipped().manager_key("program");
    for record in &mut records {
        // It asks other questions than the planner of the settings.
        record.state.act.value += 1.0;
        record.state.settings_key = key;
    }
    let lab = Lab::with(&records);
    lab.check(&["--verify"], 0, "2 states not reproduced: a program that was swapped in decided");
}
