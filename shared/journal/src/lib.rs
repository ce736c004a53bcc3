//! A journal: the durable memory of one service, exact after a crash at any moment.
//!
//! Invariant: a record is in the journal after [`Journal::sync`] returned `Ok`, and what was
//! appended between two syncs is there as a whole or not at all. Nothing else may be relied on
//! before effects become visible.
//!
//! One file has one writer, which holds a lock for life. It starts with a [`Header`] that names the
//! owner, followed by frames, one per sync, all little-endian:
//!
//! ```text
//! header  magic 8 | format u32 | len u32 | crc32c u32 | body (postcard: Header, first_seq u64)
//! frame   len u32 | crc32c u32 | seq u64 | prev_crc u32 | body (postcard: sequence of records)
//! ```
//!
//! `seq` numbers the frame's first record, `crc32c` covers `seq`, `prev_crc` and the body, and
//! `prev_crc` is the checksum of the frame before (of the header for the first frame), so a frame
//! is only valid in its own place. A damaged frame with nothing valid after it is the torn tail of
//! a write that was never acknowledged: it is cut off. A damaged frame with valid frames after it
//! was acknowledged once: that is corruption, and the journal refuses to open.
//!
//! A frame per sync, and not per record, is what makes that distinction exact: a disk may write
//! the pages of one batch in any order before the sync, and a hole in an unacknowledged batch must
//! not look like corruption.
//!
//! Errors do not name the file; the caller knows it. Data for people is kept as [`lines`].

mod error;
mod file;
mod frame;
mod header;
pub mod lines;
mod lock;
mod replace;
mod rotate;
mod scan;
mod tail;

#[cfg(test)]
mod tests;

pub use error::{AppendError, JournalOpenError, RotateError, SyncError};
pub use file::{Journal, Reading, Recovered, read};
pub use frame::BODY_BYTES_MAX;
pub use header::{FORMAT, Header};
pub use replace::{replace_file, replace_file_synced};
pub use rotate::KEPT;
pub use scan::Ending;
