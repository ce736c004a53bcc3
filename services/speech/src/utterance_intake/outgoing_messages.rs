//! Messages about utterances.

use super::origin::Origin;
use crate::record::Accepted;
use crate::utterance_content::as_text;
use messages::{AskedQuestion, FixedText, Receipt, ReceiptStatus, Utterance};

/// Returns the receipt for the client of an accepted utterance.
pub(super) fn receipt(accepted: &Accepted) -> Receipt {
    let best = accepted.hypotheses.first();
    let text = best.map_or("", |best| best.text.as_str());
    let total: f64 = accepted.hypotheses.iter().map(|hypothesis| hypothesis.weight).sum();
    Receipt {
        key: accepted.key.0,
        seq: accepted.seq.0,
        segment: accepted.segment.0,
        segments: accepted.segment.1,
        onset_ns: accepted.onset.ns(),
        end_ns: accepted.end.ns(),
        confidence: best.map_or(1.0, |best| best.weight / total) as f32,
        snr_db: accepted.snr_db,
        status: ReceiptStatus::Accepted.code(),
        source: accepted.source.into(),
        note: FixedText::truncated(&as_text(text, accepted.gesture)),
        ..Receipt::default()
    }
}

/// Returns the receipt for a sound without a new utterance.
pub(super) fn rejection(origin: &Origin, status: ReceiptStatus, note: &str) -> Receipt {
    Receipt {
        key: origin.key.0,
        segment: origin.segment.0,
        segments: origin.segment.1,
        onset_ns: origin.span.0.ns(),
        end_ns: origin.span.1.ns(),
        snr_db: origin.snr_db,
        status: status.code(),
        source: origin.source.code(),
        note: FixedText::truncated(note),
        ..Receipt::default()
    }
}

/// Returns the message to grounding.
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
    let asked: Vec<AskedQuestion> = accepted.asked.iter().map(AskedQuestion::from).collect();
    utterance.set_asked(&asked);
    let hypotheses = &accepted.hypotheses;
    if utterance.set_hypotheses(hypotheses).is_err() {
        // The best one fits (its length was checked); the others are a refinement.
        let fitted = utterance.set_hypotheses(hypotheses.get(..1).unwrap_or_default());
        debug_assert!(fitted.is_ok(), "an accepted utterance fits");
    }
    utterance
}
