//! Messages of pages: text frames with JSON, checked key by key.

use messages::{PromptId, StopId};
use serde_json::Value as Json;
use service::Time;
use vocabulary::PersonId;

use crate::hub::command::{Verb, Words};
use crate::hub::{Role, ViewerId};

/// Longest frame that a page may send, bytes.
pub const FRAME_BYTES_MAX: usize = 64 << 10;
/// The version of this protocol.
pub const PROTOCOL: u64 = 2;
/// Most alternatives of a browser's recogniser.
const ALTERNATIVES_MAX: usize = 5;
/// Largest weight of an alternative: of any of them the sum is a number.
const WEIGHT_MAX: f64 = 1e6;
/// Longest text of an utterance, characters.
const TEXT_MAX: usize = 1_000;
/// Longest name of a viewer, characters.
const NAME_MAX: usize = 40;
/// Longest time since an utterance, milliseconds.
const OLDEST_MS: f64 = 120_000.0;

#[derive(Clone, Debug, PartialEq)]
pub struct Hello {
    /// Kept by the page through its reloads.
    pub session: String,
    pub name: String,
    pub last_line: u64,
    pub role: Role,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    Ping(Json),
    Do(u64, Do),
    Wrong(u64, String),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Do {
    Ask(Verb),
    /// Stop the arm.
    Stop,
    /// Release this stop, 0 for any.
    Release(StopId),
    Take,
    Give(ViewerId),
    Keep,
    Restart(String),
}

pub fn hello(text: &str) -> Result<Hello, String> {
    let json = object(text)?;
    if json["t"] != "hello" {
        return Err("expected a hello first".to_owned());
    }
    if json["protocol"] != PROTOCOL {
        let theirs = &json["protocol"];
        return Err(format!("expected protocol {PROTOCOL}, found {theirs}; help: reload the page"));
    }
    let session = json["session"].as_str().unwrap_or_default();
    if session.len() != 32 || !session.bytes().all(|b| b.is_ascii_hexdigit()) {
        return Err("session: expected 32 hexadecimal digits".to_owned());
    }
    let name = plain(json["name"].as_str().unwrap_or_default()).chars().take(NAME_MAX).collect();
    let role = match json["role"].as_str() {
        Some("operator") => Role::Operator,
        Some("viewer") | None => Role::Viewer,
        Some("screen") => Role::Screen,
        Some(other) => {
            return Err(format!("role: `{other}` is not one of operator, viewer, screen"));
        }
    };
    let last_line = json["last_line"].as_u64().unwrap_or(0);
    Ok(Hello { session: session.to_owned(), name, last_line, role })
}

/// Reads a later message; `now` bounds the times in it.
pub fn message(text: &str, now: Time) -> Result<Message, String> {
    let json = object(text)?;
    match json["t"].as_str() {
        Some("ping") if json["at"].is_number() => Ok(Message::Ping(json["at"].clone())),
        Some("ping") => Err("at: expected a number".to_owned()),
        Some("do") => {
            // A stop counts without a number as well.
            let id = json["id"].as_u64().or((json["do"] == "stop").then_some(0));
            let id = id.ok_or("id: expected a whole number from 0 on")?;
            Ok(match what(&json, now) {
                Ok(what) => Message::Do(id, what),
                Err(why) => Message::Wrong(id, why),
            })
        }
        Some("hello") => Err("hello: expected once, at first".to_owned()),
        Some(other) => Err(format!("t: `{other}` is not one of ping, do")),
        None => Err("t: expected a text".to_owned()),
    }
}

fn object(text: &str) -> Result<Json, String> {
    let json: Json =
        serde_json::from_str(text).map_err(|error| format!("invalid JSON: {error}"))?;
    if json.is_object() { Ok(json) } else { Err("expected an object".to_owned()) }
}

fn what(json: &Json, now: Time) -> Result<Do, String> {
    let verb = json["do"].as_str().ok_or("do: expected a text")?;
    Ok(match verb {
        "say" => Do::Ask(Verb::Say(words(json, now)?)),
        "not_that" => Do::Ask(Verb::NotThat),
        "start_over" => Do::Ask(Verb::StartOver),
        "stop" => Do::Stop,
        "resume" => Do::Release(StopId(number(json, "stop", "a stop, as in `arm`")?)),
        "take_control" => Do::Take,
        "keep_control" => Do::Keep,
        "give_control" => {
            let viewer = json["viewer"].as_str().and_then(|viewer| viewer.parse().ok());
            Do::Give(viewer.ok_or("viewer: expected a viewer, e.g. \"v3\"")?)
        }
        "restart_service" => {
            let service = json["service"].as_str().filter(|name| !name.is_empty());
            Do::Restart(service.ok_or("service: expected a service's name")?.to_owned())
        }
        _ => match verb.strip_prefix("study.") {
            Some(verb) => Do::Ask(Verb::Study(verb.to_owned(), json.clone())),
            None => return Err(format!("do: unknown command `{verb}`")),
        },
    })
}

fn words(json: &Json, now: Time) -> Result<Words, String> {
    let text = spoken_text(json["text"].as_str().ok_or("text: expected a text")?)?;
    let spoken = match json["source"].as_str() {
        Some("browser") => true,
        Some("typed") | None => false,
        Some(other) => return Err(format!("source: `{other}` is not one of typed, browser")),
    };
    let (began, ended) = (moment(json, "began_ms", now)?, moment(json, "ended_ms", now)?);
    if let (Some(began), Some(ended)) = (began, ended)
        && ended < began
    {
        return Err("ended_ms: lies before began_ms".to_owned());
    }
    let seen = PromptId(number(json, "seen", "a prompt")?);
    let alternatives = alternatives(json)?;
    Ok(Words { text, alternatives, spoken, began, ended, seen, from: person(json)?, key: None })
}

/// Returns the number of something that the page was shown, 0 if it names none.
fn number(json: &Json, key: &str, what: &str) -> Result<u64, String> {
    match &json[key] {
        Json::Null => Ok(0),
        number => number.as_u64().ok_or_else(|| format!("{key}: expected the number of {what}")),
    }
}

/// Returns the person who speaks; a page without a name speaks for an unnamed user.
fn person(json: &Json) -> Result<PersonId, String> {
    let name = match &json["from"] {
        Json::Null => "",
        name => name.as_str().ok_or("from: expected a name")?,
    };
    PersonId::new(name).map_err(|error| format!("from: {error}"))
}

/// Returns the words of an utterance, on one line.
pub(crate) fn spoken_text(text: &str) -> Result<String, String> {
    let text = plain(text);
    match text.chars().count() {
        0 => Err("text: expected words, found none".to_owned()),
        1..=TEXT_MAX => Ok(text),
        length => Err(format!("text: expected at most {TEXT_MAX} characters, found {length}")),
    }
}

/// Returns a text without the characters that control a display, such as a terminal.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ").trim().to_owned()
}

