//! The contract between the services: messages over shared memory and their meaning.
//!
//! Messages are plain fixed-layout structs that are read in place (no copy, no decoding); payloads
//! of variable size are postcard. Nothing here opens a topic, reads a clock or does any IO: that is
//! the runtime's part. Values read from the wire are never trusted: every accessor that interprets
//! a byte is checked and can fail.
//!
//! # Example
//!
//! An utterance from speech to grounding, and the receiver's half of "in order, exactly once":
//!
//! ```
//! use messages::inbox::{Inbox, Verdict};
//! use messages::{Hypothesis, Utterance, UtteranceSeq};
//!
//! let mut utterance = Utterance { seq: 1, ..Utterance::default() };
//! utterance.set_hypotheses(&[Hypothesis::certain("the white bowl")])?;
//! assert_eq!(utterance.hypotheses()?[0].text, "the white bowl");
//!
//! let mut inbox = Inbox::default();
//! assert_eq!(inbox.judge(UtteranceSeq(utterance.seq)), Verdict::Apply);
//! inbox.advance();
//! assert_eq!(inbox.judge(UtteranceSeq(1)), Verdict::Duplicate);
//! assert_eq!(inbox.judge(UtteranceSeq(3)), Verdict::Early);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod definition;
mod fixed;
pub mod ids;
pub mod inbox;
pub mod judge;
pub mod layout;
mod message_ref;
pub mod outbox;
pub mod payloads;
pub mod pick;
pub mod robot;
pub mod schema;
mod services;
pub mod sound_file;
pub mod text;
pub mod topics;
pub mod wire;
mod wire_serde;

pub use fixed::*;
pub use ids::{ClientId, Epoch, Incarnation, RequestKey};
pub use layout::WireMessage;
pub use message_ref::MessageRef;
pub use payloads::*;
pub use perception::{Change, Detection, Look, Sighting};
pub use services::{SUPERVISOR, Service};
pub use sound_file::SoundFile;
pub use text::{FixedText, TextTooLong};
pub use topics::Topic;
pub use vocabulary::ids::{ActId, InteractionId, PickId, PromptId, StopId, UtteranceSeq};
pub use vocabulary::{ActKind, Ended, Interpretation, Outcome, PickOutcome, PickPhase, Task};
pub use wire::{Code, WireCode, WireError, WireField};
