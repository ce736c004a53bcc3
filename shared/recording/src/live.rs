//! Messages of a live view over the protocol `foxglove.sdk.v1`, in both directions.
//!
//! Pure. Texts are JSON objects with `op`; binary messages begin with an operation code, and their
//! numbers are little-endian.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Value as Json, json};

use crate::channels::{Channel, ChannelId, message_encoding};

/// Name of the protocol, which a viewer requests when it connects.
pub const SUBPROTOCOL: &str = "foxglove.sdk.v1";
/// Operation code of a message of a channel.
const MESSAGE_DATA: u8 = 1;
/// Operation code of the call of a service.
const CALL_REQUEST: u8 = 2;
/// Operation code of the response to a call.
const CALL_RESPONSE: u8 = 3;

/// A message of a viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Request {
    /// Subscriptions that begin.
    Subscribe(Vec<Subscription>),
    /// Numbers of subscriptions that end.
    Unsubscribe(Vec<u32>),
    /// Names of parameters (empty for all), and the number of the request.
    GetParameters(Vec<String>, Option<String>),
    /// Parameters are read-only; the number of the request.
    SetParameters(Option<String>),
    /// Names of parameters whose changes are wanted; there are none.
    SubscribeParameters(Vec<String>),
    /// The end of such a subscription.
    UnsubscribeParameters,
    /// A call of a service.
    Call(Call),
}

/// A subscription to a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Subscription {
    /// Number of the subscription, chosen by the viewer.
    pub id: u32,
    /// The channel's number.
    pub channel_id: u64,
}

impl Subscription {
    /// Returns the channel.
    pub fn channel(self) -> ChannelId {
        ChannelId(usize::try_from(self.channel_id).unwrap_or(usize::MAX))
    }
}

/// A call of a service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    /// Number of the service.
    pub service: u32,
    /// Number of the call, chosen by the viewer.
    pub id: u32,
    /// Encoding of the request.
    pub encoding: String,
    /// The request.
    pub request: Vec<u8>,
}

#[derive(Deserialize)]
#[serde(tag = "op", rename_all = "camelCase", rename_all_fields = "camelCase")]
enum Text {
    Subscribe { subscriptions: Vec<Subscription> },
    Unsubscribe { subscription_ids: Vec<u32> },
    GetParameters { parameter_names: Vec<String>, id: Option<String> },
    SetParameters { id: Option<String> },
    SubscribeParameterUpdates { parameter_names: Vec<String> },
    UnsubscribeParameterUpdates {},
}

/// Reads a text message.
///
/// # Errors
/// It is not a message that this server offers to answer.
pub fn read_text(text: &str) -> Result<Request, String> {
    let text: Text =
        serde_json::from_str(text).map_err(|error| format!("invalid message: {error}"))?;
    Ok(match text {
        Text::Subscribe { subscriptions } => Request::Subscribe(subscriptions),
        Text::Unsubscribe { subscription_ids } => Request::Unsubscribe(subscription_ids),
        Text::GetParameters { parameter_names, id } => Request::GetParameters(parameter_names, id),
        Text::SetParameters { id } => Request::SetParameters(id),
        Text::SubscribeParameterUpdates { parameter_names } => {
            Request::SubscribeParameters(parameter_names)
        }
        Text::UnsubscribeParameterUpdates {} => Request::UnsubscribeParameters,
    })
}

/// Reads a binary message: the call of a service.
///
/// # Errors
/// It is another message, or its lengths are wrong.
pub fn read_binary(bytes: &[u8]) -> Result<Request, String> {
    let (code, rest) = bytes.split_first().ok_or("expected a binary message, found no bytes")?;
    if *code != CALL_REQUEST {
        return Err(format!("expected operation code {CALL_REQUEST}, found {code}"));
    }
    let call = || {
        let (service, rest) = number(rest)?;
        let (id, rest) = number(rest)?;
        let (length, rest) = number(rest)?;
        let (encoding, request) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        let encoding = std::str::from_utf8(encoding).ok()?.to_owned();
        Some(Request::Call(Call { service, id, encoding, request: request.to_vec() }))
    };
    call().ok_or_else(|| "service call: expected three numbers and an encoding".to_owned())
}

