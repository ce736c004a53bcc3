//! Messages to pages: text frames with JSON.

use messages::{JointStates, Partial, Receipt, ReceiptStatus};
use serde::Serialize;
use serde_json::Value as Json;
use service::Time;

use super::ms;

/// A message to a page.
#[derive(Debug, Serialize)]
#[serde(tag = "t", rename_all = "snake_case")]
pub enum PageMessage<'a> {
    Welcome(Welcome<'a>),
    Pong { at: &'a Json, server_ms: f64 },
    Done(Done<'a>),
    Error { error: &'a str },
    Joints(Joints),
    Partial(Interim<'a>),
    Receipt(StreamReceipt<'a>),
}

#[derive(Debug, Serialize)]
pub struct Welcome<'a> {
    pub protocol: u64,
    pub viewer: String,
    pub version: &'a str,
    pub group: &'a str,
    pub server_ms: f64,
    pub first_line: u64,
    pub settings: &'a PageSettings,
}

/// Settings that concern pages.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PageSettings {
    /// The language if the page has chosen none.
    pub language: String,
    pub voice: VoiceSettings,
    pub study: bool,
    /// The arm is the kinematic model: no robot moves.
    pub simulated: bool,
    pub camera: Option<CameraSettings>,
}

/// The camera that pages show.
#[derive(Clone, Debug, Serialize)]
pub struct CameraSettings {
    pub url: String,
    /// Time between two single pictures; `None` for a stream.
    pub every_ms: Option<f64>,
    #[serde(skip)]
    pub origin: String,
}

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct VoiceSettings {
    pub recogniser: bool,
    pub voice: bool,
}

/// The answer to a command, under the number that the page gave it.
#[derive(Debug, Serialize)]
pub struct Done<'a> {
    pub id: u64,
    pub ok: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<&'a str>,
    #[serde(flatten)]
    pub answer: Option<Answer>,
}

impl<'a> Done<'a> {
    /// Makes the answer to the command `id`.
    pub fn new(id: u64, outcome: &'a Result<Option<Answer>, String>) -> Self {
        let error = outcome.as_ref().err().map(String::as_str);
        let answer = outcome.as_ref().ok().cloned().flatten();
        Self { id, ok: outcome.is_ok(), error, answer }
    }
}

/// The result of a command.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Answer {
    Accepted {
        seq: u64,
        /// Why nothing follows yet: a service does nothing for now.
        #[serde(skip_serializing_if = "Option::is_none")]
        waits_for: Option<String>,
        /// Whether an earlier request with the same key had been accepted.
        #[serde(skip)]
        known: bool,
    },
    Motion {
        stopped: bool,
    },
    /// The viewer has control, or requests it.
    Control {
        granted: bool,
        /// When it gets control unless the operator keeps it, milliseconds.
        #[serde(skip_serializing_if = "Option::is_none")]
        expires_ms: Option<f64>,
    },
    Supervisor {
        message: String,
    },
    /// The fields that a part of the page answers with.
    Part(page_part::Fields),
}

/// States of the joints, with as many digits as can be seen.
#[derive(Debug, Serialize)]
pub struct Joints {
    at_ms: f64,
    q: Vec<f64>,
    grip: Vec<f64>,
}

#[derive(Debug, Serialize)]
pub struct Interim<'a> {
    stream: Option<u32>,
    text: &'a str,
    over: bool,
    onset_ms: f64,
}

/// The receipt of a part of an audio stream.
#[derive(Debug, Serialize)]
pub struct StreamReceipt<'a> {
    stream: u32,
    status: ReceiptStatus,
    text: &'a str,
    #[serde(flatten)]
    heard: Option<Heard>,
    #[serde(skip_serializing_if = "Option::is_none")]
    utterances: Option<Option<u32>>,
}

#[derive(Debug, Serialize)]
struct Heard {
    seq: Option<u64>,
    confidence: f32,
    snr_db: f32,
    onset_ms: Option<f64>,
    ended_ms: Option<f64>,
}

impl PageMessage<'_> {
    pub fn to_text(&self) -> String {
        // Every message can be written.
        serde_json::to_string(self).unwrap_or_default()
    }
}

