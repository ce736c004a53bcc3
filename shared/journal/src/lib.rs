//! A journal: the durable memory of one service, exact after a crash at any moment.
//!
//! Invariant: a record is in the journal after [`Journal::sync`] returned `Ok`, and the records
//! between two syncs are there as a whole or not at all. Nothing else may be relied on before
//! effects become visible.
//!
//! One file has one writer, which holds a lock for life. It starts with a [`Header`] that names the
//! owner, followed by frames, one per sync, all little-endian:
//!
//! ```text
//! header  magic 8 | format u32 | len u32 | crc32c u32 | body (postcard: Header, first_seq, snapshot)
//! frame   0xA5 | len u32 | crc32c u32 | seq u64 | prev_crc u32
//!         | body (postcard: sequence of records) | crc32c u32 | len u32
//! ```
//!
//! `seq` numbers the frame's first record, `crc32c` covers `seq`, `prev_crc` and the body, and
//! `prev_crc` is the checksum of the frame before (of the header for the first frame), so a frame
//! is only valid in its own place. `snapshot` is the number of records that the file began with.
//!
//! A damaged frame was either torn, before it was acknowledged as durable, and is cut off; or it
//! was acknowledged: that is corruption, and the journal refuses to open. Which of the two:
//!
//! - A valid frame after it: frames follow a sync of the one before, so it was acknowledged.
//! - Otherwise it is the last one. A disk may write the sectors of one frame in any order before
//!   the sync, and may be interrupted anywhere: unwritten parts are missing at the end of the file
//!   or read as zeros. Every frame has a byte `0xA5` at its start and at each multiple of 512 of
//!   the file, so no sector's part of it is all zeros, and its length is at both ends. A frame that
//!   lacks its end, or a sector, is torn; one that is complete but wrong is corrupt.
//!
//! Indistinguishable cases: whole frames missing at the end of a file look as if they had never
//! been written (the other services' journals may know of them); a last frame of which a whole
//! sector was lost after the sync, or both of whose lengths are damaged, looks torn.
//!
//! Errors do not name the file; the caller knows it.

mod error;
mod file;
mod frame;
mod header;
mod lock;
mod rotate;
mod scan;
mod tail;

#[cfg(test)]
mod tests;

pub use error::{AppendError, JournalOpenError, RotateError, SyncError};
pub use file::{Inspection, Journal, Reading, Recovered, inspect, read};
pub use frame::BODY_BYTES_MAX;
pub use header::{FORMAT, Header};
pub use rotate::KEPT;
pub use scan::Ending;
