//! Treatment of a page's frames by the gateway, by the person's right; orders go to the audit.
//!
//! Pure. The console's protocol (docs/console.md) is judged here once more, from the outside: a
//! viewer's page gets nothing through but its hello, as a viewer, and its pings. Passed frames are
//! written anew from their parsed form, so that the robot's console reads the same order.

use roster::Name;
use serde_json::{Value, json};
use web_server::sessions::hash;

use crate::people::Right;

/// Largest order, bytes: it is recorded whole. The longest words with five alternatives fit.
const ORDER_BYTES_MAX: usize = 40 << 10;

/// A frame of a page, judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Passes as the given text.
    Pass(String),
    /// An order, which passes as this text.
    Order(Order, String),
    /// An order that is refused, with the answer to the page.
    Refused(Order, String),
    /// Not for the robot: the answer to the page.
    Answer(String),
}

/// An order of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// Number of the order in its page.
    pub id: u64,
    /// The command.
    pub what: String,
    /// The words that are said, the service that is restarted, or the page that gets control.
    pub text: Option<String>,
    /// Everything else that is passed on, but for times.
    pub with: Option<Value>,
}

impl Order {
    /// Returns whether it stops the robot's motion: nothing may delay it.
    pub fn is_stop(&self) -> bool {
        self.what == "stop"
    }

    /// Returns whether it releases the motion stop: a later stop overrules it.
    pub fn is_resume(&self) -> bool {
        self.what == "resume"
    }
}

/// A message of the console that the audit is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answered {
    /// Outcome of an order, with the reason of a failure.
    Done(u64, Result<(), String>),
    /// Words of the page's microphone that the robot has accepted.
    Heard(String),
    /// The end of a stream of the page's microphone.
    Over(u64),
}

/// Judges a text frame of a page of `person`, whose right to this robot is `right`.
pub fn judge(text: &str, person: &Name, right: Right) -> Verdict {
    let error = |why: &str| Verdict::Answer(error(why));
    let mut frame: Value = match serde_json::from_str(text) {
        Ok(frame) => frame,
        Err(why) => return error(&format!("invalid JSON: {why}")),
    };
    match frame["t"].as_str() {
        Some("ping") => Verdict::Pass(frame.to_string()),
        Some("hello") => {
            introduce(&mut frame, person, right);
            Verdict::Pass(frame.to_string())
        }
        Some("do") => judge_order(frame, person, right)
            .unwrap_or_else(|| error("expected id, a whole number from 0 on, and do, a text")),
        _ => error("t: expected hello, ping or do"),
    }
}

fn judge_order(frame: Value, person: &Name, right: Right) -> Option<Verdict> {
    let text = frame.to_string();
    let order = order(frame)?;
    let why = match right {
        Right::Viewer => viewers_error(person),
        Right::Operator if order.is_stop() => {
            let stop = json!({ "t": "do", "id": order.id, "do": "stop" }).to_string();
            return Some(Verdict::Order(order, stop));
        }
        Right::Operator if text.len() > ORDER_BYTES_MAX => {
            format!("expected an order of at most {ORDER_BYTES_MAX} bytes, found {}", text.len())
        }
        Right::Operator => return Some(Verdict::Order(order, text)),
    };
    let answer = refused(order.id, &why);
    Some(Verdict::Refused(order, answer))
}

/// The answer to a frame that is none.
pub(crate) fn error(why: &str) -> String {
    json!({ "t": "error", "error": why }).to_string()
}

/// The answer to an order that is not passed on.
pub fn refused(id: u64, why: &str) -> String {
    json!({ "t": "done", "id": id, "ok": false, "error": why }).to_string()
}

/// The reason for which a viewer's order is refused.
pub fn viewers_error(person: &Name) -> String {
    format!("{person} may see this robot, not command it; help: ask who administers the gateway")
}

/// Says who the page's person is, whatever the page says.
fn introduce(frame: &mut Value, person: &Name, right: Right) {
    frame["name"] = person.as_str().into();
    if right == Right::Viewer && frame["role"] == "operator" {
        frame["role"] = "viewer".into();
    }
    // A session is one person's: control is not taken over by who has learnt its name.
    if let Some(session) = frame["session"].as_str().filter(|session| session.len() == 32) {
        let own = hash(&format!("{person} {session}"));
        let digits = own.rsplit(':').next().unwrap_or_default();
        frame["session"] = digits.chars().take(32).collect::<String>().into();
    }
}

