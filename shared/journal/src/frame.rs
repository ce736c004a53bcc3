//! One frame: the records of one sync, sealed at both ends.

/// Most bytes of encoded records that one frame holds, 16 MiB: far above any real batch, low
/// enough that a damaged length is recognised as one.
pub const BODY_BYTES_MAX: usize = 16 << 20;

/// Smallest unit that a disk writes as a whole.
const SECTOR_BYTES: usize = 512;
/// First byte of a frame, and of its part in each further sector: no part of a frame is all zeros,
/// so one that is has not reached the disk.
const MARK: u8 = 0xA5;

/// Mark, length, checksum, number and predecessor's checksum before the body.
pub(crate) const PREFIX_BYTES: usize = 21;
/// Checksum and length after the body.
const SUFFIX_BYTES: usize = 8;
/// Bytes of a frame without a body.
pub(crate) const FRAME_BYTES_MIN: usize = PREFIX_BYTES + SUFFIX_BYTES;

/// A frame whose checksum matches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Frame {
    pub(crate) crc: u32,
    pub(crate) seq: u64,
    pub(crate) prev_crc: u32,
    pub(crate) body: Vec<u8>,
    /// Bytes that the frame takes in the file.
    pub(crate) len: usize,
}

/// The bytes of a frame for offset `at` of the file, and its checksum.
///
/// # Panics
/// If the body is longer than [`BODY_BYTES_MAX`]: the caller bounds it.
pub(crate) fn seal(at: u64, seq: u64, prev_crc: u32, body: &[u8]) -> (Vec<u8>, u32) {
    assert!(body.len() <= BODY_BYTES_MAX, "the caller bounds the body");
    let crc = checksum(seq, prev_crc, body);
    let len = body.len() as u32;
    let content = [
        &[MARK][..],
        &len.to_le_bytes(),
        &crc.to_le_bytes(),
        &seq.to_le_bytes(),
        &prev_crc.to_le_bytes(),
        body,
        &crc.to_le_bytes(),
        &len.to_le_bytes(),
    ];
    (mark_sectors(at, &content.concat()), crc)
}

/// The frame at the start of `bytes`, which begin at offset `at` of the file, if there is a whole
/// one whose number `plausible` accepts. The number is asked about before the checksum, which makes
/// a search at every byte cheap.
pub(crate) fn parse(at: u64, bytes: &[u8], plausible: impl Fn(u64) -> bool) -> Option<Frame> {
    if bytes.first() != Some(&MARK) {
        return None;
    }
    let Head { len, crc, seq, prev_crc } = Head::of(&content(at, bytes, PREFIX_BYTES)?)?;
    if len > BODY_BYTES_MAX || !plausible(seq) {
        return None;
    }
    let mut body = content(at, bytes, PREFIX_BYTES + len + SUFFIX_BYTES)?;
    let frame_len = body.len() + marks(at, body.len());
    let suffix = words::<2>(&body[PREFIX_BYTES + len..])?;
    body.truncate(PREFIX_BYTES + len);
    body.drain(..PREFIX_BYTES);
    let is_valid = suffix == [crc, len as u32] && checksum(seq, prev_crc, &body) == crc;
    is_valid.then_some(Frame { crc, seq, prev_crc, body, len: frame_len })
}

/// Returns whether `bytes`, the invalid end of a file from offset `at` on, are a frame that was
/// once written to its last byte: it is damaged, not torn. A torn one lacks its end or sectors.
pub(crate) fn was_complete(at: u64, bytes: &[u8]) -> bool {
    if sectors(at, bytes).any(|part| part.iter().all(|byte| *byte == 0)) {
        return false;
    }
    let kept: Vec<u8> = sectors(at, bytes).enumerate().flat_map(unmarked).copied().collect();
    let Some(suffix_at) = kept.len().checked_sub(SUFFIX_BYTES) else { return false };
    let (Some(head), Some([crc, len])) = (Head::of(&kept), words::<2>(&kept[suffix_at..])) else {
        return false;
    };
    let ends_here = |len: usize| kept.len().checked_sub(PREFIX_BYTES + SUFFIX_BYTES) == Some(len);
    ends_here(head.len) || (crc == head.crc && ends_here(len as usize))
}

/// The first `N` little-endian words of `bytes`.
pub(crate) fn words<const N: usize>(bytes: &[u8]) -> Option<[u32; N]> {
    let mut words = [0; N];
    for (word, chunk) in words.iter_mut().zip(bytes.get(..4 * N)?.chunks_exact(4)) {
        *word = u32::from_le_bytes(chunk.try_into().ok()?);
    }
    Some(words)
}

/// Head of a frame, before the body.
struct Head {
    len: usize,
    crc: u32,
    seq: u64,
    prev_crc: u32,
}

impl Head {
    fn of(content: &[u8]) -> Option<Self> {
        let [len, crc, low, high, prev_crc] = words(content.get(1..)?)?;
        Some(Self { len: len as usize, crc, seq: u64::from(low) | u64::from(high) << 32, prev_crc })
    }
}

/// Splits `bytes`, which begin at offset `at` of the file, into the parts in each sector.
fn sectors(at: u64, bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let (first, others) = bytes.split_at(in_first_sector(at).min(bytes.len()));
    std::iter::once(first).filter(|part| !part.is_empty()).chain(others.chunks(SECTOR_BYTES))
}

fn in_first_sector(at: u64) -> usize {
    SECTOR_BYTES - (at % SECTOR_BYTES as u64) as usize
}

/// Number of sector marks in a frame at `at` with that many bytes of content, which begins with a
/// mark of its own.
fn marks(at: u64, content: usize) -> usize {
    content.saturating_sub(in_first_sector(at)).div_ceil(SECTOR_BYTES - 1)
}

fn mark_sectors(at: u64, content: &[u8]) -> Vec<u8> {
    let (first, others) = content.split_at(in_first_sector(at).min(content.len()));
    let mut bytes = Vec::with_capacity(content.len() + marks(at, content.len()));
    bytes.extend_from_slice(first);
    for part in others.chunks(SECTOR_BYTES - 1) {
        bytes.push(MARK);
        bytes.extend_from_slice(part);
    }
    bytes
}

/// The first `len` bytes of a frame's content; `None` at the file's end or without a sector's mark.
fn content(at: u64, bytes: &[u8], len: usize) -> Option<Vec<u8>> {
    let bytes = bytes.get(..len + marks(at, len))?;
    let is_marked = sectors(at, bytes).skip(1).all(|part| part.first() == Some(&MARK));
    is_marked.then(|| sectors(at, bytes).enumerate().flat_map(unmarked).copied().collect())
}

/// A sector's part of a frame without the sector's mark; the first part has none.
fn unmarked((sector, part): (usize, &[u8])) -> &[u8] {
    if sector == 0 { part } else { part.get(1..).unwrap_or_default() }
}

fn checksum(seq: u64, prev_crc: u32, body: &[u8]) -> u32 {
    let crc = crc32c::crc32c(&seq.to_le_bytes());
    let crc = crc32c::crc32c_append(crc, &prev_crc.to_le_bytes());
    crc32c::crc32c_append(crc, body)
}
