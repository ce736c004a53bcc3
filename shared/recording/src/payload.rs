//! Payloads in postcard as JSON.

use messages::schema::Schema;
use messages::topics::Topic;
use messages::{Injection, PolicyView, Sighting, TableView, TrajectoryView, WorldView};
use serde::{Serialize, de::DeserializeOwned};

use crate::RecordingError;

/// The payload of a topic as JSON.
///
/// # Errors
/// The bytes are not such a payload.
pub fn to_json(topic: &Topic, bytes: &[u8]) -> Result<Vec<u8>, RecordingError> {
    let wrong = |what: String| RecordingError::Payload(topic.name.to_owned(), what);
    macro_rules! by_name {
        ($($payload:ty),+) => {
            match topic.payload {
                $(name if name == <$payload as Schema>::NAME => json::<$payload>(bytes),)+
                other => Err(format!("{other} is not a payload in postcard")),
            }
        };
    }
    let json = by_name!(Injection, PolicyView, WorldView, TrajectoryView, Sighting, TableView);
    json.map_err(wrong)
}

fn json<T: Serialize + DeserializeOwned>(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let payload: T = postcard::from_bytes(bytes).map_err(|error| error.to_string())?;
    serde_json::to_vec(&payload).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channels::group_topics;
    use messages::topics;

    #[test]
    fn every_payload_in_postcard_becomes_json() {
        for topic in group_topics().filter(|topic| (topic.layout)().is_none()) {
            // Wrong bytes, but of a known type.
            let error = to_json(topic, &[]).unwrap_err().to_string();
            assert!(!error.contains("is not a payload"), "{error}");
        }
        assert!(to_json(&topics::MARK, &[]).unwrap_err().to_string().contains("is not a payload"));
        let view = PolicyView { belief: vec![0.25, 0.75], ..PolicyView::default() };
        let json = to_json(&topics::VIEW, &postcard::to_stdvec(&view).unwrap()).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(json["belief"], serde_json::json!([0.25, 0.75]));
    }
}
