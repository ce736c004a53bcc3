//! A protocol and participants for the tests of this crate.

use serde_json::{Map, json};

use crate::Verdict;
use crate::event::{Asked, Begun, Drawn, Ending, Entry, Event, Heard, Source, VERSION};
use crate::participant::Participant;
use crate::plan::{Counts, plan};
use crate::{Design, Objects, Order, Protocol};
use crate::{Item, Kind};

pub(crate) fn protocol() -> Protocol {
    let item = |id: &str, kind, points| Item {
        id: id.to_owned(),
        text: format!("Was it \"{id}\", or not?"),
        kind,
        options: Vec::new(),
        low: "no".to_owned(),
        high: "yes".to_owned(),
        points,
        required: kind == Kind::Likert,
    };
    Protocol {
        title: "Bowls".to_owned(),
        consent: "I agree.".to_owned(),
        instructions: vec!["Ask for it.".to_owned()],
        interactions: 3,
        warmup: 0,
        objects: Objects::Uniform,
        design: Design::Within,
        policies: vec!["lookahead".to_owned()],
        order: Order::Latin,
        seconds_max: 180.0,
        show_belief: false,
        keep_words: false,
        questionnaire: vec![item("quick", Kind::Likert, 5), item("remarks", Kind::Text, 0)],
    }
}

/// Returns the journal of a participant who has done everything, the first `right` interactions
/// with success: interaction `n` took 10 + n seconds, 2 of them before the utterance was accepted,
/// and one question.
pub(crate) fn journal(id: &str, protocol: &Protocol, right: u32) -> Vec<Entry> {
    let seed = u64::from(id.as_bytes()[0]);
    let plan = plan(protocol, &Counts::default(), seed);
    let begun = Begun {
        version: VERSION,
        participant: id.to_owned(),
        session: "s".to_owned(),
        seed,
        plan: plan.clone(),
        protocol: protocol.clone(),
        group: "lab".to_owned(),
        software: "1".to_owned(),
    };
    let mut events = vec![Event::Begun(Box::new(begun)), Event::Consented, Event::Instructed];
    for (n, step) in plan.iter().enumerate() {
        let is_right = !step.practice && (n as u32) < right;
        events.extend(interaction(n, if is_right { Verdict::Right } else { Verdict::Wrong }));
    }
    let mut answers = Map::new();
    answers.insert("quick".to_owned(), json!(4));
    answers.insert("remarks".to_owned(), json!("fine, \"really\"\nyes"));
    events.extend([Event::Questioned, Event::Answered { answers }, Event::Finished]);
    let entry = |(n, event)| Entry { at: 1_772_357_400_000 + 1000 * n as u64, event };
    events.into_iter().enumerate().map(entry).collect()
}

/// Returns the lines of interaction `n`.
pub(crate) fn interaction(n: usize, verdict: Verdict) -> [Event; 6] {
    let began = 1e5 * (n + 1) as f64;
    let picked = if verdict == Verdict::Right { "white" } else { "clear" };
    [
        Event::Drawn(Drawn {
            step: n,
            object: "white".to_owned(),
            label: "small white bowl".to_owned(),
            scene: "bowls".to_owned(),
            scene_key: "00000000000000ab".to_owned(),
            among: vec!["white".to_owned(), "clear".to_owned()],
        }),
        Event::Started { after: n as u64 },
        Event::Heard(Heard {
            seq: n as u64 + 1,
            source: Source::Voice,
            onset_ms: began,
            accepted_ms: began + 2e3,
            words: None,
        }),
        Event::Asked(Asked { prompt: n as u64 + 1, presentation: 2, words: None }),
        Event::Decided { decided_ms: began + 5e3 },
        Event::Ended(Ending {
            verdict,
            interaction: n as u64 + 1,
            object: Some(picked.to_owned()),
            questions: 1,
            utterances: 1,
            seconds: Some(8.0 + n as f64),
            ended_ms: began + 11e3,
        }),
    ]
}

/// Returns a finished participant.
pub(crate) fn finished(id: &str, protocol: &Protocol, right: u32) -> Participant {
    Participant::fold(&journal(id, protocol, right)).expect("a first line")
}