/// Reads a time of the last two minutes; one slightly ahead becomes `now`.
fn moment(json: &Json, key: &str, now: Time) -> Result<Option<Time>, String> {
    let value = &json[key];
    if value.is_null() {
        return Ok(None);
    }
    let now_ms = crate::hub::ms(now);
    let recent = value.as_f64().filter(|ms| (now_ms - OLDEST_MS..now_ms + 1_000.0).contains(ms));
    let ms = recent.ok_or_else(|| {
        format!(
            "{key}: expected a time of the last two minutes by the server's clock, milliseconds"
        )
    })?;
    Ok(Some(Time((ms * 1e6) as u64).min(now)))
}

fn alternatives(json: &Json) -> Result<Vec<(String, f64)>, String> {
    const WRONG: &str = "alternatives: expected up to 5 of {text, weight above 0 and at most 1e6}";
    let given = match &json["alternatives"] {
        Json::Null => return Ok(Vec::new()),
        Json::Array(given) if given.len() <= ALTERNATIVES_MAX => given,
        _ => return Err(WRONG.to_owned()),
    };
    let one = |json: &Json| {
        let text = spoken_text(json["text"].as_str()?).ok()?;
        let weight = json["weight"].as_f64().filter(|w| *w > 0.0 && *w <= WEIGHT_MAX)?;
        Some((text, weight))
    };
    given.iter().map(one).collect::<Option<_>>().ok_or_else(|| WRONG.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;

    const NOW: Time = Time(1_000_000_000_000);

    fn read(json: Json) -> Result<Message, String> {
        message(&json.to_string(), NOW)
    }

    fn wrong(json: Json) -> String {
        match read(json) {
            Ok(Message::Wrong(3, why)) => why,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn message_hello_is_checked() {
        let session = "0123456789abcdef0123456789ABCDEF";
        let good = json!({"t": "hello", "protocol": 2, "session": session, "name": "Ada",
                          "last_line": 7, "role": "operator"});
        let read = hello(&good.to_string()).unwrap();
        assert_eq!((read.last_line, read.role, read.name.as_str()), (7, Role::Operator, "Ada"));
        for (key, bad) in [
            ("t", json!("do")),
            ("protocol", json!(1)),
            ("session", json!("short")),
            ("role", json!("king")),
        ] {
            let mut json = good.clone();
            json[key] = bad;
            assert!(hello(&json.to_string()).is_err(), "{key}");
        }
    }

    #[test]
    fn message_say_carries_times_and_alternatives() {
        let json = json!({"t": "do", "id": 3, "do": "say", "text": " the red one ",
                          "began_ms": 999_000.5, "ended_ms": 1_000_200.0, "source": "browser",
                          "alternatives": [{"text": "the bed one", "weight": 0.2}],
                          "from": " Ann "});
        let Ok(Message::Do(3, Do::Ask(Verb::Say(words)))) = read(json) else { panic!() };
        assert_eq!((words.text.as_str(), words.from.as_str()), ("the red one", "Ann"));
        assert_eq!(words.began, Some(Time(999_000_500_000)));
        assert_eq!(words.ended, Some(NOW), "slightly ahead becomes now");
        assert!(words.spoken && words.alternatives == [("the bed one".to_owned(), 0.2)]);
    }

    #[test]
    fn message_errors_name_the_key() {
        let say = |key: &str, value: Json| {
            let mut json = json!({"t": "do", "id": 3, "do": "say", "text": "a"});
            json[key] = value;
            wrong(json)
        };
        assert!(say("text", json!("  ")).contains("found none"));
        assert!(say("text", json!("\u{1b}\u{7}")).contains("found none"));
        assert!(say("text", json!("a".repeat(1_001))).contains("1001"));
        assert!(say("began_ms", json!(5)).contains("two minutes"));
        assert!(say("began_ms", json!("x")).contains("began_ms"));
        assert!(say("from", json!("a\nb")).contains("from: expected a printable name"));
        assert!(say("from", json!(3)).contains("from"));
        assert!(say("source", json!("radio")).contains("radio"));
        assert!(say("alternatives", json!([{"text": "b", "weight": 0}])).contains("weight"));
        let resume = |stop: Json| json!({"t": "do", "id": 3, "do": "resume", "stop": stop});
        assert!(wrong(resume(json!("7"))).contains("stop: expected the number of a stop"));
        for (stop, named) in [(json!(null), 0), (json!(7), 7)] {
            assert_eq!(read(resume(stop)), Ok(Message::Do(3, Do::Release(StopId(named)))));
        }
        assert!(wrong(json!({"t": "do", "id": 3, "do": "dance"})).contains("dance"));
        assert!(
            wrong(json!({"t": "do", "id": 3, "do": "give_control", "viewer": 1})).contains("v3")
        );
        for bad in ["", "[]", "{}", "{\"t\":\"do\"}", "{\"t\":\"do\",\"id\":-1}", "\u{0}"] {
            assert!(message(bad, NOW).is_err(), "{bad}");
        }
    }

    /// Any JSON, mostly of the keys and values that mean something.
    fn any_json() -> impl Strategy<Value = Json> {
        let keys = "t|id|do|text|alternatives|weight|began_ms|ended_ms|source|from|viewer|service|at|\
                    session|protocol|role|name|last_line|page";
        let words = "do|say|ping|hello|stop|resume|study[.]begin|give_control|restart_service|browser|\
                     v[0-9]{1,20}|\\PC{0,8}|[\u{0}-\u{1f}\u{7f}-\u{9f}]{1,4}";
        let leaf = prop_oneof![
            Just(Json::Null),
            any::<bool>().prop_map(Json::from),
            any::<u64>().prop_map(Json::from),
            any::<i64>().prop_map(Json::from),
            proptest::num::f64::ANY.prop_map(Json::from),
            (998_000.0..1_002_000.0).prop_map(Json::from),
            words.prop_map(Json::from),
        ];
        leaf.prop_recursive(3, 24, 6, move |inner| {
            let pairs = proptest::collection::btree_map(keys, inner.clone(), 0..8);
            let commands = pairs.clone().prop_map(|mut pairs| {
                pairs.insert("t".to_owned(), "do".into());
                pairs.insert("do".to_owned(), "say".into());
                pairs.insert("id".to_owned(), 3.into());
                Json::from_iter(pairs)
            });
            let list = proptest::collection::vec(inner, 0..6).prop_map(Json::from);
            prop_oneof![pairs.prop_map(Json::from_iter), commands, list]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Every message from a page is refused, or within the limits that later code relies on.
        #[test]
        fn any_message_is_within_limits_or_refused(json in any_json(), text in "\\PC{0,40}") {
            let _ = message(&text, NOW);
            if let Ok(hello) = hello(&json.to_string()) {
                prop_assert!(hello.session.len() == 32 && hello.name.chars().count() <= NAME_MAX);
                prop_assert!(!hello.name.contains(char::is_control));
            }
            let Ok(Message::Do(_, Do::Ask(Verb::Say(words)))) = read(json) else { return Ok(()) };
            let texts = words.alternatives.iter().map(|(text, _)| text).chain([&words.text]);
            for text in texts {
                prop_assert!((1..=TEXT_MAX).contains(&text.chars().count()));
                prop_assert!(!text.contains(char::is_control));
            }
            prop_assert!(words.alternatives.len() <= ALTERNATIVES_MAX);
            let sum: f64 = words.alternatives.iter().map(|(_, weight)| weight).sum();
            prop_assert!(sum.is_finite() && words.alternatives.iter().all(|(_, w)| *w > 0.0));
            let oldest = Time(NOW.ns() - 120_000_000_000);
            for time in words.began.iter().chain(&words.ended) {
                prop_assert!((oldest..=NOW).contains(time));
            }
            prop_assert!(words.began.zip(words.ended).is_none_or(|(began, ended)| began <= ended));
        }

        /// So is any frame of sound.
        #[test]
        fn any_frame_of_sound_is_within_limits_or_refused(
            mut bytes in proptest::collection::vec(any::<u8>(), 0..80),
            is_marked: bool,
        ) {
            if is_marked && bytes.len() >= 4 {
                bytes[..4].copy_from_slice(&[1, 0, 0, 0]);
            }
            if let Ok(frame) = crate::voice::PcmFrame::read(&bytes) {
                prop_assert!(frame.taken <= service::clock::now());
                prop_assert_eq!(2 * frame.samples.len(), bytes.len() - 24);
            }
        }
    }
}
