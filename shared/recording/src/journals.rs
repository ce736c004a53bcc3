//! Journals and flights as a recording: their records or steps, and the text of records as a log.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use serde_json::{Value, json};

use crate::RecordingError;
use crate::channels::{self, Channel, JSONSCHEMA, Picture, message_encoding};
use crate::file::{create_private, options};
use crate::foxglove::{Log, Time, level};

/// Origin of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A record of a journal.
    Journal,
    /// An event of a flight.
    FlightIn,
    /// Statement of a service in a pass of a flight.
    FlightOut,
}

impl Origin {
    /// The topic of a service's entries, and their schema's last word.
    fn topic(self, service: &str) -> (String, &'static str) {
        match self {
            Self::Journal => (format!("/journal/{service}"), "Record"),
            Self::FlightIn => (format!("/flight/{service}/in"), "Event"),
            Self::FlightOut => (format!("/flight/{service}/out"), "Effects"),
        }
    }
}

/// A record of a journal, or a step of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Origin of the entry.
    pub origin: Origin,
    /// The service whose journal or flight it is in.
    pub service: String,
    /// Number of the record, or of the pass.
    pub seq: u64,
    /// When it was written, nanoseconds since 1970.
    pub at_ns: u64,
    /// Text of a record.
    pub text: Option<String>,
    /// The record, or the step.
    pub record: Value,
}

/// A new file of entries.
pub struct Writer {
    writer: mcap::Writer<BufWriter<File>>,
    path: PathBuf,
    log: Option<Channel>,
    /// Numbers of the topics.
    known: BTreeMap<String, u16>,
}

impl std::fmt::Debug for Writer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer").field("path", &self.path).finish_non_exhaustive()
    }
}

impl Writer {
    /// Creates the file.
    ///
    /// # Errors
    /// It exists or cannot be written.
    pub fn create(to: &Path) -> Result<Self, RecordingError> {
        let writer = options().create(BufWriter::new(create_private(to)?));
        let writer = writer.map_err(RecordingError::mcap(to))?;
        let log = channels::all().into_iter().find(|channel| channel.topic == Picture::Log.topic());
        Ok(Self { writer, path: to.to_owned(), log, known: BTreeMap::new() })
    }

    /// Adds an entry as JSON on its topic, and its text, if it has one, on `/log`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, entry: &Entry) -> Result<(), RecordingError> {
        let message = json!({ "seq": entry.seq, "record": entry.record });
        self.put(&channel_of(entry), entry, &message)?;
        let (Some(text), Some(log)) = (&entry.text, self.log.clone()) else { return Ok(()) };
        let line = Log {
            timestamp: Time::at(entry.at_ns),
            level: level::INFO,
            message: text.clone(),
            name: entry.service.clone(),
            ..Log::default()
        };
        self.put(&log, entry, &json!(line))
    }

    fn put(
        &mut self,
        channel: &Channel,
        entry: &Entry,
        message: &Value,
    ) -> Result<(), RecordingError> {
        let Self { writer, path, known, .. } = self;
        let mut id = || {
            if let Some(id) = known.get(&channel.topic) {
                return Ok(*id);
            }
            let Channel { topic, schema, schema_encoding, definition, .. } = channel;
            let schema = writer.add_schema(schema, schema_encoding, definition.as_bytes())?;
            let encoding = message_encoding(schema_encoding);
            let id = writer.add_channel(schema, topic, encoding, &BTreeMap::new())?;
            known.insert(topic.clone(), id);
            Ok(id)
        };
        let header = MessageHeader {
            channel_id: id().map_err(RecordingError::mcap(path))?,
            sequence: u32::try_from(entry.seq).unwrap_or(0),
            log_time: entry.at_ns,
            publish_time: entry.at_ns,
        };
        let written = writer.write_to_known_channel(&header, message.to_string().as_bytes());
        written.map_err(RecordingError::mcap(path))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.writer.finish().map_err(RecordingError::mcap(&self.path))?;
        self.writer.into_inner().flush().map_err(RecordingError::io(&self.path))
    }
}

fn channel_of(entry: &Entry) -> Channel {
    let (topic, name) = entry.origin.topic(&entry.service);
    let record = json!({ "type": "object", "properties": {} });
    let properties = json!({ "seq": { "type": "integer" }, "record": record });
    Channel {
        topic,
        schema: format!("whichone.{}.{name}", entry.service),
        schema_encoding: JSONSCHEMA,
        definition: json!({ "type": "object", "properties": properties }).to_string(),
        is_state: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::summary;

    #[test]
    fn records_of_several_journals_are_channels_of_their_own() {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().join("journals.mcap");
        let entry = |service: &str, seq| Entry {
            origin: Origin::Journal,
            service: service.to_owned(),
            seq,
            at_ns: 1_000 + seq,
            text: Some(format!("record {seq}")),
            record: json!({ "Accepted": seq }),
        };
        let step = Entry { origin: Origin::FlightOut, text: None, ..entry("arm", 3) };
        let mut writer = Writer::create(&to).unwrap();
        for entry in [entry("speech", 1), entry("policy", 2), entry("speech", 3), step] {
            writer.add(&entry).unwrap();
        }
        writer.finish().unwrap();
        let found = summary(&to).unwrap();
        let topics: Vec<_> =
            found.topics.iter().map(|(name, count)| (name.as_str(), *count)).collect();
        assert_eq!(
            topics,
            [("/flight/arm/out", 1), ("/journal/policy", 1), ("/journal/speech", 2), ("/log", 3)]
        );
        assert_eq!(found.span_ns, (1_001, 1_003));
        assert!(Writer::create(&to).is_err(), "an existing file is never replaced");
    }
}
