//! Live audio: streams, their utterances as they arrive, and the robot's own voice in them.

mod closings;
mod events;
mod half_duplex;
mod playback_mask;
mod segment;
mod segmented_stream;

pub use audio::SampleClock;
pub(crate) use audio::shifted;
pub use closings::Closings;
pub use events::{Began, LIVE_FROM, StreamEvent, next_sound};
pub use half_duplex::{Duplex, MaskedStream};
pub use playback_mask::{OwnVoice, PlaybackMask};
pub use segment::SpeechSegment;
pub use segmented_stream::Stream;
