//! Inputs and outputs of the reducer.

use messages::{
    Activity, AppliedMark, ArmStatus, EarState, Hearing, Injection, MessageRef, Partial, Presented,
    PromptId, Receipt, RobotAct, Utterance,
};
use serde::{Deserialize, Serialize};
use service::{Span, Time};
use speech_engines::Device;
use speech_engines::live_events::{LiveEvent, MicrophoneStatus};
use speech_engines::stream::{SpeechSegment, StreamEvent};
use speech_engines::vad::Closing;
use speech_engines::voice::PlaybackEvent;

use crate::Hypothesis;
use crate::hearing::{Heard, Rejected, SecondView};

/// Events delivered to the reducer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In<'a> {
    /// An utterance or a request from a client.
    Injection(Injection),
    /// Progress of the belief, from the policy.
    Mark(AppliedMark),
    /// A prompt to speak, from the policy.
    Act(MessageRef<'a, RobotAct>),
    /// Status of the arm, which may aim at an object.
    Arm(ArmStatus),
    /// The arm has carried out the stop that was ordered at that time, or obeys a later order.
    StopSettled(Time),
    /// An event of a microphone or of a client's stream.
    Stream(StreamEvent),
    /// Status of the microphone.
    Microphone(MicrophoneStatus),
    /// A result of the recogniser.
    Recognised(Recognised),
    /// An interim result of the recogniser.
    InterimResult {
        /// Number of the sound.
        sound: u64,
        /// The words so far.
        text: String,
    },
    /// Result for a possible end of an utterance in progress.
    EarlyResult {
        /// Number of the sound.
        sound: u64,
        /// The pause after which it was decoded.
        at: Closing,
        /// The result; `None` if decoding failed.
        result: Option<Box<RecognisedSegment>>,
    },
    /// State of the recogniser.
    RecogniserState(EarState),
    /// Progress of the voice.
    Playback(PlaybackEvent),
    /// What stands in the place of a device's server and why; `None`: it works.
    Server {
        /// The device.
        of: Device,
        /// In words, for the operator.
        note: Option<String>,
    },
}

impl From<LiveEvent> for In<'_> {
    fn from(event: LiveEvent) -> Self {
        match event {
            LiveEvent::Stream(event) => Self::Stream(event),
            LiveEvent::Microphone(status) => Self::Microphone(status),
        }
    }
}

impl In<'_> {
    /// Returns the event of a live source, if it is one.
    pub(crate) fn live(self) -> Option<LiveEvent> {
        match self {
            Self::Stream(event) => Some(LiveEvent::Stream(event)),
            Self::Microphone(status) => Some(LiveEvent::Microphone(status)),
            _ => None,
        }
    }
}

/// Messages published and requests to the devices.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Out {
    /// To grounding.
    Utterance(Box<Utterance>),
    /// To clients.
    Receipt(Box<Receipt>),
    /// To the policy.
    Presented(Presented),
    /// To the policy.
    Activity(Activity),
    /// To the arm, until it has carried it out: the stop that a user ordered at that time.
    Stop(Time),
    /// To clients: quality of hearing.
    Hearing(Hearing),
    /// To clients: interim result.
    Partial(Box<Partial>),
    /// To the recogniser: the next samples of a sound in progress.
    InterimSamples(u64, #[serde(with = "speech_engines::unrecorded_sound")] Vec<i16>),
    /// To the recogniser: a possible end of a sound.
    DecodeEarly(u64, SpeechSegment),
    /// To the live source: the pause that ends a sound in progress.
    Close(u64, Closing),
    /// To the recogniser: input to recognise; the result carries the number.
    Recognise(u64, RecognitionInput),
    /// To the microphone: record one utterance of this length at most; its events carry the number.
    OpenMicrophone(u64, Span),
    /// To the voice: speak this prompt and interrupt the current one.
    Speak(PlaybackRequest),
    /// To the voice: stop.
    StopSpeaking,
}

/// Input of the recogniser.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecognitionInput {
    /// A WAV file, absolute path.
    File(String),
    /// One utterance of a live source.
    Speech(SpeechSegment),
}

/// A prompt for the voice.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlaybackRequest {
    /// Identifies the playback in the voice's events.
    pub playback: u64,
    /// The prompt.
    pub prompt: PromptId,
    /// Number of the prompt's presentation.
    pub presentation: u32,
    /// The words.
    pub text: String,
}

/// Result of the recogniser.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recognised {
    /// Number of the sound.
    pub sound: u64,
    /// The utterances in the sound, none without speech; or the reason of a failure.
    pub segments: Result<Vec<RecognisedSegment>, String>,
}

/// One utterance in a sound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecognisedSegment {
    /// Beginning and end, seconds from the start of the sound.
    pub span_s: (f64, f64),
    /// Signal-to-noise ratio, decibels, 0 to 60. Recognition is good from 20 on and poor below 15.
    pub snr_db: f32,
    /// The hypotheses, best first; or why the speech is not acted on.
    pub hypotheses: Result<Vec<Hypothesis>, Rejected>,
    /// Result of each recogniser.
    pub heard: Heard,
    /// `true` if the second recogniser's opinion is still to come.
    pub awaits_second: bool,
}

impl RecognisedSegment {
    /// Returns the result of one recogniser that passed the gate.
    pub fn accepted(span_s: (f64, f64), snr_db: f32, hypotheses: Vec<Hypothesis>) -> Self {
        let heard = Heard { first: hypotheses.clone().into(), second: SecondView::NotAsked };
        Self { span_s, snr_db, hypotheses: Ok(hypotheses), heard, awaits_second: false }
    }

    /// Returns the best words, if any were recognised.
    pub fn text(&self) -> Option<&str> {
        match &self.hypotheses {
            Ok(hypotheses) => hypotheses.first().map(|best| best.text.as_str()),
            Err(rejected) => Some(&rejected.text),
        }
    }
}
