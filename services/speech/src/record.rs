//! Journal records of the speech service.

use messages::{
    AskedQuestion, FixedText, Receipt, ReceiptStatus, RequestKey, Source, Utterance, UtteranceSeq,
};
use serde::{Deserialize, Serialize};
use service::Time;
use vocabulary::{PersonId, Presentation};

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
    /// Number of the utterance.
    pub seq: UtteranceSeq,
    /// The client's key.
    pub key: RequestKey,
    /// Number and total of the segment in the client's sound.
    pub segment: (u32, u32),
    /// Hypotheses, most likely first; empty for a gesture without words.
    pub hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// The channel, and who spoke.
    pub origin: Origin,
    /// The latest questions whose sound had begun by then, newest first.
    pub asked: Vec<Presentation>,
    /// When the speech began.
    pub onset: Time,
    /// When the speech ended.
    pub end: Time,
    /// Signal-to-noise ratio, decibels; 0 for text.
    pub snr_db: f32,
    /// Time at which the utterance was accepted.
    pub accepted: Time,
}

/// The channel of an utterance, and the person who spoke as far as that is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "StoredOrigin", into = "StoredOrigin")]
pub struct Origin {
    /// The channel.
    pub source: Source,
    /// The person.
    pub from: PersonId,
}

/// An origin in a journal; earlier ones have a [`Source`], which the same bytes encode.
#[derive(Serialize, Deserialize)]
enum StoredOrigin {
    Text,
    Wav,
    Microphone,
    Browser,
    Gesture,
    From(Source, PersonId),
}

impl From<StoredOrigin> for Origin {
    fn from(stored: StoredOrigin) -> Self {
        match stored {
            StoredOrigin::Text => Source::Text.into(),
            StoredOrigin::Wav => Source::Wav.into(),
            StoredOrigin::Microphone => Source::Microphone.into(),
            StoredOrigin::Browser => Source::Browser.into(),
            StoredOrigin::Gesture => Source::Gesture.into(),
            StoredOrigin::From(source, from) => Self { source, from },
        }
    }
}

impl From<Origin> for StoredOrigin {
    fn from(Origin { source, from }: Origin) -> Self {
        match source {
            source if !from.is_nobody() => Self::From(source, from),
            Source::Text => Self::Text,
            Source::Wav => Self::Wav,
            Source::Microphone => Self::Microphone,
            Source::Browser => Self::Browser,
            Source::Gesture => Self::Gesture,
        }
    }
}

impl From<Source> for Origin {
    fn from(source: Source) -> Self {
        Self { source, from: PersonId::default() }
    }
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
            source: self.origin.source.into(),
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
            source: self.origin.source.into(),
            from: FixedText::truncated(self.origin.from.as_str()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origin_in_a_journal_is_the_source_alone_where_nobody_is_known() {
        for source in
            [Source::Text, Source::Wav, Source::Microphone, Source::Browser, Source::Gesture]
        {
            let bytes = postcard::to_stdvec(&source).unwrap();
            let nobody = Origin::from(source);
            assert_eq!(postcard::to_stdvec(&nobody).unwrap(), bytes, "{source:?}");
            assert_eq!(postcard::from_bytes::<Origin>(&bytes).unwrap(), nobody);
            let ann = Origin { source, from: PersonId::new("Ann").unwrap() };
            let bytes = postcard::to_stdvec(&ann).unwrap();
            assert_eq!(postcard::from_bytes::<Origin>(&bytes).unwrap(), ann);
        }
    }
}
