//! `whichone journal` on journals made here, whole and tampered with.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use config::Settings;
use journal::{Header, Journal};
use messages::{Interpretation, PromptId, UtteranceSeq};
use policy::mind::Mind;
use policy::state::{Asking, Cause, Heard, Record, State};
use scene::{Reading, Response};
use service::Time;

/// A group that has only journals.
struct Lab(tempfile::TempDir);

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

impl Lab {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn write(&self, records: &[Record]) {
        let folder = self.0.path().join("lab/journal");
        std::fs::create_dir_all(&folder).expect("a folder");
        let header = Header { record: "policy/4".into(), group: "lab".into(), epoch: 1 };
        let file = folder.join("policy.journal");
        let (mut journal, _) = Journal::open(&file, &header).expect("a journal");
        for record in records {
            journal.append(record).expect("room");
            journal.sync().expect("a disk");
        }
    }

    fn journal(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_whichone"));
        command.env_clear().env("WHICHONE_HOME", self.0.path());
        command.args(["journal", "--group", "lab", "--config"]).arg(shipped()).args(arguments);
        command.output().expect("a process")
    }

    #[track_caller]
    fn check(&self, arguments: &[&str], code: i32, part: &str) {
        let output = self.journal(arguments);
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.contains(part), "{text}");
    }
}

/// A request and an answer, as the policy records them.
fn dialogue() -> Vec<Record> {
    let settings = Settings::load(&shipped(), None, &[]).expect("the shipped configuration");
    let mut mind: Mind = policy::shell::mind(&settings).expect("its planner");
    let white = settings.scene.word_named("white").expect("a word of the bowls");
    let request = Reading { base: vec![white], ..Reading::default() };
    let answer = Reading { response: Response::Yes, ..Reading::default() };
    let mut state: State = mind.first();
    let mut records = Vec::new();
    for (seq, reading) in [request, answer].into_iter().enumerate() {
        let seq = seq as u64 + 1;
        let at = Time(seq * 1_000_000_000);
        let began = Time(at.ns() - 500_000_000);
        let asking = Asking { prompt: PromptId(seq - 1), began, ended: Some(began), whole: true };
        let heard = Heard {
            seq: UtteranceSeq(seq),
            asked: vec![asking],
            typed: true,
            onset: at,
            end: at,
            accepted: at,
            meant: vec![Interpretation { weight: 1.0, answers: Some(0), reading }],
            ..Heard::default()
        };
        let cause = Cause::Utterance(heard);
        state = mind.step(&state, &cause, at);
        records.push(Record { cause, at, state: state.clone() });
    }
    records
}

#[test]
fn a_journal_that_holds_together_is_shown_and_confirmed() {
    let lab = Lab::new();
    lab.write(&dialogue());
    lab.check(&["policy"], 0, "utterance 2");
    lab.check(&["--json"], 0, "\"seq\":2,\"record\":{");
    lab.check(&["--verify"], 0, "2 states follow from those before them, bit for bit");
    lab.check(&["--verify", "--json"], 0, "{\"ok\":true,\"records\":2,");
}

#[test]
fn a_belief_that_does_not_follow_is_found_to_the_last_bit() {
    let lab = Lab::new();
    let mut records = dialogue();
    let open = records[1].state.open.as_mut().expect("an open interaction");
    open.belief[0] = f64::from_bits(open.belief[0].to_bits() + 1);
    lab.write(&records);
    lab.check(&["--verify"], 70, "record 2: the state does not follow");
    lab.check(&["--verify", "--json"], 70, "\"ok\":false");
}

#[test]
fn an_utterance_applied_twice_is_found() {
    let lab = Lab::new();
    let records = dialogue();
    lab.write(&[&records[..], &records[1..]].concat());
    lab.check(&["--verify"], 70, "record 3: utterance 2 applied after 2");
}

#[test]
fn a_damaged_file_is_told_by_the_place_of_the_damage() {
    let lab = Lab::new();
    lab.write(&dialogue());
    let file = lab.0.path().join("lab/journal/policy.journal");
    let whole = std::fs::read(&file).expect("a journal");
    let mut torn = whole.clone();
    torn.truncate(whole.len() - 3);
    std::fs::write(&file, &torn).expect("a disk");
    lab.check(&["--verify"], 0, "an unfinished write");
    let mut flipped = whole;
    let in_the_first_frame = torn.len() / 4;
    flipped[in_the_first_frame] ^= 1;
    std::fs::write(&file, &flipped).expect("a disk");
    lab.check(&["--verify"], 70, "damaged at byte");
}
