//! Places of the records of a file: a record begins with its kind and its length.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

use mcap::MAGIC;
use mcap::records::op;

/// A record that claims more has a damaged length; one that claims less but too much is cut off.
const FRAME_BYTES_MAX: u64 = 1 << 40;

/// Bytes of a record's kind and length.
pub(crate) const HEAD_BYTES: u64 = 9;

/// Number of consecutive whole records at which reading continues after damage.
const CHAIN: usize = 3;

/// Bytes that are searched at once for such a place.
const WINDOW_BYTES: usize = 64 << 10;

/// The place of a record in a file.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) at: u64,
    pub(crate) kind: u8,
    pub(crate) bytes: u64,
}

impl Frame {
    pub(crate) fn end(self) -> u64 {
        self.at + HEAD_BYTES + self.bytes
    }
}

/// Content found at a position of a file.
pub(crate) enum Found {
    Record(Frame),
    /// The end of the file, perhaps with a part of a record before it.
    End,
    Damage,
}

/// The frames of a file.
#[derive(Clone, Copy)]
pub(crate) struct Frames<'a> {
    pub(crate) file: &'a File,
    pub(crate) size: u64,
}

impl Frames<'_> {
    pub(crate) fn at(self, at: u64) -> io::Result<Found> {
        let left = self.size.saturating_sub(at);
        if left < HEAD_BYTES {
            return Ok(Found::End);
        }
        let mut head = [0; HEAD_BYTES as usize];
        self.file.read_exact_at(&mut head, at)?;
        Ok(match frame(&head, at) {
            Some(frame) if frame.end() <= self.size => Found::Record(frame),
            Some(_) => Found::End,
            None => Found::Damage,
        })
    }

    pub(crate) fn content(self, frame: Frame) -> io::Result<Vec<u8>> {
        let mut content = vec![0; frame.bytes as usize];
        self.file.read_exact_at(&mut content, frame.at + HEAD_BYTES)?;
        Ok(content)
    }

    /// The next position from `at` on with consecutive whole records.
    pub(crate) fn next(self, mut at: u64) -> io::Result<Option<u64>> {
        let mut window = vec![0; WINDOW_BYTES];
        while self.size.saturating_sub(at) >= HEAD_BYTES {
            let bytes = WINDOW_BYTES.min((self.size - at) as usize);
            self.file.read_exact_at(&mut window[..bytes], at)?;
            for (offset, head) in window[..bytes].windows(HEAD_BYTES as usize).enumerate() {
                let place = at + offset as u64;
                let is_whole = frame(head, place).is_some_and(|it| it.end() <= self.size);
                if is_whole && self.is_chain(place)? {
                    return Ok(Some(place));
                }
            }
            at += (bytes as u64 + 1) - HEAD_BYTES;
        }
        Ok(None)
    }

    /// Returns whether the file's end is there: a footer has nine bytes, like some damaged lengths.
    fn is_last(self, at: u64) -> io::Result<bool> {
        let mut magic = [0; MAGIC.len()];
        let read = self.file.read_at(&mut magic, at)?;
        Ok(magic[..read] == *MAGIC)
    }

    pub(crate) fn is_chain(self, mut at: u64) -> io::Result<bool> {
        for _ in 0..CHAIN {
            match self.at(at)? {
                Found::Record(frame) if frame.kind == op::FOOTER => {
                    return self.is_last(frame.end());
                }
                Found::Record(frame) => at = frame.end(),
                Found::End => return Ok(at == self.size),
                Found::Damage => return Ok(false),
            }
        }
        Ok(true)
    }
}

/// The record that these bytes at `at` begin, if they can.
pub(crate) fn frame(head: &[u8], at: u64) -> Option<Frame> {
    let (&kind, length) = head.split_first()?;
    let bytes = u64::from_le_bytes(length.try_into().ok()?);
    // The fixed part of each kind.
    let least = match kind {
        op::FOOTER | op::DATA_END => {
            let whole = if kind == op::FOOTER { 20 } else { 4 };
            return (bytes == whole).then_some(Frame { at, kind, bytes });
        }
        op::HEADER | op::METADATA => 8,
        op::METADATA_INDEX => 20,
        op::SCHEMA => 14,
        op::CHANNEL => 12,
        op::MESSAGE => 22,
        op::CHUNK => 40,
        op::MESSAGE_INDEX => 6,
        op::CHUNK_INDEX => 60,
        op::ATTACHMENT | op::ATTACHMENT_INDEX => 36,
        op::STATISTICS => 46,
        op::SUMMARY_OFFSET => 17,
        // Kinds of applications.
        0x80.. => 0,
        _ => return None,
    };
    (least..=FRAME_BYTES_MAX).contains(&bytes).then_some(Frame { at, kind, bytes })
}

/// The length of a chunk, an attachment or an index by the lengths in it; `None` if it has no room
/// for these lengths, as [`parse_record`] assumes.
pub(crate) fn own_length(kind: u8, content: &[u8]) -> Option<usize> {
    let number = |at: usize| content.get(at..at + 8)?.try_into().ok().map(u64::from_le_bytes);
    let text = |at: usize| {
        let length = content.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes)?;
        Some(at + 4 + length as usize)
    };
    if kind == op::MESSAGE_INDEX {
        return text(2).filter(|end| *end <= content.len());
    }
    let (size, sum) = match kind {
        // Two times, size and sum of the content; compression.
        op::CHUNK => (text(28)?, 0),
        // Two times; name and media type. Its sum is at the end.
        _ => (text(16).and_then(text)?, 4),
    };
    let data = usize::try_from(number(size)?).ok()?;
    let end = size.checked_add(8 + sum)?.checked_add(data)?;
    (end <= content.len()).then_some(end)
}
