//! Events of the Wyoming protocol, which any server of speech may send.

use wyoming::{AudioFormat, Event, Frame, HEADER_MAX, Info, PART_MAX, Program};

pub(super) fn run(input: &[u8]) {
    let mut rest = input;
    while let Ok(Some(frame)) = Frame::read(&mut rest) {
        assert!(frame.payload.len() <= input.len().min(PART_MAX));
        let written = bytes(&frame);
        assert_eq!(Frame::read(&mut &written[..]).expect("a frame"), Some(frame.clone()));
        if let Ok(event) = Event::try_from(frame) {
            assert_eq!(Event::try_from(Frame::from(&event)), Ok(event));
        }
    }
}

fn bytes(frame: &Frame) -> Vec<u8> {
    let mut bytes = Vec::new();
    frame.write(&mut bytes).expect("a vector takes everything");
    bytes
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let format = AudioFormat { rate_hz: 22_050, width: 2, channels: 1 };
    let program = Program { name: "piper".to_owned(), version: Some("1.6.0".to_owned()) };
    let info = Info { asr: vec![program.clone()], tts: vec![program] };
    let events = [
        Event::Info(info),
        Event::Ping(Some("x".to_owned())),
        Event::AudioStart(format),
        Event::AudioChunk(format, (0..200).collect()),
        Event::AudioStop,
        Event::Transcript("the white one".to_owned()),
        Event::Error("no model".to_owned()),
    ];
    let all: Vec<Vec<u8>> = events.iter().map(|event| bytes(&Frame::from(event))).collect();
    let old = br#"{"type": "transcript", "data": {"text": "yes"}, "payload_length": null}
"#;
    let huge = br#"{"type": "audio-chunk", "payload_length": 18446744073709551615}
"#;
    // Lists within lists, as deep as a line is long.
    let deep = format!("{{\"type\": \"x\", \"data\": {}", "[".repeat(HEADER_MAX / 2));
    vec![all.concat(), old.to_vec(), huge.to_vec(), deep.into_bytes()]
}
