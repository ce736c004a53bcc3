//! Journals as a recording: their records, and what each says as a log.

use std::collections::BTreeMap;
use std::io::{BufWriter, Write};
use std::path::Path;

use mcap::records::MessageHeader;
use serde_json::{Value, json};

use crate::RecordingError;
use crate::channels::{self, Channel, JSONSCHEMA, Picture, message_encoding};
use crate::file::{create_private, options};
use crate::foxglove::{Log, Time, level};

/// A record of a journal.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The service whose journal it is in.
    pub service: String,
    /// Its number.
    pub seq: u64,
    /// When it was written, nanoseconds since 1970.
    pub at_ns: u64,
    /// What it says.
    pub text: String,
    /// The record.
    pub record: Value,
}

/// Writes records in their order into a new file: each as JSON on `/journal/SERVICE`, and its text on
/// `/log`.
///
/// # Errors
/// The file exists or cannot be written.
pub fn write(entries: &[Entry], to: &Path) -> Result<(), RecordingError> {
    let failed = |error| RecordingError::mcap(to)(error);
    let mut writer = options().create(BufWriter::new(create_private(to)?)).map_err(failed)?;
    let log = channels::all().into_iter().find(|channel| channel.topic == Picture::Log.topic());
    let mut known: BTreeMap<String, u16> = BTreeMap::new();
    let mut add = |writer: &mut mcap::Writer<_>, channel: &Channel| {
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
    for Entry { service, seq, at_ns, text, record } in entries {
        let line = Log {
            timestamp: Time::at(*at_ns),
            level: level::INFO,
            message: text.clone(),
            name: service.clone(),
            ..Log::default()
        };
        let record = (of_journal(service), json!({ "seq": seq, "record": record }));
        let line = log.clone().map(|channel| (channel, json!(line)));
        for (channel, message) in std::iter::once(record).chain(line) {
            let header = MessageHeader {
                channel_id: add(&mut writer, &channel).map_err(failed)?,
                sequence: u32::try_from(*seq).unwrap_or(0),
                log_time: *at_ns,
                publish_time: *at_ns,
            };
            let message = message.to_string();
            writer.write_to_known_channel(&header, message.as_bytes()).map_err(failed)?;
        }
    }
    writer.finish().map_err(failed)?;
    writer.into_inner().flush().map_err(RecordingError::io(to))
}

fn of_journal(service: &str) -> Channel {
    let record = json!({ "type": "object", "properties": {} });
    let properties = json!({ "seq": { "type": "integer" }, "record": record });
    Channel {
        topic: format!("/journal/{service}"),
        schema: format!("whichone.{service}.Record"),
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
            service: service.to_owned(),
            seq,
            at_ns: 1_000 + seq,
            text: format!("record {seq}"),
            record: json!({ "Accepted": seq }),
        };
        write(&[entry("speech", 1), entry("policy", 2), entry("speech", 3)], &to).unwrap();
        let found = summary(&to).unwrap();
        let topics: Vec<_> =
            found.topics.iter().map(|(name, count)| (name.as_str(), *count)).collect();
        assert_eq!(topics, [("/journal/policy", 1), ("/journal/speech", 2), ("/log", 3)]);
        assert_eq!(found.span_ns, (1_001, 1_003));
        assert!(write(&[], &to).is_err(), "an existing file is never replaced");
    }
}
