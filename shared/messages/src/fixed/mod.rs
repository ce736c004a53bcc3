//! The fixed-layout messages, one struct per topic of the data path.
//!
//! Times are nanoseconds of the machine's monotonic clock (`*_ns`), joints radians, lengths metres
//! in frame `base`. Fields named `reserved` are zero. A changed layout is another schema key, and
//! needs another topic name while both are in use.

mod arm;
mod audio;
mod common;
mod observation;
mod policy;
mod speech;
mod utterance;

pub use arm::*;
pub use audio::{AudioChunk, CHUNK_SAMPLES_MAX, Pcm};
pub use common::{AskedQuestion, POINTED_AT_MAX_M, Stamp, WireGesture, WireQuestion, is_somewhere};
pub use observation::*;
pub use policy::*;
pub use speech::*;
pub use utterance::*;
