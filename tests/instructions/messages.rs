//! Messages, and the policy's reducer that reads and writes them.

use crate::decisions::bowls;
use ::config::Settings;
use ::messages::{AskedQuestion, Interpretation, MessageRef, Observation, PolicyView, WireReading};
use policy::{In, Out, PolicyNode};
use scene::{AttributeId, Intent, ObjectId, Question, Reading, Scene, ValueId};
use service::{Effects, Event, Node, Time};
use setup::DialogueSettings;
use std::hint::black_box;
use std::path::Path;
use vocabulary::{ActKind, Action};

/// An observation of one reading of these words.
fn observation(scene: &Scene, seq: u64, words: &[&str], intent: Intent) -> Observation {
    let base = words.iter().map(|word| scene.word_named(word).expect("a word of the scene"));
    let reading = Reading { base: base.collect(), intent, ..Reading::default() };
    let mut observation =
        Observation { seq, scene_key: scene.key(), reading_count: 1, ..Observation::default() };
    write(&mut observation, &Interpretation { weight: 1.0, answers: None, reading });
    observation
}

fn write(observation: &mut Observation, meant: &Interpretation) {
    observation.readings[0] = WireReading::new(meant).0;
}

/// The reducer without its shell: neither journal nor shared memory.
pub(crate) fn step(times: u32) {
    let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config"));
    let settings = Settings::load(config, None, &[]).expect("the shipped configuration");
    let manager = settings.manager().expect("its manager");
    let mut node = PolicyNode::recover(manager.into(), Vec::new()).expect("a first start");
    let mut seq = 0;
    for _ in 0..times {
        for (words, intent) in [(&["white"][..], Intent::Inform), (&[], Intent::Cancel)] {
            seq += 1;
            let message = MessageRef::from(observation(&settings.scene, seq, words, intent));
            let mut effects = Effects::default();
            node.on(Event::Message(In::Observation(message)), Time(seq << 30), &mut effects);
            let outputs: Vec<Out> = effects.take_outputs();
            assert_eq!((effects.take_records().len(), outputs.is_empty()), (1, false), "{seq}");
            black_box(outputs);
        }
    }
}

pub(crate) fn fixed(times: u32) {
    let scene = bowls();
    let words = scene.words().len();
    let mut observation = observation(&scene, 1, &["white", "plastic"], Intent::Inform);
    observation.asked_count = 1;
    observation.asked[0] = AskedQuestion { prompt: 1, whole: 1, ..AskedQuestion::default() };
    for _ in 0..times {
        let read = black_box(&observation).interpretations(words).expect("a valid message");
        write(&mut observation, black_box(&read[0]));
    }
}

pub(crate) fn encoded(times: u32) {
    let question = Question::Attribute(AttributeId(1), ValueId(2));
    let actions = (0..4).map(|n| (Action::Pick(ObjectId(n)), 1.0 / f64::from(n + 1)));
    let mut view = PolicyView {
        belief: vec![1.0 / 6.0; 6],
        question,
        text: "Is it on the counter?".to_owned(),
        decision: ActKind::Ask,
        alternatives: actions.collect(),
        bounds: Some((33.9732, 33.9735)),
        planner: "lookahead".to_owned(),
        ..PolicyView::default()
    };
    let mut bytes = [0; 1024];
    for _ in 0..times {
        let written = postcard::to_slice(black_box(&view), &mut bytes).expect("room for a view");
        view = postcard::from_bytes(black_box(written)).expect("a valid message");
    }
}