fn number(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*number), rest))
}

/// Returns the first message to a viewer. The session differs between starts of the console, so
/// that a viewer that reconnects knows whether subscriptions are new.
pub fn server_info(name: &str, session: &str, metadata: &BTreeMap<&str, String>) -> String {
    json!({
        "op": "serverInfo",
        "name": name,
        "capabilities": ["parameters", "parametersSubscribe", "services"],
        "supportedEncodings": ["json"],
        "metadata": metadata,
        "sessionId": session,
    })
    .to_string()
}

/// Returns the message that lists the channels.
pub fn advertise<'a>(channels: impl Iterator<Item = (ChannelId, &'a Channel)>) -> String {
    let channel = |(ChannelId(id), channel): (ChannelId, &Channel)| {
        json!({
            "id": id,
            "topic": channel.topic,
            "encoding": message_encoding(channel.schema_encoding),
            "schemaName": channel.schema,
            "schemaEncoding": channel.schema_encoding,
            "schema": channel.definition,
        })
    };
    let channels: Vec<Json> = channels.map(channel).collect();
    json!({ "op": "advertise", "channels": channels }).to_string()
}

/// A listed service: its number, name and type, with the JSON Schemas of request and response.
#[derive(Clone, Debug)]
pub struct Service {
    /// Number of the service.
    pub id: u32,
    /// Name of the service.
    pub name: &'static str,
    /// Type of the service.
    pub kind: &'static str,
    /// The schema of a request.
    pub request: Json,
    /// The schema of a response.
    pub response: Json,
}

/// Returns the message that lists the services.
pub fn advertise_services(services: &[Service]) -> String {
    let schema = |kind: &str, part: &str, schema: &Json| {
        json!({
            "encoding": "json",
            "schemaName": format!("{kind}.{part}"),
            "schemaEncoding": "jsonschema",
            "schema": schema.to_string(),
        })
    };
    let service = |Service { id, name, kind, request, response }: &Service| {
        json!({
            "id": id,
            "name": name,
            "type": kind,
            "request": schema(kind, "Request", request),
            "response": schema(kind, "Response", response),
        })
    };
    let services: Vec<Json> = services.iter().map(service).collect();
    json!({ "op": "advertiseServices", "services": services }).to_string()
}

/// Returns the values of parameters, in answer to the request `id`.
pub fn parameter_values<'a>(
    parameters: impl Iterator<Item = (&'a str, &'a str)>,
    id: Option<&str>,
) -> String {
    let parameter = |(name, value)| json!({ "name": name, "value": value });
    let parameters: Vec<Json> = parameters.map(parameter).collect();
    let mut message = json!({ "op": "parameterValues", "parameters": parameters });
    if let Some(id) = id {
        message["id"] = id.into();
    }
    message.to_string()
}

/// Severity of a status message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Something is missing or late.
    Warning = 1,
    /// A request has failed.
    Error = 2,
}

/// Returns a message for the user of a viewer.
pub fn status(level: Level, message: &str) -> String {
    json!({ "op": "status", "level": level as u8, "message": message }).to_string()
}

/// Returns a message of a channel that was sent at `at_ns`, nanoseconds since 1970.
pub fn message_data(subscription: u32, at_ns: u64, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(13 + data.len());
    bytes.push(MESSAGE_DATA);
    bytes.extend(subscription.to_le_bytes());
    bytes.extend(at_ns.to_le_bytes());
    bytes.extend(data);
    bytes
}

