//! A client that streams sound to the robot.

use crate::bus::{PortError, Reader, Writer};
use crate::client::{Client, ClientError, random_key};
use crate::{Span, Time};
use messages::{AudioChunk, CHUNK_SAMPLES_MAX, Pcm, Receipt, ReceiptStatus, RequestKey, topics};

/// Nanoseconds of one sample.
const SAMPLE_NS: u64 = 62_500;

/// A stream of sound on its way to the speech service: one channel, 16 000 samples a second, in
/// real time. Sound sent faster than the service reads is lost.
#[derive(Debug)]
pub struct AudioStream {
    chunks: Writer<AudioChunk>,
    receipts: Reader<Receipt>,
    key: RequestKey,
    flags: u8,
    number: u64,
    samples: u64,
    is_over: bool,
}

impl AudioStream {
    /// Opens a stream; `flags` as in [`AudioChunk::flags`], except for the end.
    ///
    /// # Errors
    /// The group is of another build, or too many clients stream.
    pub fn open(client: &Client, flags: u8) -> Result<Self, ClientError> {
        let bus = client.bus();
        Ok(Self {
            chunks: bus.writer(&topics::AUDIO)?,
            receipts: bus.reader(&topics::RECEIPT)?,
            key: random_key(),
            flags: flags & !AudioChunk::END,
            number: 0,
            samples: 0,
            is_over: false,
        })
    }

    /// Key of the stream in receipts and interim results.
    pub fn key(&self) -> RequestKey {
        self.key
    }

    /// Skips samples that were lost before they arrived: the robot receives silence.
    pub fn skip(&mut self, samples: u64) {
        self.samples = self.samples.saturating_add(samples);
    }

    /// Sets the flags of subsequent chunks, e.g. when a key is pressed or released.
    pub fn set_flags(&mut self, flags: u8) {
        self.flags = flags & !AudioChunk::END;
    }

    /// Sends samples, the first of which was taken at `taken`.
    ///
    /// # Errors
    /// The topic fails.
    pub fn send(&mut self, taken: Time, samples: &[i16]) -> Result<(), PortError> {
        for (n, part) in samples.chunks(CHUNK_SAMPLES_MAX).enumerate() {
            let before = Span((n * CHUNK_SAMPLES_MAX) as u64 * SAMPLE_NS);
            self.chunk(taken + before, part, self.flags)?;
        }
        Ok(())
    }

    /// Ends the stream. To be repeated until the receipts say that it is over: a chunk may be lost.
    ///
    /// # Errors
    /// The topic fails.
    pub fn end(&mut self, now: Time) -> Result<(), PortError> {
        self.chunk(now, &[], self.flags | AudioChunk::END)
    }

    fn chunk(&mut self, taken: Time, samples: &[i16], flags: u8) -> Result<(), PortError> {
        let mut chunk = AudioChunk {
            stream: self.key.0,
            number: self.number,
            first_sample: self.samples,
            taken_ns: taken.ns(),
            count: samples.len() as u32,
            flags,
            samples: Pcm::default(),
            ..AudioChunk::default()
        };
        chunk.samples.0[..samples.len()].copy_from_slice(samples);
        self.number += 1;
        self.samples = self.samples.saturating_add(samples.len() as u64);
        self.chunks.send(&chunk)
    }

    /// Returns the new receipts: one for each utterance, and a last one at the end of the stream.
    ///
    /// # Errors
    /// The topic fails.
    pub fn receipts(&mut self) -> Result<Vec<Receipt>, PortError> {
        let (key, mut receipts) = (self.key, Vec::new());
        self.receipts.drain(|receipt| {
            if receipt.request() == key {
                receipts.push(*receipt);
            }
        })?;
        let over = |receipt: &Receipt| receipt.status == ReceiptStatus::Over;
        self.is_over |= receipts.iter().any(over);
        Ok(receipts)
    }

    /// Returns true if the service has confirmed the end of the stream.
    pub fn is_over(&self) -> bool {
        self.is_over
    }
}
