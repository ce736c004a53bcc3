use messages::{ActKind, Outcome};
use serde_json::{Value, json};
use service::journal_record::JournalLine;

use crate::assemble::Assembler;
use crate::interaction::{Event, Interaction};
use crate::store::Store;

fn line(seq: u64, at_s: f64, record: Value) -> JournalLine {
    let (at_ns, unix_ms) = ((at_s * 1e9) as u64, 1_000_000 + (at_s * 1e3) as u64);
    let line =
        json!({ "seq": seq, "at_ns": at_ns, "unix_ms": unix_ms, "text": "", "record": record });
    serde_json::from_value(line).unwrap()
}

fn accepted(seq: u64, at_s: f64, text: &str) -> JournalLine {
    let record = json!({
        "service": "speech", "type": "accepted", "utterance": seq, "text": text, "confidence": 0.9,
        "hypotheses": [], "source": "text", "gesture_m": null, "asked": [], "onset_ns": 0,
        "end_ns": 0, "snr_db": null, "segment": 0, "segments": 1, "key": "",
    });
    line(seq, at_s, record)
}

/// Makes an utterance's meaning, as an answer to prompt 1 or to none.
fn heard(utterance: u64, text: &str, answers: Option<u64>) -> Value {
    let answers = answers.map(|prompt| json!({ "prompt": prompt, "presentation": 1 }));
    let reading = json!({
        "weight": 1.0, "answers": answers, "text": text, "base": [], "response": "none",
        "intent": "inform", "excluded": [],
    });
    json!({
        "type": "utterance", "utterance": utterance, "typed": true, "onset_ns": 0, "end_ns": 0,
        "accepted_ns": 0, "gesture_m": null, "more": false, "unknown": null,
        "interpretations": [reading],
    })
}

/// A state of the policy after a cause.
struct Policy {
    interaction: u64,
    belief: [f64; 2],
    decision: &'static str,
    text: &'static str,
    ended: Value,
}

impl Policy {
    fn line(&self, seq: u64, at_s: f64, cause: &Value) -> JournalLine {
        let Self { interaction, belief: [a, b], decision, text, ended } = self;
        let is_open = *interaction != 0;
        let utterance = &cause["utterance"];
        let answered = &cause["interpretations"][0]["answers"];
        let questions = match answered.is_object() {
            true => json!([{ "prompt": 1, "presentation": 1, "share": 0.75 }]),
            false => json!([]),
        };
        let none = if answered.is_object() { 0.25 } else { 1.0 };
        let decision = json!({
            "act": seq, "type": decision, "prompt": seq, "presentation": 1, "text": text,
            "question": { "type": "none" }, "utterance": 1, "decided_ns": 0, "value_s": 1.0,
            "pick": (*decision == "pick").then(|| json!({ "interaction": interaction, "attempt": 1, "object": "b" })),
            "bounds_s": null, "alternatives": [], "expected_questions": 0.5,
        });
        let (belief, objects) = match is_open {
            true => (json!({ "a": a, "b": b }), json!({ "a": "white bowl", "b": "white bowl" })),
            false => (json!({}), json!({})),
        };
        let record = json!({
            "service": "policy", "cause": cause, "applied": 1, "interaction": interaction,
            "opened_ns": is_open.then_some(10_000_000_000_u64), "questions": 1, "belief": belief,
            "objects": objects, "absent": 0.0, "user": null, "decision": decision,
            "attributed": { "utterance": utterance.as_u64().unwrap_or(0), "questions": questions, "none": none },
            "deferred_since_ns": null, "queue": [], "ended": ended, "refusable": null,
            "putting_back": null, "stopped": false,
        });
        line(seq, at_s, record)
    }
}

fn arm(seq: u64, at_s: f64, cause: &str, phase: &str, outcome: &str) -> JournalLine {
    let posture = json!({ "joints_rad": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "width_m": 0.0 });
    let record = json!({
        "service": "arm", "cause": { "type": cause }, "limb": "left", "misses": 0, "held": null,
        "pick": { "interaction": 4, "attempt": 1, "object": "object 1", "task": "fetch", "phase": phase, "outcome": outcome },
        "gone": [], "offered": null, "stopped": false, "obeyed_ns": 0, "waits_for_person": false,
        "posture": [posture, posture],
    });
    line(seq, at_s, record)
}

