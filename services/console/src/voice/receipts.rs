//! What a page is told of what its viewer said.

use messages::{Receipt, ReceiptStatus};
use serde_json::json;
use service::Time;

use crate::hub::ms;

/// The frame that tells a page what the robot made of stream `number`.
pub(super) fn frame(number: u32, receipt: &Receipt) -> String {
    let status = ReceiptStatus::from_code(receipt.status).unwrap_or(ReceiptStatus::Refused);
    let time = |ns: u64| (ns > 0).then(|| ms(Time(ns)));
    let mut frame = json!({
        "t": "receipt",
        "stream": number,
        "status": status,
        "text": receipt.note.as_str().unwrap_or_default(),
        "seq": receipt.utterance().map(|seq| seq.0),
        "confidence": receipt.confidence,
        "snr_db": receipt.snr_db,
        "onset_ms": time(receipt.onset_ns),
        "ended_ms": time(receipt.end_ns),
    });
    if status == ReceiptStatus::Over {
        frame["utterances"] = receipt.segments.into();
    }
    frame.to_string()
}

/// The frame that tells a page that nobody knows what became of stream `number`.
pub(super) fn lost(number: u32, why: &str) -> String {
    json!({ "t": "receipt", "stream": number, "status": "over", "text": why, "utterances": null })
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::FixedText;
    use serde_json::Value as Json;

    fn read(frame: &str) -> Json {
        serde_json::from_str(frame).unwrap()
    }

    #[test]
    fn a_receipt_tells_words_and_times() {
        let receipt = Receipt {
            seq: 4,
            onset_ns: 2_500_000,
            end_ns: 1_002_500_000,
            confidence: 0.5,
            snr_db: 21.0,
            note: FixedText::truncated("the white one"),
            ..Receipt::default()
        };
        let frame = read(&frame(7, &receipt));
        assert_eq!((&frame["stream"], &frame["status"]), (&7.into(), &"accepted".into()));
        assert_eq!((&frame["text"], &frame["seq"]), (&"the white one".into(), &4.into()));
        assert_eq!((&frame["onset_ms"], &frame["ended_ms"]), (&2.5.into(), &1002.5.into()));
        assert!(frame.get("utterances").is_none());
    }

    #[test]
    fn the_end_of_a_stream_tells_how_much_was_in_it() {
        let status = ReceiptStatus::Over.code();
        let over = read(&frame(7, &Receipt { status, segments: 2, ..Receipt::default() }));
        assert_eq!((&over["status"], &over["utterances"]), (&"over".into(), &2.into()));
        assert_eq!((&over["seq"], &over["ended_ms"]), (&Json::Null, &Json::Null));
        assert_eq!(read(&lost(7, "why"))["text"], "why");
    }
}