/// Returns the response to a call.
pub fn call_response(service: u32, call: u32, response: &Json) -> Vec<u8> {
    const ENCODING: &[u8] = b"json";
    let mut bytes = vec![CALL_RESPONSE];
    for number in [service, call, ENCODING.len() as u32] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(ENCODING);
    bytes.extend(response.to_string().as_bytes());
    bytes
}

/// Returns the message that a call has failed.
pub fn call_failure(service: u32, call: u32, why: &str) -> String {
    json!({ "op": "serviceCallFailure", "serviceId": service, "callId": call, "message": why })
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn call(encoding: &[u8], length: u32, request: &[u8]) -> Vec<u8> {
        let mut bytes = vec![2, 1, 0, 0, 0, 9, 0, 0, 0];
        bytes.extend(length.to_le_bytes());
        bytes.extend(encoding);
        bytes.extend(request);
        bytes
    }

    #[test]
    fn texts_of_viewers_are_read() {
        for (text, expected) in [
            (
                r#"{"op":"subscribe","subscriptions":[{"id":0,"channelId":3}]}"#,
                Request::Subscribe(vec![Subscription { id: 0, channel_id: 3 }]),
            ),
            (r#"{"op":"unsubscribe","subscriptionIds":[0,1]}"#, Request::Unsubscribe(vec![0, 1])),
            (
                r#"{"op":"getParameters","parameterNames":["/a"],"id":"x"}"#,
                Request::GetParameters(vec!["/a".to_owned()], Some("x".to_owned())),
            ),
            (
                r#"{"op":"getParameters","parameterNames":[]}"#,
                Request::GetParameters(Vec::new(), None),
            ),
            (
                r#"{"op":"setParameters","parameters":[{"name":"/a","value":1}],"id":"y"}"#,
                Request::SetParameters(Some("y".to_owned())),
            ),
            (
                r#"{"op":"subscribeParameterUpdates","parameterNames":["/a"]}"#,
                Request::SubscribeParameters(vec!["/a".to_owned()]),
            ),
            (
                r#"{"op":"unsubscribeParameterUpdates","parameterNames":["/a"]}"#,
                Request::UnsubscribeParameters,
            ),
        ] {
            assert_eq!(read_text(text), Ok(expected), "{text}");
        }
        for wrong in [
            "",
            "[]",
            "{}",
            r#"{"op":"fetchAsset","uri":"file:///etc/passwd","requestId":1}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]}"#,
            r#"{"op":"subscribe"}"#,
        ] {
            assert!(read_text(wrong).unwrap_err().starts_with("invalid message"), "{wrong}");
        }
    }

    #[test]
    fn calls_are_read_and_answered() {
        let read = read_binary(&call(b"json", 4, b"{}"));
        let Ok(Request::Call(found)) = read else { panic!("{read:?}") };
        assert_eq!((found.service, found.id, found.encoding.as_str()), (1, 9, "json"));
        assert_eq!(found.request, b"{}");
        for wrong in [
            Vec::new(),
            vec![1, 0, 0, 0, 0],
            vec![2, 1, 0],
            call(b"json", 5, b""),
            call(b"json", u32::MAX, b"{}"),
            call(&[0xff], 1, b"{}"),
        ] {
            assert!(read_binary(&wrong).is_err(), "{wrong:?}");
        }
        let answer = call_response(1, 9, &json!({ "utterance": 4 }));
        assert_eq!(answer[..13], [3, 1, 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0]);
        assert_eq!(&answer[13..], b"json{\"utterance\":4}");
        let data = message_data(7, 0x0102, b"ab");
        assert_eq!(data, [1, 7, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, b'a', b'b']);
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_are_read_or_rejected(bytes: Vec<u8>, text: String) {
            let _ = read_text(&text);
            let _ = read_binary(&bytes);
            let mut call = vec![CALL_REQUEST];
            call.extend(&bytes);
            if let Ok(Request::Call(found)) = read_binary(&call) {
                prop_assert_eq!(12 + found.encoding.len() + found.request.len(), bytes.len());
            }
        }
    }
}
