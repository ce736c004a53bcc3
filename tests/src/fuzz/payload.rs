//! Bytes of the payloads of variable size.

use messages::{Hypothesis, Injection, PolicyView, RequestKey, Sound, TrajectoryView, WorldView};
use serde::{Serialize, de::DeserializeOwned};

use super::bytes::{Input, chosen};

const KINDS: [fn(&[u8]); 4] =
    [check::<Injection>, check::<PolicyView>, check::<WorldView>, check::<TrajectoryView>];

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    KINDS[usize::from(input.byte()) % KINDS.len()](input.0);
}

/// What decodes encodes to bytes that decode to the same.
fn check<T: Serialize + DeserializeOwned + std::fmt::Debug>(bytes: &[u8]) {
    let Ok(payload) = postcard::from_bytes::<T>(bytes) else { return };
    let _ = format!("{payload:?}");
    let encoded = postcard::to_stdvec(&payload).expect("what was decoded encodes");
    let again: T = postcard::from_bytes(&encoded).expect("what was encoded decodes");
    // As bytes: numbers that are none equal nothing.
    assert_eq!(postcard::to_stdvec(&again).expect("it did before"), encoded);
}

/// One injection of each kind.
pub(super) fn injections() -> Vec<Injection> {
    let heard = Hypothesis {
        weight: 0.5,
        word_confidence: vec![0.5, 1.0],
        ..Hypothesis::certain("the red")
    };
    let sounds = [
        Sound::Text("the small white bowl".to_owned()),
        Sound::Wav("/tmp/ask.wav".to_owned()),
        Sound::Point { target_m: [0.7, 0.1, -0.1], words: "that one".to_owned() },
        Sound::Talk { longest_s: 8.0 },
        Sound::Transcript { hypotheses: vec![heard, Hypothesis::certain("yes")] },
    ];
    let injection = |(n, sound)| Injection {
        key: RequestKey([n; 16]),
        onset_ns: 5,
        end_ns: 9,
        seen_prompt: 3,
        from: "Ann".to_owned(),
        sound,
    };
    (1..).zip(sounds).map(injection).collect()
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let encode = |kind, payload: Result<Vec<u8>, postcard::Error>| {
        chosen(kind, payload.expect("a payload encodes"))
    };
    let mut seeds: Vec<_> =
        injections().iter().map(|one| encode(0, postcard::to_stdvec(one))).collect();
    let view = PolicyView {
        belief: vec![0.25; 4],
        text: "Is it white?".to_owned(),
        bounds: Some((1.0, 2.0)),
        ..PolicyView::default()
    };
    seeds.push(encode(1, postcard::to_stdvec(&view)));
    let world =
        WorldView { objects: vec![None, Some([0.5; 7])], held: Some(1), ..WorldView::default() };
    seeds.push(encode(2, postcard::to_stdvec(&world)));
    let phase = messages::PhaseWay {
        phase: messages::MotionPhase::Approach,
        points_m: vec![[0.1; 3]],
        t_s: vec![0.0],
    };
    let way = TrajectoryView { phases: vec![phase], ..TrajectoryView::default() };
    seeds.push(encode(3, postcard::to_stdvec(&way)));
    seeds
}
