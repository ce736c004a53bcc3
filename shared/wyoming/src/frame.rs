//! Frames: the form of every event on the wire.

use std::io::{self, BufRead, Read, Write};

use serde_json::{Map, Value as Json, json};

/// Longest line of a frame, bytes. Older servers have all of an event's data in it.
pub const HEADER_MAX: usize = 1 << 20;
/// Longest data, and longest payload, of a frame, bytes.
pub const PART_MAX: usize = 1 << 20;

/// A frame: an event of any type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Type of the event, e.g. `transcript`.
    pub kind: String,
    /// Its values.
    pub data: Map<String, Json>,
    /// Its bytes, e.g. audio.
    pub payload: Vec<u8>,
}

/// Error of reading a frame. Nothing behind it can be read.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// A part is longer than its bound.
    #[error("its {part} has {found} bytes, expected at most {max}")]
    TooLong {
        /// The part: `header`, `data` or `payload`.
        part: &'static str,
        /// Announced length, or the length that was read, bytes.
        found: u64,
        /// The bound, bytes.
        max: usize,
    },
    /// The bytes are not a frame.
    #[error("invalid event: {0}")]
    Invalid(String),
    /// The bytes end within a frame.
    #[error("the connection ended within an event")]
    Cut,
    /// The bytes cannot be read.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl Frame {
    /// Returns a frame without payload. `data` is an object; other values are left out.
    pub fn new(kind: &str, data: Json) -> Self {
        let data = if let Json::Object(data) = data { data } else { Map::new() };
        Self { kind: kind.to_owned(), data, payload: Vec::new() }
    }

    /// Reads the next frame; `None` at the end of the bytes.
    ///
    /// # Errors
    /// If the bytes are not a frame, a part is longer than its bound, or reading fails.
    pub fn read(from: &mut impl BufRead) -> Result<Option<Self>, FrameError> {
        let mut line = Vec::new();
        from.by_ref().take(HEADER_MAX as u64 + 1).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        if line.len() > HEADER_MAX {
            let found = line.len() as u64;
            return Err(FrameError::TooLong { part: "header", found, max: HEADER_MAX });
        }
        if line.last() != Some(&b'\n') {
            return Err(FrameError::Cut);
        }
        let mut header = object(&line, "header")?;
        let Some(Json::String(kind)) = header.remove("type") else {
            return Err(FrameError::Invalid("its header has no type".to_owned()));
        };
        let mut data = match header.remove("data") {
            Some(Json::Object(data)) => data,
            None | Some(Json::Null) => Map::new(),
            Some(_) => return Err(FrameError::Invalid("its data is not an object".to_owned())),
        };
        // Both lengths are checked before anything is read behind the header.
        let lengths = (length(&header, "data")?, length(&header, "payload")?);
        if lengths.0 > 0 {
            data.extend(object(&part(from, lengths.0)?, "data")?);
        }
        Ok(Some(Self { kind, data, payload: part(from, lengths.1)? }))
    }

    /// Writes the frame.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, to: &mut impl Write) -> io::Result<()> {
        let mut header = json!({ "type": self.kind });
        let mut data = Vec::new();
        if !self.data.is_empty() {
            data = serde_json::to_vec(&self.data)?;
            header["data_length"] = data.len().into();
        }
        if !self.payload.is_empty() {
            header["payload_length"] = self.payload.len().into();
        }
        serde_json::to_writer(&mut *to, &header)?;
        to.write_all(b"\n")?;
        to.write_all(&data)?;
        to.write_all(&self.payload)
    }
}

fn object(bytes: &[u8], part: &str) -> Result<Map<String, Json>, FrameError> {
    match serde_json::from_slice(bytes) {
        Ok(Json::Object(object)) => Ok(object),
        Ok(_) => Err(FrameError::Invalid(format!("its {part} is not an object"))),
        Err(error) => Err(FrameError::Invalid(format!("its {part} is not JSON: {error}"))),
    }
}

/// Returns the announced length of a part, within the bound.
fn length(header: &Map<String, Json>, part: &'static str) -> Result<usize, FrameError> {
    let announced = match header.get(&format!("{part}_length")) {
        None | Some(Json::Null) => return Ok(0),
        Some(announced) => announced,
    };
    let Some(found) = announced.as_u64() else {
        // Without the value, which may be as long as a header.
        let what = format!("the length of its {part} is not a whole number");
        return Err(FrameError::Invalid(what));
    };
    match usize::try_from(found) {
        Ok(length) if length <= PART_MAX => Ok(length),
        _ => Err(FrameError::TooLong { part, found, max: PART_MAX }),
    }
}

