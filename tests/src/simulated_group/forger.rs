//! Forged messages: well-typed, with numbers and contents that no service of the group sends. What
//! could be true (the next number from the only writer) is not among them: that is believed.

use messages::judge::COUNT_MAX;
use messages::{
    ActKind, Activity, AppliedMark, ArmStatus, Code, FixedText, Hypothesis, Injection, MessageRef,
    MotionOrder, Observation, PickOutcome, PickPhase, PresentationState, Presented, RequestKey,
    RobotAct, Sound, Utterance, WireCode, WireQuestion,
};
use vocabulary::Rng;

use service::Time;
use service::stop_socket::{Caller, StopOrder};

use super::SimulatedGroup;

/// Probability of a forged message for each service in a step.
const FORGED: f64 = 0.2;

impl SimulatedGroup {
    /// Forges messages between the valid ones, by this seed.
    #[must_use]
    pub fn with_forger(mut self, seed: u64) -> Self {
        self.forger = Some(Rng::new(seed));
        self
    }

    pub(super) fn forge(&mut self) {
        let Some(mut rng) = self.forger.take() else { return };
        let scene_key = self.scene().key();
        if rng.uniform() < FORGED {
            let forged = to_speech(&mut rng, scene_key);
            insert(&mut self.inboxes.speech, forged, &mut rng);
        }
        if rng.uniform() < FORGED {
            let forged = grounding::In::Utterance(utterance(&mut rng).into());
            insert(&mut self.inboxes.grounding, forged, &mut rng);
        }
        if rng.uniform() < FORGED {
            let forged = to_policy(&mut rng, scene_key);
            insert(&mut self.inboxes.policy, forged, &mut rng);
        }
        if rng.uniform() < FORGED {
            let forged = to_arm(&mut rng, scene_key);
            insert(&mut self.inboxes.arm, forged, &mut rng);
        }
        self.forger = Some(rng);
    }
}

fn insert<T>(inbox: &mut Vec<T>, forged: T, rng: &mut Rng) {
    inbox.insert(rng.below(inbox.len() + 1), forged);
}

/// A number that nothing counts to, or none at all.
fn number(rng: &mut Rng) -> u64 {
    match rng.below(6) {
        0 => 0,
        1 => u64::MAX,
        2 => u64::MAX - 1,
        3 => COUNT_MAX + 1,
        4 => 1 << 63,
        _ => COUNT_MAX << rng.below(11),
    }
}

fn small(rng: &mut Rng) -> u32 {
    [0, 1, u32::MAX, 1 << 31][rng.below(4)]
}

fn share(rng: &mut Rng) -> f64 {
    [f64::NAN, f64::INFINITY, -1.0, f64::MAX, 2.0][rng.below(5)]
}

/// A code, mostly none.
fn code<E: WireCode>(rng: &mut Rng) -> Code<E> {
    Code::from_raw(rng.below(256) as u8)
}

fn question(rng: &mut Rng) -> WireQuestion {
    let part = |rng: &mut Rng| [0, 1, u16::MAX][rng.below(3)];
    WireQuestion {
        kind: [0, 1, 4, u16::MAX][rng.below(4)],
        object: part(rng),
        attribute: part(rng),
        value: part(rng),
    }
}

/// An act with numbers of the past or of nowhere.
fn act(rng: &mut Rng, scene_key: u64) -> Box<RobotAct> {
    let kind = [ActKind::Ask, ActKind::Say, ActKind::Pick, ActKind::Cancel][rng.below(4)];
    Box::new(RobotAct {
        act: COUNT_MAX + 1 + rng.below(9) as u64,
        interaction: number(rng),
        prompt: number(rng),
        presentation: small(rng),
        kind: kind.into(),
        question: question(rng),
        object: small(rng),
        attempt: small(rng),
        scene_key: if rng.below(2) == 0 { scene_key } else { number(rng) },
        decided_ns: number(rng),
        utterance: number(rng),
        text: FixedText::truncated("\u{1b}[2Jforged"),
        ..RobotAct::default()
    })
}

fn status(rng: &mut Rng) -> ArmStatus {
    ArmStatus {
        interaction: number(rng),
        aimed_act: COUNT_MAX + number(rng) / 2,
        attempt: small(rng),
        object: small(rng),
        phase: PickPhase::Done.into(),
        outcome: PickOutcome::Delivered.into(),
        remaining_s: share(rng),
        ..ArmStatus::default()
    }
}

