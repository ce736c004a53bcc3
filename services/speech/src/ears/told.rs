//! What others are told of an accepted utterance.

use crate::record::{Accepted, Hypothesis, Said};
use crate::said::in_words;
use messages::{AskedQuestion, FixedText, Receipt, ReceiptStatus, Utterance};

/// The answer to the client who gave it.
pub(super) fn receipt(accepted: &Accepted) -> Receipt {
    let best = accepted.hypotheses.first();
    let text = best.map_or("", |best| best.text.as_str());
    let total: f64 = accepted.hypotheses.iter().map(|heard| heard.weight).sum();
    let confidence = best.map_or(1.0, |best| best.weight / total);
    Receipt {
        key: accepted.key.0,
        seq: accepted.seq.0,
        segment: accepted.segment.0,
        segments: accepted.segment.1,
        onset_ns: accepted.onset.ns(),
        end_ns: accepted.end.ns(),
        confidence: confidence as f32,
        snr_db: accepted.snr_db,
        status: ReceiptStatus::Accepted.code(),
        source: accepted.source.into(),
        note: FixedText::truncated(&in_words(text, accepted.gesture)),
        ..Receipt::default()
    }
}

/// What grounding is told.
pub(super) fn utterance(accepted: &Accepted) -> Utterance {
    let mut utterance = Utterance {
        seq: accepted.seq.0,
        gesture: accepted.gesture.into(),
        onset_ns: accepted.onset.ns(),
        end_ns: accepted.end.ns(),
        accepted_ns: accepted.accepted.ns(),
        source: accepted.source.into(),
        ..Utterance::default()
    };
    let asked: Vec<AskedQuestion> = accepted.asked.iter().map(asked_question).collect();
    utterance.set_asked(&asked);
    let heard: Vec<messages::Hypothesis<'_>> = (accepted.hypotheses.iter())
        .map(|Hypothesis { text, weight, confidence }| {
            let confidence = confidence.clone();
            messages::Hypothesis { text, weight: *weight, confidence }
        })
        .collect();
    if utterance.set_hypotheses(&heard).is_err() {
        // The best one fits (it was checked when it was accepted); the others are a refinement.
        let best = heard.get(..1).unwrap_or_default();
        let fitted = utterance.set_hypotheses(best);
        debug_assert!(fitted.is_ok(), "an accepted utterance fits");
    }
    utterance
}

fn asked_question(said: &Said) -> AskedQuestion {
    AskedQuestion {
        prompt: said.prompt.0,
        scene: said.scene_key,
        began_ns: said.started.ns(),
        ended_ns: if said.whole || said.ended > said.started { said.ended.ns() } else { 0 },
        question: said.question.into(),
        presentation: said.presentation,
        whole: u8::from(said.whole),
        ..AskedQuestion::default()
    }
}
