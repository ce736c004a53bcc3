//! The start of the file: owner and kind of the journal.

use serde::{Deserialize, Serialize};

use crate::JournalOpenError;
use crate::error::FRESH;
use crate::frame::words;

/// Format number of the file layout that this version writes.
///
/// Format 1 had two more numbers in its header; format 2 lacked generation and frame ends.
pub const FORMAT: u32 = 3;

/// Magic, format, length and checksum before the header's body.
const PREFIX_BYTES: usize = 20;
const MAGIC: [u8; 8] = *b"WHICHJNL";

/// Owner and kind of a journal. All fields must match when it is reopened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// Kind of record with its version, e.g. `policy/4`: a changed layout has another kind.
    pub record: String,
    /// Name of the process group.
    pub group: String,
    /// Epoch of the group; numbers of different epochs are never compared.
    pub epoch: u64,
    /// Index of the journal in its service and epoch, from 1: a file that was set aside is not
    /// taken for its successor.
    pub generation: u64,
}

/// A header as stored in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct StoredHeader {
    pub(crate) header: Header,
    /// Number of the first record in this file; above 1 after a rotation.
    pub(crate) first_seq: u64,
    /// Number of records that the file began with.
    pub(crate) snapshot: u64,
    /// The checksum that the first frame refers to.
    pub(crate) crc: u32,
    /// Offset of the first frame.
    pub(crate) len: usize,
}

/// The bytes of a header and its checksum.
pub(crate) fn encode(
    header: &Header,
    first_seq: u64,
    snapshot: u64,
) -> Result<(Vec<u8>, u32), postcard::Error> {
    let body = postcard::to_stdvec(&(header, first_seq, snapshot))?;
    let len = u32::try_from(body.len()).map_err(|_| postcard::Error::SerializeBufferFull)?;
    let crc = checksum(FORMAT, &body);
    let mut bytes = Vec::with_capacity(PREFIX_BYTES + body.len());
    bytes.extend_from_slice(&MAGIC);
    for word in [FORMAT, len, crc] {
        bytes.extend_from_slice(&word.to_le_bytes());
    }
    bytes.extend_from_slice(&body);
    Ok((bytes, crc))
}

/// Reads the header at the start of a file.
///
/// # Errors
/// `Empty`, `NotAJournal`, `Foreign`, or `Corrupt { at: 0 }` if the checksum does not match.
pub(crate) fn decode(bytes: &[u8]) -> Result<StoredHeader, JournalOpenError> {
    let corrupt = || JournalOpenError::Corrupt { at: 0, seq: 1 };
    if bytes.is_empty() {
        return Err(JournalOpenError::Empty);
    }
    if !bytes.starts_with(&MAGIC) {
        return Err(JournalOpenError::NotAJournal);
    }
    let [format, len, crc] = words(&bytes[MAGIC.len()..]).ok_or_else(corrupt)?;
    if format != FORMAT {
        let what = format!("expected journal format {FORMAT}, found {format}; {FRESH}");
        return Err(JournalOpenError::Foreign(what));
    }
    let len = len as usize;
    let body = bytes.get(PREFIX_BYTES..PREFIX_BYTES + len);
    let body = body.filter(|body| checksum(format, body) == crc);
    let (header, first_seq, snapshot) =
        body.and_then(|body| postcard::from_bytes(body).ok()).ok_or_else(corrupt)?;
    Ok(StoredHeader { header, first_seq, snapshot, crc, len: PREFIX_BYTES + len })
}

impl Header {
    /// Rejects a journal of another owner, kind or generation than `expected`.
    ///
    /// # Errors
    /// `Foreign` or `Generation`.
    pub fn check(&self, expected: &Self) -> Result<(), JournalOpenError> {
        check(self, expected)
    }
}

fn check(found: &Header, expected: &Header) -> Result<(), JournalOpenError> {
    let what = if found.group != expected.group {
        let (ours, theirs) = (&expected.group, &found.group);
        format!(
            "expected a journal of group `{ours}`, found one of group `{theirs}`; help: give each \
             group its own state folder"
        )
    } else if found.record != expected.record {
        let (ours, theirs) = (&expected.record, &found.record);
        format!("expected records of kind `{ours}`, found `{theirs}`; {FRESH}")
    } else if found.epoch != expected.epoch {
        let (ours, theirs) = (expected.epoch, found.epoch);
        format!(
            "expected epoch {ours}, found a journal of epoch {theirs}; help: start a new epoch with \
             `whichone up --fresh`, which keeps the old file"
        )
    } else if found.generation != expected.generation {
        let (expected, found) = (expected.generation, found.generation);
        return Err(JournalOpenError::Generation { expected, found });
    } else {
        return Ok(());
    };
    Err(JournalOpenError::Foreign(what))
}

fn checksum(format: u32, body: &[u8]) -> u32 {
    crc32c::crc32c_append(crc32c::crc32c(&format.to_le_bytes()), body)
}