/// Reads a part. Memory grows with the bytes that arrive, not with the announced length.
fn part(from: &mut impl BufRead, length: usize) -> Result<Vec<u8>, FrameError> {
    let mut bytes = Vec::new();
    from.by_ref().take(length as u64).read_to_end(&mut bytes)?;
    if bytes.len() == length { Ok(bytes) } else { Err(FrameError::Cut) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(mut bytes: &[u8]) -> Result<Option<Frame>, FrameError> {
        Frame::read(&mut bytes)
    }

    fn written(frame: &Frame) -> Vec<u8> {
        let mut bytes = Vec::new();
        frame.write(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn frame_is_read_as_other_programs_write_it() {
        // As wyoming 1.10.2, and as versions that had the data in the line.
        let new = b"{\"type\": \"transcript\", \"version\": \"1.10.2\", \"data_length\": 15}\n{\"text\": \"yes\"}";
        let old = b"{\"type\": \"transcript\", \"data\": {\"text\": \"yes\"}, \"payload_length\": null}\n";
        for bytes in [&new[..], old] {
            let frame = Frame::new("transcript", json!({ "text": "yes" }));
            assert_eq!(read(bytes).unwrap(), Some(frame));
        }
        assert_eq!(read(b"").unwrap(), None);
    }

    #[test]
    fn frame_with_a_wrong_part_is_refused() {
        let max = PART_MAX;
        for (bytes, expected) in [
            ("\n".to_owned(), "header is not JSON"),
            ("[]\n".to_owned(), "header is not an object"),
            ("{}\n".to_owned(), "no type"),
            ("{\"type\": 5}\n".to_owned(), "no type"),
            ("{\"type\": \"x\", \"data\": 5}\n".to_owned(), "data is not an object"),
            ("{\"type\": \"x\", \"data_length\": -1}\n".to_owned(), "data is not a whole number"),
            (
                "{\"type\": \"x\", \"payload_length\": 0.5}\n".to_owned(),
                "payload is not a whole number",
            ),
            ("{\"type\": \"x\", \"payload_length\": \"9\"}\n".to_owned(), "not a whole number"),
            ("{\"type\": \"x\", \"data_length\": 2}\n[]".to_owned(), "data is not an object"),
            ("{\"type\": \"x\", \"data_length\": 3}\n{}".to_owned(), "ended within"),
            ("{\"type\": \"x\", \"payload_length\": 1}\n".to_owned(), "ended within"),
            ("{\"type\": \"x\"}".to_owned(), "ended within"),
            (format!("{{\"type\": \"x\", \"data_length\": {}}}\n", max + 1), "its data has"),
            (format!("{{\"type\": \"x\", \"payload_length\": {}}}\n", u64::MAX), "at most 1048576"),
            ("x".repeat(HEADER_MAX + 1), "its header has 1048577 bytes"),
        ] {
            let error = read(bytes.as_bytes()).unwrap_err().to_string();
            assert!(error.contains(expected), "{bytes:.80}: {error}");
        }
    }

    /// Yields bytes one at a time, and counts them.
    struct Counted<'b>(&'b [u8], usize);

    impl Read for Counted<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            self.1 += 1;
            self.0.read(&mut into[..1])
        }
    }

    #[test]
    fn frame_announced_too_long_is_refused_before_its_bytes_are_read() {
        let header = format!("{{\"type\": \"x\", \"payload_length\": {}}}\n", PART_MAX + 1);
        let bytes = [header.as_bytes(), &[0; 100]].concat();
        let mut reader = io::BufReader::with_capacity(1, Counted(&bytes, 0));
        assert!(matches!(Frame::read(&mut reader), Err(FrameError::TooLong { .. })));
        assert_eq!(reader.get_ref().1, header.len());
    }

    proptest! {
        #[test]
        fn frame_survives_a_round_trip(kind in ".{0,20}", text in ".{0,200}", number: i64,
                                       payload in prop::collection::vec(any::<u8>(), 0..500)) {
            let data = json!({ "text": text, "number": number, "nothing": null });
            let frame = Frame { payload, ..Frame::new(&kind, data) };
            let bytes = [written(&frame), written(&Frame::new("next", json!({})))].concat();
            let mut rest = &bytes[..];
            prop_assert_eq!(Frame::read(&mut rest).unwrap(), Some(frame));
            prop_assert_eq!(Frame::read(&mut rest).unwrap().unwrap().kind, "next");
            prop_assert_eq!(Frame::read(&mut rest).unwrap(), None);
        }

        #[test]
        fn frame_that_is_cut_anywhere_is_refused(text in ".{0,50}", payload in prop::collection::vec(any::<u8>(), 1..50),
                                                 share in 0.0..1.0_f64) {
            let frame = Frame { payload, ..Frame::new("x", json!({ "text": text })) };
            let bytes = written(&frame);
            let kept = 1 + ((bytes.len() - 2) as f64 * share) as usize;
            prop_assert!(matches!(read(&bytes[..kept]), Err(FrameError::Cut)));
        }

        #[test]
        fn any_bytes_are_a_frame_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..400), length: u64) {
            if let Ok(Some(frame)) = read(&bytes) {
                prop_assert!(frame.payload.len() <= bytes.len());
            }
            // Behind a valid header with any lengths.
            for part in ["data", "payload"] {
                let header = format!("{{\"type\":\"x\",\"{part}_length\":{length}}}\n");
                let all = [header.as_bytes(), &bytes].concat();
                if let Ok(Some(frame)) = read(&all) {
                    prop_assert!(frame.payload.len() <= bytes.len() && length <= bytes.len() as u64);
                }
            }
        }
    }
}