fn ended(interaction: u64, outcome: &str) -> Value {
    json!({ "interaction": interaction, "object": "b", "outcome": outcome, "questions": 1, "duration_s": 9.0 })
}

/// Speech, policy and arm in one interaction with one question.
fn dialogue() -> [Vec<JournalLine>; 3] {
    let done = Policy {
        interaction: 0,
        decision: "say",
        text: "Here it is.",
        ended: ended(4, "delivered"),
        ..picks()
    };
    let over =
        json!({ "type": "pick_ended", "interaction": 4, "attempt": 1, "outcome": "delivered" });
    let policy = vec![
        asks().line(1, 10.1, &heard(1, "bowl", None)),
        picks().line(2, 14.0, &heard(2, "no", Some(1))),
        done.line(3, 19.0, &over),
    ];
    let arm = vec![
        arm(1, 14.1, "ordered", "accepted", "pending"),
        // Back from the pick before.
        arm(2, 14.2, "rested", "accepted", "pending"),
        arm(2, 14.3, "phase", "moving", "pending"),
        arm(3, 19.0, "ended", "done", "delivered"),
        arm(4, 21.0, "rested", "done", "delivered"),
        arm(5, 29.0, "rested", "done", "delivered"),
    ];
    [vec![accepted(1, 10.0, "get me the bowl"), accepted(2, 13.9, "no")], policy, arm]
}

fn asks() -> Policy {
    Policy {
        interaction: 4,
        belief: [0.5, 0.5],
        decision: "ask",
        text: "On the shelf?",
        ended: Value::Null,
    }
}

fn picks() -> Policy {
    Policy { belief: [0.0, 1.0], decision: "pick", text: "I will get it.", ..asks() }
}

fn assembled(journals: [Vec<JournalLine>; 3]) -> Assembler {
    let mut assembler = Assembler::default();
    journals.into_iter().for_each(|lines| assembler.take_in(lines));
    assembler
}

#[test]
fn interaction_has_words_readings_beliefs_decisions_and_the_arm() {
    let assembler = assembled(dialogue());
    let one = assembler.get(4).unwrap();
    assert_eq!((one.unix_ms, one.whole), (Some(1_010_000), true));
    let labels: Vec<_> = one.objects.iter().map(|it| it.label.as_str()).collect();
    assert_eq!(labels, ["white bowl", "white bowl 2"], "told apart");
    let moments: Vec<_> = one.moments.iter().map(|it| (it.after_ms, &it.event)).collect();
    let times: Vec<u64> = moments.iter().map(|(after_ms, _)| *after_ms).collect();
    assert_eq!(times, [100, 4_000, 4_100, 4_300, 9_000, 11_000], "at rest once");
    let Event::Heard(answer) = moments[1].1 else { panic!("{moments:?}") };
    assert_eq!((answer.text.as_str(), answer.confidence), ("no", Some(0.9)));
    assert_eq!((answer.readings[0].text.as_str(), answer.readings[0].weight), ("no", 0.75));
    assert_eq!(answer.answers[0].question, "On the shelf?");
    assert_eq!(answer.answers[0].share, 0.75);
    let Event::Arm { pick, .. } = moments[2].1 else { panic!("{moments:?}") };
    assert_eq!(pick.object, "b", "by the name that the policy ordered");
    let thought = one.moments[1].thought.as_ref().unwrap();
    assert_eq!((&thought.belief[..], thought.decision.kind), (&[0.0, 1.0][..], ActKind::Pick));
    let last = one.moments[4].thought.as_ref().unwrap();
    assert_eq!(last.belief, [0.0, 1.0], "the belief at the end is the last one");
    let end = one.end.as_ref().unwrap();
    assert_eq!((end.outcome, end.questions, end.duration_s), (Outcome::Delivered, 1, 9.0));
    assert_eq!(end.object.as_ref().unwrap().label, "white bowl 2");
    assert_eq!(one.summary().text, "get me the bowl");
}

