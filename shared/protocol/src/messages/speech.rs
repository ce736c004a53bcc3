//! What speech tells the others: prompts said, people heard, injections answered.

use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::wire_enum;
use crate::{RequestKey, UtteranceSeq};
use iceoryx2::prelude::ZeroCopySend;

wire_enum! {
    /// How far the robot has come with saying a prompt.
    Presentation {
        /// Nothing was said yet.
        Silent = 0,
        /// Being said.
        Speaking = 1,
        /// Said to its end; from now on an answer can be meant for it.
        Ended = 2,
        /// Broken off; nobody heard it whole.
        Interrupted = 3,
    }
}

wire_struct! {
    /// The latest prompt that was said. Speech to policy.
    Presented = "Presented" {
        /// [`PromptId`].
        prompt: u64,
        /// When its sound began.
        started_ns: u64,
        /// When its sound ended, 0 while it lasts.
        ended_ns: u64,
        /// Which presentation of the prompt.
        presentation: u32,
        /// [`Presentation`].
        state: u8,
        /// Zero.
        reserved: [u8; 3],
    }
}

wire_struct! {
    /// Whether somebody is speaking to the robot just now. Speech to policy, which holds its tongue.
    Activity = "Activity" {
        /// When the person began to speak, 0 while nobody speaks.
        onset_ns: u64,
        /// Sounds that are still being recognised, and utterances that are not yet applied.
        pending: u32,
        /// [`EarState`].
        ear: u8,
        /// Zero.
        reserved: [u8; 3],
    }
}

wire_enum! {
    /// Whether spoken sound can be recognised.
    EarState {
        /// The recogniser is being loaded.
        Loading = 0,
        /// It is ready.
        Ready = 1,
        /// Text only.
        Off = 2,
    }
}

wire_enum! {
    /// What became of an injection.
    ReceiptStatus {
        /// Durable; it will be applied.
        Accepted = 0,
        /// Refused; `note` says why and nothing was kept.
        Refused = 1,
        /// Heard, but not meant for the robot; `note` holds what was heard.
        NotForMe = 2,
    }
}

wire_struct! {
    /// Answer to an injection. Speech to clients.
    Receipt = "Receipt" {
        /// [`RequestKey`] of the injection.
        key: [u8; 16],
        /// [`UtteranceSeq`] given, 0 where refused.
        seq: u64,
        /// Which piece of the sound, 0 for text.
        segment: u32,
        /// Pieces in all.
        segments: u32,
        /// [`ReceiptStatus`].
        status: u8,
        /// Zero.
        reserved: [u8; 7],
        /// The text heard, or why it was refused.
        note: FixedText<500>,
    }
}

impl Receipt {
    /// The injection that it answers.
    pub fn request(&self) -> RequestKey {
        RequestKey(self.key)
    }

    /// [`UtteranceSeq`] given, if one was.
    pub fn utterance(&self) -> Option<UtteranceSeq> {
        (self.seq > 0).then_some(UtteranceSeq(self.seq))
    }
}
