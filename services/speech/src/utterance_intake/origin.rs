//! Origin of an utterance: its request, segment, source and time.

use crate::RecognisedSegment;
use crate::hearing::{Heard, SecondView};
use crate::pending_sounds::PendingSound;
use crate::record::{self, Accepted};
use crate::utterance_content::UtteranceContent;
use messages::{
    FixedText, Injection, Receipt, ReceiptStatus, RequestKey, SecondState, Source, UtteranceSeq,
};
use service::{Span, Time};
use vocabulary::ids::PromptId;
use vocabulary::{PersonId, Presentation};

/// Origin of an utterance.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Origin {
    pub(super) key: RequestKey,
    /// Number and total of the segment.
    pub(super) segment: (u32, u32),
    pub(super) source: Source,
    /// Person who typed or pointed.
    pub(super) from: PersonId,
    /// Beginning and end of the speech, 0 without speech.
    pub(super) span: (Time, Time),
    /// The latest prompt that the user was shown before; 0 if unknown.
    pub(super) seen: PromptId,
    /// Signal-to-noise ratio, decibels; 0 for text.
    pub(super) snr_db: f32,
    /// Result of each recogniser, if sound was recognised.
    pub(super) heard: Option<Heard>,
}

impl Origin {
    /// Returns the origin of an injected text: it was typed when its client reports, otherwise now.
    pub(super) fn of_injection(injection: &Injection, now: Time) -> Self {
        let reported = |ns: u64| if ns == 0 { now } else { Time(ns).min(now) };
        let onset = reported(injection.onset_ns);
        let span = (onset, reported(injection.end_ns).max(onset));
        let seen = PromptId(injection.seen_prompt);
        Self { span, seen, ..Self::new(injection.key, (0, 1), Source::Text) }
    }

    /// Returns the origin for the end of a client's stream.
    pub(super) fn closed(key: RequestKey, utterances: u32) -> Self {
        Self::new(key, (u32::MAX, utterances), Source::Microphone)
    }

    /// Returns the origin of segment `number` of `count` in a sound; a live sound is one segment.
    pub(super) fn of(sound: &PendingSound, number: u32, count: u32) -> Self {
        let segment = sound.segment.unwrap_or((number, count));
        let span = (sound.onset, sound.end.unwrap_or(Time(0)));
        Self { span, ..Self::new(sound.key, segment, sound.source) }
    }

    fn new(key: RequestKey, segment: (u32, u32), source: Source) -> Self {
        let (span, seen) = ((Time(0), Time(0)), PromptId(0));
        let from = PersonId::default();
        Self { key, segment, source, from, span, seen, snr_db: 0.0, heard: None }
    }

    /// Adds the recogniser's measurements. The times of a live sound are known; those of a
    /// recording count from its beginning.
    pub(super) fn measured(self, segment: &RecognisedSegment, now: Time) -> Self {
        let at = |s: f64| (self.span.0 + Span::from_s(s)).min(now);
        let recorded = (at(segment.span_s.0), at(segment.span_s.1));
        let span = if self.span.1 == Time(0) { recorded } else { self.span };
        Self { span, snr_db: segment.snr_db, heard: Some(segment.heard.clone()), ..self }
    }

    /// Adds each recogniser's result to the receipt.
    pub(super) fn with_views(&self, receipt: Receipt) -> Receipt {
        let Some(Heard { first, second }) = &self.heard else { return receipt };
        let first = first.hypotheses.first().map_or("", |best| best.text.as_str());
        let (second, text) = match second {
            SecondView::NotAsked => (SecondState::NotAsked, ""),
            SecondView::Late => (SecondState::Late, ""),
            SecondView::Heard(opinion) => (SecondState::Heard, opinion.text.as_str()),
        };
        let (first_text, second_text) = (FixedText::truncated(first), FixedText::truncated(text));
        Receipt { first_text, second: second.code(), second_text, ..receipt }
    }

    /// Returns the utterance with its content, and the questions that it may answer.
    pub(super) fn accepted(
        &self,
        seq: UtteranceSeq,
        UtteranceContent { hypotheses, gesture }: UtteranceContent,
        asked: Vec<Presentation>,
        now: Time,
    ) -> Accepted {
        let Self { key, segment, source, span: (onset, end), snr_db, .. } = *self;
        let from = self.from.clone();
        let accepted = now;
        Accepted {
            seq,
            key,
            segment,
            hypotheses,
            gesture,
            origin: record::Origin { source, from },
            asked,
            onset,
            end,
            snr_db,
            accepted,
        }
    }

    /// Returns the receipt for a request or sound without a new utterance.
    pub(super) fn rejection(&self, status: ReceiptStatus, note: &str) -> Receipt {
        self.with_views(Receipt {
            key: self.key.0,
            segment: self.segment.0,
            segments: self.segment.1,
            onset_ns: self.span.0.ns(),
            end_ns: self.span.1.ns(),
            snr_db: self.snr_db,
            status: status.code(),
            source: self.source.code(),
            note: FixedText::truncated(note),
            ..Receipt::default()
        })
    }
}