/// Takes an order apart for the audit.
fn order(frame: Value) -> Option<Order> {
    let Value::Object(mut said) = frame else { return None };
    let what = said.remove("do")?.as_str()?.to_owned();
    // A stop counts without a number as well.
    let id = said.remove("id").and_then(|id| id.as_u64()).or((what == "stop").then_some(0))?;
    let main = match what.as_str() {
        "say" => "text",
        "restart_service" => "service",
        "give_control" => "viewer",
        _ => "",
    };
    let text = match said.remove(main) {
        Some(Value::String(text)) => Some(text),
        other => other.map(|other| other.to_string()),
    };
    // Fields that a page adds by itself are not part of the order.
    for key in ["t", "began_ms", "ended_ms"] {
        said.remove(key);
    }
    said.retain(|key, value| !value.is_null() && (key != "source" || *value != "typed"));
    let with = (!said.is_empty()).then_some(Value::Object(said));
    Some(Order { id, what, text, with })
}

/// Reads the parts of a console's frame that the audit records.
pub fn answered(text: &str) -> Option<Answered> {
    // Most frames are states and joints, which need not be read here.
    let is_one = ["{\"t\":\"done\"", "{\"t\":\"receipt\""].iter().any(|it| text.starts_with(it));
    let frame: Value = is_one.then(|| serde_json::from_str(text).ok())??;
    if frame["t"] == "receipt" {
        return match frame["status"].as_str() {
            Some("accepted") => Some(Answered::Heard(frame["text"].as_str()?.to_owned())),
            Some("over") => Some(Answered::Over(frame["stream"].as_u64()?)),
            _ => None,
        };
    }
    let why = || frame["error"].as_str().unwrap_or_default().to_owned();
    let result = if frame["ok"] == true { Ok(()) } else { Err(why()) };
    Some(Answered::Done(frame["id"].as_u64()?, result))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(frame: Value, right: Right) -> Verdict {
        judge(&frame.to_string(), &Name::new("ann").unwrap(), right)
    }

    fn commands() -> Vec<Value> {
        let verbs = [
            "stop",
            "resume",
            "say",
            "not_that",
            "start_over",
            "take_control",
            "keep_control",
            "give_control",
            "restart_service",
            "study.begin",
            "anything",
        ];
        verbs.map(|verb| json!({ "t": "do", "id": 4, "do": verb, "text": "the bowl" })).to_vec()
    }

    #[test]
    fn viewers_get_nothing_through_but_hello_and_pings() {
        for frame in commands() {
            let Verdict::Refused(order, answer) = judged(frame.clone(), Right::Viewer) else {
                panic!("{frame}")
            };
            assert_eq!(order.what, frame["do"]);
            assert!(answer.contains("\"id\":4,\"ok\":false"), "{answer}");
        }
        let ping = json!({ "t": "ping", "at": 1.5 });
        assert_eq!(judged(ping.clone(), Right::Viewer), Verdict::Pass(ping.to_string()));
        for bad in
            [json!([]), json!({}), json!({ "t": "state" }), json!({ "t": "do", "do": "say" })]
        {
            for right in [Right::Viewer, Right::Operator] {
                assert!(matches!(judged(bad.clone(), right), Verdict::Answer(_)), "{bad}");
            }
        }
    }

    #[test]
    fn operators_orders_pass_as_they_were_read() {
        for frame in commands() {
            let Verdict::Order(order, text) = judged(frame.clone(), Right::Operator) else {
                panic!("{frame}")
            };
            let stop = json!({ "t": "do", "id": 4, "do": "stop" });
            let expected = if order.is_stop() { stop } else { frame };
            assert_eq!((text, order.id), (expected.to_string(), 4));
        }
        let unnumbered = judged(json!({ "t": "do", "do": "stop" }), Right::Operator);
        assert!(matches!(unnumbered, Verdict::Order(order, _) if order.is_stop()));
        // Of duplicate keys only the one that counts here is passed on.
        let twice = r#"{"t":"ping","at":1,"t":"do","id":1,"do":"say","do":"stop"}"#;
        let verdict = judge(twice, &Name::new("ann").unwrap(), Right::Operator);
        let Verdict::Order(order, text) = verdict else { panic!("{verdict:?}") };
        assert!(order.is_stop());
        assert_eq!(text.matches("\"do\"").count(), 2, "{text}");
        assert!(!text.contains("say"), "{text}");
    }

    #[test]
    fn audit_has_all_of_an_order_that_is_passed_on() {
        for (order, text, with) in [
            (
                json!({ "do": "say", "text": "the bowl", "source": "typed" }),
                Some("the bowl"),
                json!(null),
            ),
            (
                json!({ "do": "say", "text": "hello there", "began_ms": 1, "source": "browser",
                        "alternatives": [{ "text": "get me the metal bowl", "weight": 1e6 }] }),
                Some("hello there"),
                json!({ "source": "browser",
                        "alternatives": [{ "text": "get me the metal bowl", "weight": 1e6 }] }),
            ),
            (
                json!({ "do": "restart_service", "text": "policy", "service": "recorder" }),
                Some("recorder"),
                json!({ "text": "policy" }),
            ),
            (json!({ "do": "say", "text": ["the bowl"] }), Some("[\"the bowl\"]"), json!(null)),
            (json!({ "do": "give_control", "viewer": "v3" }), Some("v3"), json!(null)),
            (json!({ "do": "study.begin", "id": 3, "plan": 1 }), None, json!({ "plan": 1 })),
            (
                json!({ "do": "say", "text": "yes", "from": "Ann" }),
                Some("yes"),
                json!({ "from": "Ann" }),
            ),
        ] {
            let mut frame = order.clone();
            (frame["t"], frame["id"]) = (json!("do"), json!(7));
            let Verdict::Order(put_down, passed) = judged(frame, Right::Operator) else { panic!() };
            assert_eq!((put_down.text.as_deref(), put_down.with.unwrap_or_default()), (text, with));
            let passed: Value = serde_json::from_str(&passed).unwrap();
            assert_eq!(passed["do"], order["do"]);
        }
        let long = json!({ "t": "do", "id": 1, "do": "say", "text": "a".repeat(50_000) });
        assert!(matches!(judged(long, Right::Operator), Verdict::Refused(..)));
    }

    #[test]
    fn pages_say_who_their_person_is() {
        let session = "0123456789abcdef0123456789abcdef";
        let hello = |right| {
            let frame = json!({ "t": "hello", "protocol": 2, "session": session, "name": "root",
                                "role": "operator" });
            let Verdict::Pass(text) = judged(frame, right) else { panic!() };
            serde_json::from_str::<Value>(&text).unwrap()
        };
        let (viewer, operator) = (hello(Right::Viewer), hello(Right::Operator));
        assert_eq!((&viewer["role"], &viewer["name"]), (&json!("viewer"), &json!("ann")));
        assert_eq!(operator["role"], "operator");
        let own = operator["session"].as_str().unwrap();
        assert!(own != session && own.len() == 32 && own.bytes().all(|b| b.is_ascii_hexdigit()));
        assert_eq!(viewer["session"], operator["session"], "it stays through reloads");
    }

    #[test]
    fn outcomes_and_heard_words_are_read() {
        let read = |frame: Value| answered(&frame.to_string());
        let done = json!({ "t": "done", "id": 9, "ok": true, "stopped": true });
        assert_eq!(read(done), Some(Answered::Done(9, Ok(()))));
        let failed = json!({ "t": "done", "id": 9, "ok": false, "error": "no" });
        assert_eq!(read(failed), Some(Answered::Done(9, Err("no".into()))));
        let heard = json!({ "t": "receipt", "stream": 7, "status": "accepted", "text": "yes" });
        assert_eq!(read(heard), Some(Answered::Heard("yes".into())));
        let over = json!({ "t": "receipt", "stream": 7, "status": "over", "text": "" });
        assert_eq!(read(over), Some(Answered::Over(7)));
        let other = json!({ "t": "receipt", "stream": 7, "status": "refused", "text": "yes" });
        assert_eq!(read(other), None);
        assert_eq!(read(json!({ "t": "state", "parts": {} })), None);
    }
}
