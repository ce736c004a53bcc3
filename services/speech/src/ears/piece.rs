//! A piece of a sound: whose it is, which of how many, and when it was said.

use crate::Segment;
use crate::listening::Listened;
use messages::{RequestKey, Source};
use service::{Span, Time};

/// A piece of a sound.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) key: RequestKey,
    pub(super) segment: (u32, u32),
    pub(super) source: Source,
    /// Begin and end, where anything was heard.
    pub(super) span: (Time, Time),
    pub(super) snr_db: f32,
}

impl Piece {
    /// Text, or whatever else comes whole.
    pub(super) fn whole(key: RequestKey, span: (Time, Time)) -> Self {
        Self { key, segment: (0, 1), source: Source::Text, span, snr_db: 0.0 }
    }

    /// A client's stream as such.
    pub(super) fn of_stream(key: RequestKey) -> Self {
        let nothing = (Time(0), Time(0));
        Self { source: Source::Microphone, ..Self::whole(key, nothing) }
    }

    /// Piece `number` of `count` of a sound; of a live one that is a piece itself all there is.
    pub(super) fn of(listened: &Listened, number: u32, count: u32) -> Self {
        let segment = listened.segment.unwrap_or((number, count));
        let span = (listened.onset, listened.end.unwrap_or(Time(0)));
        Self { key: listened.key, segment, source: listened.source, span, snr_db: 0.0 }
    }

    /// The piece with what was measured. Of a live sound the times are known, those in a recording
    /// count from its beginning.
    pub(super) fn cut(self, segment: &Segment, now: Time) -> Self {
        let at = |s: f64| (self.span.0 + Span::from_s(s)).min(now);
        let recorded = (at(segment.span_s.0), at(segment.span_s.1));
        let span = if self.span.1 == Time(0) { recorded } else { self.span };
        Self { span, snr_db: segment.snr_db, ..self }
    }
}