#[test]
fn interaction_is_the_same_however_its_records_are_read() {
    let whole = assembled(dialogue());
    let [speech, policy, arm] = dialogue();
    let mut piecewise = Assembler::default();
    piecewise.take_in(speech);
    for line in policy {
        piecewise.take_in(vec![line]);
    }
    for line in arm {
        piecewise.take_in(vec![line]);
    }
    let only = |assembler: &Assembler| assembler.recent().cloned().collect::<Vec<Interaction>>();
    assert_eq!(only(&piecewise), only(&whole));
    let text = serde_json::to_string(&only(&whole)).unwrap();
    assert_eq!(serde_json::from_str::<Vec<Interaction>>(&text).unwrap(), only(&whole));
}

#[test]
fn refusal_after_the_end_changes_the_outcome() {
    let mut assembler = assembled(dialogue());
    let refused = Policy { interaction: 5, ended: ended(4, "refused"), ..asks() };
    assembler.take_in(vec![refused.line(4, 25.0, &heard(3, "no", None))]);
    let outcome = |number| assembler.get(number).unwrap().end.as_ref().map(|end| end.outcome);
    assert_eq!((outcome(4), outcome(5)), (Some(Outcome::Refused), None));
}

#[test]
fn interaction_whose_beginning_is_lost_says_so() {
    let snapshot = asks().line(700, 12.0, &json!({ "type": "snapshot" }));
    let next = picks().line(701, 14.0, &heard(2, "no", Some(1)));
    let mut assembler = Assembler::default();
    assembler.take_in(vec![snapshot.clone(), next.clone()]);
    let one = assembler.get(4).unwrap();
    assert!(!one.whole && one.moments.len() == 2, "{one:?}");
    // A journal that continues in a new file repeats the state.
    let [speech, mut policy, _] = dialogue();
    policy.truncate(1);
    policy.extend([snapshot, next]);
    let assembler = assembled([speech, policy, Vec::new()]);
    let one = assembler.get(4).unwrap();
    assert!(one.whole && one.moments.len() == 2, "{one:?}");
}

fn stored(number: u64) -> Interaction {
    let assembler = assembled(dialogue());
    Interaction { interaction: number, ..assembler.get(4).unwrap().clone() }
}

#[test]
fn store_keeps_interactions_across_restarts_without_a_torn_line() {
    let folder = tempfile::tempdir().unwrap();
    let open = || Store::open(folder.path().join("history")).unwrap();
    let mut store = open();
    assert_eq!((store.len(), store.newest()), (0, 0));
    (1..=3).for_each(|number| store.append(&stored(number)).unwrap());
    let file = std::fs::read_dir(folder.path().join("history")).unwrap().next().unwrap().unwrap();
    let whole = std::fs::read(file.path()).unwrap();
    std::fs::write(file.path(), [&whole[..], b"{\"interaction\":4,\"uni"].concat()).unwrap();
    let mut store = open();
    assert_eq!((store.len(), store.newest()), (3, 3));
    store.append(&stored(5)).unwrap();
    assert_eq!(store.read(2).unwrap(), Some(stored(2)));
    assert_eq!(store.read(5).unwrap(), Some(stored(5)));
    assert_eq!(store.read(4).unwrap(), None);
    let listed: Vec<u64> = open().newest_first().map(|it| it.interaction).collect();
    assert_eq!(listed, [5, 3, 2, 1]);
}

#[test]
fn store_is_bounded_and_drops_the_oldest() {
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::with_limits(folder.path().to_owned(), 20_000, 3).unwrap();
    (1..=200).for_each(|number| store.append(&stored(number)).unwrap());
    let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().flatten().collect();
    let bytes: u64 = files.iter().map(|file| file.metadata().unwrap().len()).sum();
    assert!(files.len() == 3 && bytes <= 60_000, "{files:?}, {bytes}");
    let oldest = store.oldest().unwrap().interaction;
    assert_eq!(store.len() as u64, 200 - oldest + 1);
    assert_eq!(store.read(1).unwrap(), None);
    assert_eq!(store.read(oldest).unwrap(), Some(stored(oldest)));
}
