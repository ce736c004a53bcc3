//! Chunks that other tools have compressed with Zstandard.

use std::error::Error;
use std::io::Read;

use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::{McapError, McapResult};
use ruzstd::decoding::StreamingDecoder;

use crate::records::RECORD_BYTES_MAX;

/// Decompresses a chunk at once.
#[derive(Default)]
pub(crate) struct Zstd {
    content: Vec<u8>,
    /// Bytes of it that were handed on.
    given: usize,
}

impl Zstd {
    fn fill(&mut self, mut frames: &[u8]) -> McapResult<()> {
        let failed = |error: &dyn Error| McapError::DecompressionError(error.to_string());
        while !frames.is_empty() {
            let frame = StreamingDecoder::new(&mut frames).map_err(|error| failed(&error))?;
            let left = RECORD_BYTES_MAX.saturating_sub(self.content.len() as u64);
            let read = frame.take(left).read_to_end(&mut self.content);
            if read.map_err(|error| failed(&error))? == 0 && left == 0 {
                return Err(McapError::ChunkTooLarge(RECORD_BYTES_MAX));
            }
        }
        Ok(())
    }
}

impl Decompressor for Zstd {
    fn next_read_size(&self) -> usize {
        // The whole chunk.
        usize::MAX
    }

    fn decompress(&mut self, from: &[u8], to: &mut [u8]) -> McapResult<DecompressResult> {
        if !from.is_empty() {
            self.fill(from)?;
        }
        let left = &self.content[self.given..];
        let wrote = left.len().min(to.len());
        to[..wrote].copy_from_slice(&left[..wrote]);
        self.given += wrote;
        Ok(DecompressResult { consumed: from.len(), wrote })
    }

    fn reset(&mut self) -> McapResult<()> {
        *self = Self::default();
        Ok(())
    }

    fn name(&self) -> &'static str {
        "zstd"
    }
}
