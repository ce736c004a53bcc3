//! One frame: the records of one sync, sealed with a checksum.

/// Most bytes of encoded records that one frame holds, 16 MiB: far above any real batch, low
/// enough that a damaged length is recognised as one.
pub const BODY_BYTES_MAX: usize = 16 << 20;

/// Length, checksum, number and predecessor's checksum before the body.
pub(crate) const PREFIX_BYTES: usize = 20;

/// A frame whose checksum matches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame<'a> {
    pub(crate) crc: u32,
    pub(crate) seq: u64,
    pub(crate) prev_crc: u32,
    pub(crate) body: &'a [u8],
}

impl Frame<'_> {
    /// Bytes that the frame takes in the file.
    pub(crate) fn len(&self) -> usize {
        PREFIX_BYTES + self.body.len()
    }
}

/// The bytes of a frame and its checksum.
///
/// # Panics
/// Where the body is longer than [`BODY_BYTES_MAX`]: the caller bounds it.
pub(crate) fn seal(seq: u64, prev_crc: u32, body: &[u8]) -> (Vec<u8>, u32) {
    assert!(body.len() <= BODY_BYTES_MAX, "the caller bounds the body");
    let crc = checksum(seq, prev_crc, body);
    let mut bytes = Vec::with_capacity(PREFIX_BYTES + body.len());
    bytes.extend_from_slice(&(body.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&crc.to_le_bytes());
    bytes.extend_from_slice(&seq.to_le_bytes());
    bytes.extend_from_slice(&prev_crc.to_le_bytes());
    bytes.extend_from_slice(body);
    (bytes, crc)
}

/// The frame at the start of `bytes`, if there is a whole one whose number `plausible` accepts.
/// The number is asked about before the checksum, which makes a search at every byte cheap.
pub(crate) fn parse(bytes: &[u8], plausible: impl Fn(u64) -> bool) -> Option<Frame<'_>> {
    let [len, crc, seq_low, seq_high, prev_crc] = words(bytes)?;
    let seq = u64::from(seq_low) | u64::from(seq_high) << 32;
    let len = len as usize;
    if len > BODY_BYTES_MAX || !plausible(seq) {
        return None;
    }
    let body = bytes.get(PREFIX_BYTES..PREFIX_BYTES + len)?;
    (checksum(seq, prev_crc, body) == crc).then_some(Frame { crc, seq, prev_crc, body })
}

/// The first `N` little-endian words of `bytes`.
pub(crate) fn words<const N: usize>(bytes: &[u8]) -> Option<[u32; N]> {
    let mut words = [0; N];
    for (word, chunk) in words.iter_mut().zip(bytes.get(..4 * N)?.chunks_exact(4)) {
        *word = u32::from_le_bytes(chunk.try_into().ok()?);
    }
    Some(words)
}

fn checksum(seq: u64, prev_crc: u32, body: &[u8]) -> u32 {
    let crc = crc32c::crc32c(&seq.to_le_bytes());
    let crc = crc32c::crc32c_append(crc, &prev_crc.to_le_bytes());
    crc32c::crc32c_append(crc, body)
}