impl Joints {
    /// Rounds the states.
    pub fn new(joints: &JointStates) -> Self {
        let round = |number: f64, scale: f64| (number * scale).round() / scale;
        Self {
            at_ms: ms(Time(joints.at_ns)),
            q: joints.position.iter().map(|q| round(*q, 1e5)).collect(),
            grip: joints.gripper_percent.iter().map(|grip| round(*grip, 10.0)).collect(),
        }
    }
}

impl<'a> Interim<'a> {
    /// Reads a message about stream `stream` of the page; an utterance that is over has no text.
    pub fn new(partial: &'a Partial, stream: Option<u32>) -> Self {
        let over = partial.over != 0;
        let text = partial.text.as_str().unwrap_or_default();
        let text = if over { "" } else { text };
        Self { stream, text, over, onset_ms: ms(Time(partial.onset_ns)) }
    }
}

impl<'a> StreamReceipt<'a> {
    /// Reads a receipt about stream `stream` of the page.
    pub fn new(stream: u32, receipt: &'a Receipt) -> Self {
        let status = receipt.status.get();
        let time = |ns: u64| (ns > 0).then(|| ms(Time(ns)));
        Self {
            stream,
            status,
            text: receipt.note.as_str().unwrap_or_default(),
            heard: Some(Heard {
                seq: receipt.utterance().map(|seq| seq.0),
                confidence: receipt.confidence,
                snr_db: receipt.snr_db,
                onset_ms: time(receipt.onset_ns),
                ended_ms: time(receipt.end_ns),
            }),
            utterances: (status == ReceiptStatus::Over).then_some(Some(receipt.segments)),
        }
    }

    /// Ends a stream whose outcome is unknown, for the reason `why`.
    pub fn lost(stream: u32, why: &'a str) -> Self {
        let status = ReceiptStatus::Over;
        Self { stream, status, text: why, heard: None, utterances: Some(None) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::FixedText;
    use serde_json::json;

    fn read(message: PageMessage<'_>) -> Json {
        serde_json::from_str(&message.to_text()).unwrap()
    }

    #[test]
    fn page_messages_keep_their_keys() {
        let mut states = JointStates { at_ns: 1_500_000, ..JointStates::default() };
        states.position[3] = 0.123_456_789;
        states.gripper_percent = [99.99, 0.0];
        let joints = read(PageMessage::Joints(Joints::new(&states)));
        assert_eq!((&joints["t"], &joints["at_ms"]), (&json!("joints"), &json!(1.5)));
        assert_eq!((&joints["q"][3], &joints["grip"]), (&json!(0.12346), &json!([100.0, 0.0])));
        let accepted = Receipt {
            seq: 4,
            onset_ns: 2_500_000,
            end_ns: 1_002_500_000,
            confidence: 0.5,
            snr_db: 21.0,
            note: FixedText::truncated("the white one"),
            ..Receipt::default()
        };
        let status = ReceiptStatus::Over.into();
        let over = Receipt { status, segments: 2, ..Receipt::default() };
        let done = |answer| Done { id: 9, ok: true, error: None, answer };
        for (message, expected) in [
            (
                PageMessage::Receipt(StreamReceipt::new(7, &accepted)),
                json!({ "t": "receipt", "stream": 7, "status": "accepted", "text": "the white one",
                        "seq": 4, "confidence": 0.5, "snr_db": 21.0, "onset_ms": 2.5,
                        "ended_ms": 1002.5 }),
            ),
            (
                PageMessage::Receipt(StreamReceipt::new(7, &over)),
                json!({ "t": "receipt", "stream": 7, "status": "over", "text": "", "seq": null,
                        "confidence": 0.0, "snr_db": 0.0, "onset_ms": null, "ended_ms": null,
                        "utterances": 2 }),
            ),
            (
                PageMessage::Receipt(StreamReceipt::lost(7, "no answer")),
                json!({ "t": "receipt", "stream": 7, "status": "over", "text": "no answer",
                        "utterances": null }),
            ),
            (
                PageMessage::Done(done(Some(Answer::Accepted {
                    seq: 7,
                    waits_for: None,
                    known: false,
                }))),
                json!({ "t": "done", "id": 9, "ok": true, "seq": 7 }),
            ),
            (PageMessage::Done(done(None)), json!({ "t": "done", "id": 9, "ok": true })),
        ] {
            assert_eq!(read(message), expected);
        }
    }
}
