//! Sound that clients stream to the robot.

use crate::RequestKey;
use crate::definition::FieldType;
use crate::schema::wire_struct;
use iceoryx2::prelude::ZeroCopySend;

/// Samples of one chunk at most: a tenth of a second.
pub const CHUNK_SAMPLES_MAX: usize = 1_600;

/// Samples of one channel, 16 000 a second, of which a chunk uses the first.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, ZeroCopySend)]
#[type_name("Pcm")]
pub struct Pcm<const N: usize>(pub [i16; N]);

impl<const N: usize> crate::wire::WireField for Pcm<N> {
    fn ros2() -> FieldType {
        FieldType::primitive("int16").array(N)
    }
}

impl<const N: usize> Default for Pcm<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

impl<const N: usize> std::fmt::Debug for Pcm<N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{N} samples")
    }
}

wire_struct! {
    /// A piece of a stream of sound. Clients to speech. Chunks may be lost: the robot hears silence
    /// then.
    AudioChunk = "AudioChunk" {
        /// [`RequestKey`] of the stream, made by the client.
        stream: [u8; 16],
        /// Number of the chunk in its stream, from 0.
        number: u64,
        /// Samples of the stream before this chunk.
        first_sample: u64,
        /// When its first sample was taken, monotonic clock.
        taken_ns: u64,
        /// Number of used entries of `samples`.
        count: u32,
        /// Sum of [`AudioChunk::END`], [`AudioChunk::HELD`] and [`AudioChunk::ECHO_FREE`].
        flags: u8,
        /// Zero.
        reserved: [u8; 3],
        /// The sound.
        samples: Pcm<CHUNK_SAMPLES_MAX>,
    }
}

impl AudioChunk {
    /// Flag of the stream's last chunk.
    pub const END: u8 = 1;
    /// The person holds a key while speaking, so they may interrupt the robot, and the utterance
    /// ends when the key is released.
    pub const HELD: u8 = 2;
    /// The robot's own voice is not in it (a headset, cancelled echo): the person may interrupt the
    /// robot.
    pub const ECHO_FREE: u8 = 4;

    /// The stream that the chunk belongs to.
    pub fn request(&self) -> RequestKey {
        RequestKey(self.stream)
    }

    /// The samples; empty if the count is invalid.
    pub fn sound(&self) -> &[i16] {
        self.samples.0.get(..self.count as usize).unwrap_or_default()
    }

    /// Returns whether a flag is set.
    pub fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }
}