fn to_speech(rng: &mut Rng, scene_key: u64) -> speech::In<'static> {
    match rng.below(4) {
        0 => speech::In::Mark(AppliedMark { seq: number(rng) }),
        1 => speech::In::Act(act(rng, scene_key).into()),
        2 => speech::In::Arm(status(rng)),
        _ => speech::In::Injection(injection(rng)),
    }
}

/// A request that has to be refused.
fn injection(rng: &mut Rng) -> Injection {
    let heard = |weight| Hypothesis { weight, ..Hypothesis::certain("the clear bowl") };
    let sound = match rng.below(6) {
        0 => Sound::Text(" \n\t".to_owned()),
        1 => Sound::Text("bowl ".repeat(1 << 14)),
        2 => Sound::Talk { longest_s: share(rng) * 100.0 },
        3 => Sound::Point { target_m: [f64::MAX, 0.0, share(rng)], words: String::new() },
        4 => Sound::Transcript { hypotheses: vec![heard(f64::MAX), heard(f64::MAX)] },
        _ => Sound::Transcript {
            hypotheses: vec![Hypothesis { word_confidence: vec![2.0; 9], ..heard(1.0) }],
        },
    };
    let mut key = [0xff; 16];
    key[..8].copy_from_slice(&(rng.uniform() * 1e18).to_le_bytes());
    Injection {
        key: RequestKey(key),
        onset_ns: number(rng),
        end_ns: number(rng),
        seen_prompt: number(rng),
        from: ["", "Ann", "a\nb"][rng.below(3)].to_owned(),
        sound,
    }
}

fn utterance(rng: &mut Rng) -> Utterance {
    let mut forged = Utterance {
        seq: number(rng),
        onset_ns: number(rng),
        end_ns: number(rng),
        accepted_ns: number(rng),
        source: code(rng),
        hypothesis_count: rng.below(256) as u8,
        asked_count: rng.below(256) as u8,
        text: FixedText::truncated("the clear bowl"),
        ..Utterance::default()
    };
    for hypothesis in &mut forged.hypotheses {
        (hypothesis.start, hypothesis.len) = (small(rng), small(rng));
        hypothesis.weight = share(rng);
    }
    for asked in &mut forged.asked {
        asked.question = question(rng);
        (asked.prompt, asked.began_ns) = (number(rng), number(rng));
    }
    forged
}

fn to_policy(rng: &mut Rng, scene_key: u64) -> policy::In<'static> {
    match rng.below(4) {
        0 => policy::In::Arm(status(rng)),
        1 => policy::In::Activity(Activity {
            onset_ns: number(rng),
            pending: small(rng),
            ear: code(rng),
            ..Activity::default()
        }),
        2 => policy::In::Presented(Presented {
            prompt: number(rng),
            started_ns: number(rng),
            ended_ns: number(rng),
            presentation: small(rng),
            state: PresentationState::Ended.into(),
            ..Presented::default()
        }),
        _ => policy::In::Observation(MessageRef::from(observation(rng, scene_key))),
    }
}

/// One with any number, and no content that makes sense.
fn observation(rng: &mut Rng, scene_key: u64) -> Observation {
    let mut forged = Observation {
        seq: if rng.below(2) == 0 { number(rng) } else { rng.below(20) as u64 },
        scene_key,
        onset_ns: number(rng),
        end_ns: number(rng),
        accepted_ns: number(rng),
        reading_count: [0, 1, u8::MAX][rng.below(3)],
        asked_count: [0, 1, u8::MAX][rng.below(3)],
        ..Observation::default()
    };
    for reading in &mut forged.readings {
        reading.weight = share(rng);
        reading.question = rng.below(256) as u8;
        reading.base_count = rng.below(256) as u8;
        reading.base = [u16::MAX; messages::BASE_WORDS_MAX];
    }
    forged
}

fn to_arm(rng: &mut Rng, scene_key: u64) -> arm::In<'static> {
    match rng.below(2) {
        0 => arm::In::Act(act(rng, scene_key).into()),
        _ => {
            let given_ns = COUNT_MAX << rng.below(11);
            let order = StopOrder::new(MotionOrder::Resume, Time(given_ns));
            arm::In::StopOrder(order, Caller::named(b"a forger"))
        }
    }
}
