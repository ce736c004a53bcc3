//! What has happened, for whoever keeps count: the study.

use messages::{Ended, Receipt};
use scene::Question;
use service::Time;

/// Something that has happened; each told once.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureEvent {
    /// An interaction has begun.
    Opened {
        /// Which one.
        interaction: u64,
        /// When it was seen.
        at: Time,
    },
    /// An interaction has ended.
    Ended {
        /// How.
        ended: Ended,
        /// When it was seen.
        at: Time,
    },
    /// A line of the robot's has begun to be said.
    Said {
        /// Which prompt.
        prompt: u64,
        /// Which presentation of it.
        presentation: u32,
        /// What it asks, if anything.
        question: Question,
        /// Its words.
        text: String,
        /// When its sound began.
        began: Time,
    },
    /// An utterance was accepted.
    Heard(Box<Receipt>),
    /// The motion stop was latched or released.
    Stopped {
        /// Whether it holds now.
        stopped: bool,
        /// When it was seen.
        at: Time,
    },
    /// A service is no longer ready, or is so again.
    Service {
        /// Which one.
        name: String,
        /// Whether it is ready again.
        is_back: bool,
        /// When it was seen.
        at: Time,
    },
    /// Another scene holds.
    SceneChanged,
}
