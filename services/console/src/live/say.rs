//! The service `say`: an utterance of the operator, as if typed.

use http_api::request_key;
use recording::live::Service;
use serde::Deserialize;
use serde_json::json;

use crate::hub::command::{Words, typed};
use crate::server::message::spoken_text;

/// Number among the services.
pub const NUMBER: u32 = 1;
/// Longest key, bytes.
const KEY_MAX: usize = 256;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    text: String,
    key: Option<String>,
}

/// Returns the description of the service for viewers.
pub fn service() -> Service {
    let text = json!({ "type": "string" });
    Service {
        id: NUMBER,
        name: "/say",
        kind: "whichone.Say",
        request: json!({
            "title": "whichone.Say.Request",
            "type": "object",
            "properties": { "text": text, "key": text },
            "required": ["text"],
        }),
        response: json!({
            "title": "whichone.Say.Response",
            "type": "object",
            "properties": {
                "utterance": { "type": "integer" },
                "known": { "type": "boolean" },
            },
            "required": ["utterance", "known"],
        }),
    }
}

/// Reads a request. Requests with the same key are one utterance; one without a key is a new one.
///
/// # Errors
/// It is not JSON with a text, or the text is too long.
pub fn read(request: &[u8]) -> Result<Words, String> {
    let Request { text, key } = serde_json::from_slice(request).map_err(|error| {
        format!("invalid request: {error}; help: expected {{\"text\": \"…\", \"key\": \"…\"}}")
    })?;
    let mut words = typed(&spoken_text(&text)?);
    if let Some(key) = key {
        if key.is_empty() || key.len() > KEY_MAX {
            return Err(format!("key: expected 1 to {KEY_MAX} bytes, found {}", key.len()));
        }
        // All live viewers are one client of the speech service.
        words.key = Some(request_key("live viewers", &key));
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_with_the_same_key_are_one() {
        let read = |request: &str| read(request.as_bytes());
        let one = read(r#"{"text":"the clear bowl","key":"a"}"#).unwrap();
        let again = read(r#"{"text":"  the clear\nbowl ","key":"a"}"#).unwrap();
        let other = read(r#"{"text":"the clear bowl","key":"b"}"#).unwrap();
        let none = read(r#"{"text":"the clear bowl"}"#).unwrap();
        assert_eq!((one.text.as_str(), &one), ("the clear bowl", &again));
        assert!(one.key != other.key && one.key.is_some() && none.key.is_none());
    }

    #[test]
    fn invalid_requests_name_what_is_wrong() {
        let long = format!(r#"{{"text":"yes","key":"{}"}}"#, "k".repeat(KEY_MAX + 1));
        for (request, expected) in [
            ("", "invalid request"),
            ("[]", "invalid request"),
            (r#"{"key":"a"}"#, "missing field `text`"),
            (r#"{"text":"yes","kye":"a"}"#, "unknown field `kye`"),
            (r#"{"text":" "}"#, "expected words"),
            (long.as_str(), "1 to 256 bytes"),
            (r#"{"text":"yes","key":""}"#, "1 to 256 bytes"),
        ] {
            let why = read(request.as_bytes()).unwrap_err();
            assert!(why.contains(expected), "{request}: {why}");
        }
    }
}
