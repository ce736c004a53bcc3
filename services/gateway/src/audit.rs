//! The audit: record of orders by person and robot.

use std::time::{SystemTime, UNIX_EPOCH};

use roster::Name;
use serde::Serialize;
use serde_json::Value;

/// Name of the audit in the gateway's folder, without ending.
pub const NAME: &str = "audit";

/// Outcome of the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Given: it is passed on to the robot.
    Ordered,
    /// The robot has confirmed the order.
    Done,
    /// The robot's console has answered with an error.
    Failed,
    /// The gateway has refused the order.
    Refused,
}

/// One entry.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// Wall time, milliseconds since 1970.
    pub unix_ms: u64,
    /// Who.
    pub person: Name,
    /// The ordered robot; `None` for the gateway itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<Name>,
    /// The order: a page's command (`stop`, `say` …), `sound`, `speech`, `open`, `close`, `login`.
    pub what: String,
    /// Outcome of the order.
    pub outcome: Outcome,
    /// The words that were said, or the reason of a failure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// Everything else in the order that is passed on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub with: Option<Value>,
    /// Number of the connection, and of the order in it: an order and its outcome have the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<(u64, u64)>,
}

impl Entry {
    /// An entry of now.
    pub fn new(person: &Name, robot: Option<&Name>, what: &str, outcome: Outcome) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self {
            unix_ms: u64::try_from(now.as_millis()).unwrap_or(u64::MAX),
            person: person.clone(),
            robot: robot.cloned(),
            what: what.to_owned(),
            outcome,
            text: None,
            with: None,
            order: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_lines_with_their_order() {
        let name = |text: &str| Name::new(text).unwrap();
        let mut entry = Entry::new(&name("ann"), Some(&name("r1")), "say", Outcome::Ordered);
        (entry.unix_ms, entry.text, entry.order) = (7, Some("the\nbowl".into()), Some((3, 1)));
        assert_eq!(
            serde_json::to_string(&entry).unwrap(),
            r#"{"unix_ms":7,"person":"ann","robot":"r1","what":"say","outcome":"ordered","text":"the\nbowl","order":[3,1]}"#
        );
    }
}
