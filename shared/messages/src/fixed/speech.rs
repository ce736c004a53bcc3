//! Messages from speech: prompt progress, activity, hearing, receipts of injections.

use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{Code, wire_enum};
use crate::{RequestKey, Source, UtteranceSeq};
use iceoryx2::prelude::ZeroCopySend;

wire_enum! {
    /// Progress of a prompt.
    PresentationState {
        /// Nothing was said yet.
        Silent = 0,
        /// Being said.
        Speaking = 1,
        /// Said to its end; from now on an answer can be meant for it.
        Ended = 2,
        /// Broken off before its end.
        Interrupted = 3,
    }
}

impl PresentationState {
    /// Returns whether a user may have heard some of it.
    pub fn has_begun(self) -> bool {
        self != Self::Silent
    }
}

wire_struct! {
    /// The latest prompt that was said. Speech to policy.
    Presented = "Presented" {
        /// `PromptId`.
        prompt: u64,
        /// When its sound began.
        started_ns: u64,
        /// When its sound ended, 0 while it lasts.
        ended_ns: u64,
        /// Which presentation of the prompt.
        presentation: u32,
        /// [`PresentationState`].
        state: Code<PresentationState>,
        /// Zero.
        reserved: [u8; 3],
    }
}

wire_struct! {
    /// Speech activity of a user. Speech to policy, which stays silent meanwhile.
    Activity = "Activity" {
        /// Start of the user's speech, 0 while there is none.
        onset_ns: u64,
        /// Sounds that are still being recognised, and utterances that are not yet applied.
        pending: u32,
        /// [`EarState`].
        ear: Code<EarState>,
        /// Zero.
        reserved: [u8; 3],
    }
}

wire_enum! {
    /// Availability of speech recognition.
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
    /// State of the microphone of the robot's computer.
    MicrophoneState {
        /// There is none, or it is switched off.
        Off = 0,
        /// It is opened when a user asks to talk.
        Closed = 1,
        /// Its program was started and has given no sound yet.
        Opening = 2,
        /// It listens.
        Listening = 3,
        /// It leaves out the robot's own voice.
        Muted = 4,
        /// Its program died; another try will follow.
        Broken = 5,
    }
}

wire_struct! {
    /// Quality of the robot's hearing. Speech to clients.
    Hearing = "Hearing" {
        /// When the last utterance began to be heard, 0 for none.
        onset_ns: u64,
        /// Loudness of the microphone over the last fifth of a second, decibels below full scale,
        /// -100 where nothing is known.
        level_db: f32,
        /// Level of the last utterance above the noise around it, decibels, 0 to 60.
        snr_db: f32,
        /// Times that the microphone's program died.
        restarts: u32,
        /// Utterances lost because too much was said at a time.
        dropped: u32,
        /// Utterances that are being spoken or recognised.
        pending: u32,
        /// [`EarState`].
        ear: Code<EarState>,
        /// [`MicrophoneState`].
        microphone: Code<MicrophoneState>,
        /// 1 where the last utterance was spoken (`snr_db` counts).
        measured: u8,
        /// Zero.
        reserved: u8,
        /// The program that records, or why there is none.
        note: FixedText<204>,
    }
}

wire_struct! {
    /// Interim result of an utterance that is still being spoken; the receipt holds the final one.
    /// Speech to clients.
    Partial = "Partial" {
        /// [`RequestKey`] that the utterance's receipt will have.
        stream: [u8; 16],
        /// When the person began to speak.
        onset_ns: u64,
        /// Rises with every message of this incarnation.
        number: u64,
        /// The `segment` that the utterance's receipt will have.
        segment: u32,
        /// 1 where the utterance has its result; the text is empty then.
        over: u8,
        /// Zero.
        reserved: [u8; 3],
        /// The words so far; empty until there are any.
        text: FixedText<500>,
    }
}

impl Partial {
    /// The stream or request that the utterance belongs to.
    pub fn request(&self) -> RequestKey {
        RequestKey(self.stream)
    }
}

wire_enum! {
    /// Outcome of an injection.
    ReceiptStatus {
        /// Durable; it will be applied.
        Accepted = 0,
        /// Refused; `note` says why and nothing was kept.
        Refused = 1,
        /// Heard, but not meant for the robot; `note` holds what was heard.
        NotForMe = 2,
        /// A stream has ended, and everything said in it has its receipt; `note` reports what was
        /// lost.
        Over = 3,
    }
}

wire_enum! {
    /// Why speech is acted on or not.
    GateVerdict {
        /// It is about the scene.
        Passed = 0,
        /// No words were recognised.
        NoWords = 1,
        /// It is about other things.
        OtherTalk = 2,
        /// There is no speech.
        NoSpeech = 3,
        /// The robot's own voice covers its beginning.
        Covered = 4,
        /// It is a line that the robot has just said.
        Echo = 5,
    }
}

wire_enum! {
    /// The second recogniser's part in an utterance.
    SecondState {
        /// There is none, or the first one was sure.
        NotAsked = 0,
        /// It was too late.
        Late = 1,
        /// It was heard.
        Heard = 2,
    }
}

wire_struct! {
    /// Answer to an injection, or what a microphone heard. Speech to clients.
    Receipt = "Receipt" {
        /// [`RequestKey`] of the injection; one of its own for what a microphone heard.
        key: [u8; 16],
        /// [`UtteranceSeq`] given, 0 where refused.
        seq: u64,
        /// Which piece of the sound, 0 for text; of a stream the tenth of a second in which it began.
        segment: u32,
        /// Pieces in all; of a stream 0, and with [`ReceiptStatus::Over`] its utterances.
        segments: u32,
        /// When the person began to speak; 0 where nothing was heard.
        onset_ns: u64,
        /// When the person had ended.
        end_ns: u64,
        /// Probability of the text heard among all that it may have been, 0 to 1; 1 for text.
        confidence: f32,
        /// Level of the speech above the noise around it, decibels, 0 to 60; 0 for text.
        snr_db: f32,
        /// How much of it is about the scene, 0 to 1, where the verdict is [`GateVerdict::OtherTalk`].
        gate_score: f32,
        /// [`ReceiptStatus`].
        status: Code<ReceiptStatus>,
        /// [`Source`].
        source: Code<Source>,
        /// [`GateVerdict`] on speech.
        verdict: Code<GateVerdict>,
        /// [`SecondState`].
        second: Code<SecondState>,
        /// The text heard, or why it was refused.
        note: FixedText<500>,
        /// Best words of the first recogniser; empty for text, and after a restart.
        first_text: FixedText<200>,
        /// Words of the second recogniser, where it was heard.
        second_text: FixedText<200>,
    }
}

impl Receipt {
    /// The injection that the receipt answers.
    pub fn request(&self) -> RequestKey {
        RequestKey(self.key)
    }

    /// [`UtteranceSeq`] given, if one was.
    pub fn utterance(&self) -> Option<UtteranceSeq> {
        (self.seq > 0).then_some(UtteranceSeq(self.seq))
    }
}
