//! What the gateway does with the frames of a page: the person's right decides, and orders are put down for the audit.
//!
//! Pure. The console's protocol (docs/console.md) is judged here once more, from the outside: a viewer's page gets nothing
//! through but its hello, as a viewer, and its pings. What passes is written from what was read, so that the robot's
//! console cannot read another order in it.

use roster::Name;
use serde_json::{Value, json};
use web_server::sessions::hash;

use crate::people::Right;

/// Longest text in the audit, characters: as long as an utterance may be.
const TEXT_MAX: usize = 1_000;

/// A frame of a page, judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Passes as this text.
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
    /// Its number in its page.
    pub id: u64,
    /// The command.
    pub what: String,
    /// The words that are said, or the service that is restarted.
    pub text: Option<String>,
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
}

/// Judges a text frame of a page of `person`, whose right to this robot is `right`.
pub fn judge(text: &str, person: &Name, right: Right) -> Verdict {
    let error = |error: &str| Verdict::Answer(json!({ "t": "error", "error": error }).to_string());
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
        Some("do") => match order(&frame) {
            Some(order) if right == Right::Operator => Verdict::Order(order, frame.to_string()),
            Some(order) => {
                let why = refused(order.id, &viewers_error(person));
                Verdict::Refused(order, why)
            }
            None => error("expected id, a whole number from 0 on, and do, a text"),
        },
        _ => error("t: expected hello, ping or do"),
    }
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

fn order(frame: &Value) -> Option<Order> {
    let (id, what) = (frame["id"].as_u64()?, frame["do"].as_str()?);
    let text = ["text", "service", "viewer"].iter().find_map(|key| frame[*key].as_str());
    let short = |text: &str| text.chars().take(TEXT_MAX).collect();
    Some(Order { id, what: what.chars().take(40).collect(), text: text.map(short) })
}

/// Reads what the audit wants to know of a console's frame.
pub fn answered(text: &str) -> Option<Answered> {
    // Most frames are states and joints, which nobody needs to read here.
    let is_one = ["{\"t\":\"done\"", "{\"t\":\"receipt\""].iter().any(|it| text.starts_with(it));
    let frame: Value = is_one.then(|| serde_json::from_str(text).ok())??;
    if frame["t"] == "receipt" {
        let heard = frame["text"].as_str().filter(|_| frame["status"] == "accepted");
        return heard.map(|text| Answered::Heard(text.to_owned()));
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
            [json!([]), json!({}), json!({ "t": "state" }), json!({ "t": "do", "do": "stop" })]
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
            assert_eq!(text, frame.to_string());
            assert_eq!((order.id, order.text.as_deref()), (4, Some("the bowl")));
        }
        // Of a key that comes twice, what counts here counts there.
        let twice = r#"{"t":"ping","at":1,"t":"do","id":1,"do":"say","do":"stop"}"#;
        let verdict = judge(twice, &Name::new("ann").unwrap(), Right::Operator);
        let Verdict::Order(order, text) = verdict else { panic!("{verdict:?}") };
        assert!(order.is_stop());
        assert_eq!(text.matches("\"do\"").count(), 2, "{text}");
        assert!(!text.contains("say"), "{text}");
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
        let other = json!({ "t": "receipt", "stream": 7, "status": "over", "text": "yes" });
        assert_eq!(read(other), None);
        assert_eq!(read(json!({ "t": "state", "parts": {} })), None);
    }
}
