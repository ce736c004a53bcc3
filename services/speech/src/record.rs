//! Journal records of the speech service.

use messages::{
    AskedQuestion, FixedText, Receipt, ReceiptStatus, RequestKey, Source, Utterance, UtteranceSeq,
};
use serde::{Deserialize, Serialize};
use service::Time;
use vocabulary::Presentation;

use crate::Hypothesis;
use crate::utterance_content::as_text;

/// A journal record of the speech service.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Record {
    /// An utterance was accepted. It will be applied exactly once.
    Accepted(Accepted),
    /// A prompt was spoken, to its end or until it was interrupted. Later answers may refer to it.
    Presented(Presentation),
    /// A user ordered a stop at that time.
    StopOrdered(Time),
    /// The arm has carried out the stop that was ordered at that time, or obeys a later order.
    StopSettled(Time),
}

/// An accepted utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accepted {
    /// Its number.
    pub seq: UtteranceSeq,
    /// The client's key.
    pub key: RequestKey,
    /// Number and total of the segment in the client's sound.
    pub segment: (u32, u32),
    /// Hypotheses, most likely first; none for a gesture without words.
    pub hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Origin of the utterance.
    pub source: Source,
    /// The latest questions whose sound had begun by then, newest first.
    pub asked: Vec<Presentation>,
    /// When the speech began.
    pub onset: Time,
    /// When the speech ended.
    pub end: Time,
    /// Signal-to-noise ratio, decibels; 0 for text.
    pub snr_db: f32,
    /// When it was accepted.
    pub accepted: Time,
}

impl Accepted {
    /// Returns the receipt for the client.
    pub(crate) fn receipt(&self) -> Receipt {
        let best = self.hypotheses.first();
        let text = best.map_or("", |best| best.text.as_str());
        let total: f64 = self.hypotheses.iter().map(|hypothesis| hypothesis.weight).sum();
        Receipt {
            key: self.key.0,
            seq: self.seq.0,
            segment: self.segment.0,
            segments: self.segment.1,
            onset_ns: self.onset.ns(),
            end_ns: self.end.ns(),
            confidence: best.map_or(1.0, |best| best.weight / total) as f32,
            snr_db: self.snr_db,
            status: ReceiptStatus::Accepted.code(),
            source: self.source.into(),
            note: FixedText::truncated(&as_text(text, self.gesture)),
            ..Receipt::default()
        }
    }

    /// Returns the message to grounding.
    pub(crate) fn utterance(&self) -> Utterance {
        let mut utterance = Utterance {
            seq: self.seq.0,
            gesture: self.gesture.into(),
            onset_ns: self.onset.ns(),
            end_ns: self.end.ns(),
            accepted_ns: self.accepted.ns(),
            source: self.source.into(),
            ..Utterance::default()
        };
        let asked: Vec<AskedQuestion> = self.asked.iter().map(AskedQuestion::from).collect();
        utterance.set_asked(&asked);
        if utterance.set_hypotheses(&self.hypotheses).is_err() {
            // The best one fits (its length was checked); the others are a refinement.
            let fitted = utterance.set_hypotheses(self.hypotheses.get(..1).unwrap_or_default());
            debug_assert!(fitted.is_ok(), "an accepted utterance fits");
        }
        utterance
    }
}
