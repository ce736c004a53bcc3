//! Reading a whole file back: the valid records, and how the file ends.

use serde::de::DeserializeOwned;

use crate::JournalOpenError;
use crate::frame::{self, FRAME_BYTES_MIN, Frame, PREFIX_BYTES};
use crate::header::StoredHeader;

/// Endings of a journal file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The data end with a complete frame.
    Whole,
    /// The data end with a write that was never acknowledged; opening the journal cuts it off.
    Torn {
        /// Offset of the torn frame.
        at: u64,
        /// Bytes from there to the end of the file.
        bytes: u64,
    },
    /// The data end with records that had been acknowledged and can no longer be reached.
    Corrupt {
        /// Offset of the damaged frame.
        at: u64,
        /// Number of the first record that cannot be read.
        seq: u64,
        /// Offset of the next valid frame, or of the end of the file.
        resumes_at: u64,
    },
}

/// Records and positions found by a scan before the ending.
#[derive(Debug)]
pub(crate) struct Scan<R> {
    pub(crate) records: Vec<R>,
    pub(crate) position: Position,
    pub(crate) ending: Ending,
}

/// Position of the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    /// Offset in the file.
    pub(crate) end: u64,
    /// Number of the next record.
    pub(crate) next_seq: u64,
    /// Checksum that the next frame refers to.
    pub(crate) prev_crc: u32,
}

impl Position {
    /// The place right after a header.
    pub(crate) fn after(stored: &StoredHeader) -> Self {
        Self { end: stored.len as u64, next_seq: stored.first_seq, prev_crc: stored.crc }
    }

    fn continues_with(&self, frame: &Frame) -> bool {
        frame.seq == self.next_seq && frame.prev_crc == self.prev_crc
    }

    fn advance(&mut self, frame: &Frame, records: usize) {
        self.end += frame.len as u64;
        self.next_seq += records as u64;
        self.prev_crc = frame.crc;
    }
}

/// Reads every record of a file, up to the first frame that is not valid in its place.
///
/// # Errors
/// `Undecodable`; damage is not an error but an [`Ending`].
pub(crate) fn scan<R: DeserializeOwned>(
    bytes: &[u8],
    stored: &StoredHeader,
) -> Result<Scan<R>, JournalOpenError> {
    let mut records = Vec::new();
    let (position, ending) = scan_frames(bytes, stored, |frame| {
        let batch = decode::<R>(frame)?;
        let count = batch.len();
        records.extend(batch);
        Some(count)
    })?;
    Ok(Scan { records, position, ending })
}

/// As [`scan`], without decoding the records: `take` gets each frame and returns how many it holds.
pub(crate) fn scan_frames(
    bytes: &[u8],
    stored: &StoredHeader,
    mut take: impl FnMut(&Frame) -> Option<usize>,
) -> Result<(Position, Ending), JournalOpenError> {
    let mut position = Position::after(stored);
    let ending = loop {
        let rest = &bytes[position.end as usize..];
        if rest.is_empty() {
            break Ending::Whole;
        }
        let next = frame::parse(position.end, rest, |seq| seq == position.next_seq);
        let Some(frame) = next.filter(|frame| position.continues_with(frame)) else {
            break ending_of(rest, &position);
        };
        let count = take(&frame)
            .ok_or(JournalOpenError::Undecodable { at: position.end, seq: position.next_seq })?;
        position.advance(&frame, count);
    };
    // A snapshot was on the disk before its file had the journal's name.
    let is_short = position.next_seq < stored.first_seq.saturating_add(stored.snapshot);
    let (at, seq, resumes_at) = (position.end, position.next_seq, bytes.len() as u64);
    match ending {
        Ending::Whole | Ending::Torn { .. } if is_short => {
            Ok((position, Ending::Corrupt { at, seq, resumes_at }))
        }
        ending => Ok((position, ending)),
    }
}

/// Number of records in a frame, for those who cannot decode them.
pub(crate) fn count(frame: &Frame) -> Option<usize> {
    postcard::take_from_bytes::<usize>(&frame.body).ok().map(|(count, _)| count)
}

/// Distinguishes a torn tail from corruption: each frame is written only after the one before was
/// acknowledged, so a valid frame proves that everything before it was valid; and a frame that is
/// there to its last byte has no reason to be wrong.
fn ending_of(rest: &[u8], position: &Position) -> Ending {
    let at = position.end;
    let expected = position.next_seq;
    let plausible = |seq| seq >= expected && seq - expected <= u64::from(u32::MAX);
    let last_start = rest.len().saturating_sub(PREFIX_BYTES);
    // No frame begins within the shortest one. Without this, a frame of which a sector's last byte
    // was the first and is lost would be found again one byte later, behind the next sector's mark.
    let starts = std::iter::once(0).chain(FRAME_BYTES_MIN..=last_start);
    let valid = |i: &usize| frame::parse(at + *i as u64, &rest[*i..], plausible).is_some();
    let end = rest.len();
    let complete = || frame::was_complete(at, rest).then_some(end);
    match starts.into_iter().find(valid).or_else(complete) {
        Some(i) => Ending::Corrupt { at, seq: expected, resumes_at: at + i as u64 },
        None => Ending::Torn { at, bytes: end as u64 },
    }
}

fn decode<R: DeserializeOwned>(frame: &Frame) -> Option<Vec<R>> {
    match postcard::take_from_bytes(&frame.body) {
        Ok((records, [])) => Some(records),
        _ => None,
    }
}
