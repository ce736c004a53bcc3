//! Questions of a questionnaire and their answers.

use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

/// Most characters of an answer in the participant's own words.
const TEXT_MAX: usize = 2000;

/// A question of the questionnaire.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Item {
    /// Name in the data: letters, digits and `_`.
    pub id: String,
    /// Text of the item.
    pub text: String,
    /// Kind of answers to the item.
    pub kind: Kind,
    /// Options of a [`Kind::Choice`]; empty for others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
    /// Label of the least value of a [`Kind::Likert`].
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub low: String,
    /// Label of the greatest value.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub high: String,
    /// Number of values.
    #[serde(default)]
    pub points: u8,
    /// An answer is required.
    pub required: bool,
}

/// The kinds of answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A whole number from 1 to `points`.
    Likert,
    /// One of `options`.
    Choice,
    /// A number.
    Number,
    /// Own words.
    Text,
}

impl Item {
    /// Returns the answer as it is stored: `None` without an answer.
    ///
    /// # Errors
    /// A sentence for the participant with the item's requirements.
    pub fn check(&self, answer: &Json) -> Result<Option<Json>, String> {
        let empty = match answer {
            Json::Null => true,
            Json::String(text) => text.trim().is_empty(),
            _ => false,
        };
        if empty {
            return if self.required { Err(self.refusal("needs an answer")) } else { Ok(None) };
        }
        match (self.kind, answer) {
            (Kind::Likert, Json::Number(number)) => match number.as_u64() {
                Some(n) if (1..=u64::from(self.points)).contains(&n) => Ok(Some(n.into())),
                _ => Err(self.refusal(&format!("takes a whole number from 1 to {}", self.points))),
            },
            (Kind::Choice, Json::String(choice)) if self.options.contains(choice) => {
                Ok(Some(choice.as_str().into()))
            }
            (Kind::Choice, _) => {
                Err(self.refusal(&format!("takes one of {}", self.options.join(", "))))
            }
            (Kind::Number, Json::Number(number)) => Ok(Some(Json::Number(number.clone()))),
            (Kind::Text, Json::String(text)) if text.chars().count() <= TEXT_MAX => {
                Ok(Some(text.trim().into()))
            }
            (Kind::Text, _) => {
                Err(self.refusal(&format!("takes a text of at most {TEXT_MAX} characters")))
            }
            (Kind::Likert | Kind::Number, _) => Err(self.refusal("takes a number")),
        }
    }

    fn refusal(&self, what: &str) -> String {
        format!("“{}” {what}.", self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn item(kind: Kind, required: bool) -> Item {
        Item {
            id: "q".to_owned(),
            text: "How was it?".to_owned(),
            kind,
            options: vec!["good".to_owned(), "bad".to_owned()],
            low: String::new(),
            high: String::new(),
            points: 7,
            required,
        }
    }

    #[test]
    fn study_item_accepts_only_answers_of_its_kind() {
        let cases = [
            (Kind::Likert, json!(7), json!(8)),
            (Kind::Likert, json!(1), json!(1.5)),
            (Kind::Likert, json!(2), json!("2")),
            (Kind::Choice, json!("bad"), json!("worse")),
            (Kind::Number, json!(-2.5), json!("many")),
            (Kind::Text, json!("fine"), json!(3)),
            (Kind::Text, json!("x".repeat(2000)), json!("x".repeat(2001))),
        ];
        for (kind, good, bad) in cases {
            assert_eq!(item(kind, true).check(&good), Ok(Some(good)), "{kind:?}");
            let refusal = item(kind, true).check(&bad).unwrap_err();
            assert!(refusal.contains("How was it?"), "{refusal}");
        }
    }

    #[test]
    fn study_item_may_be_left_open_if_optional() {
        for nothing in [Json::Null, json!("  ")] {
            for kind in [Kind::Likert, Kind::Choice, Kind::Number, Kind::Text] {
                assert_eq!(item(kind, false).check(&nothing), Ok(None));
                assert!(item(kind, true).check(&nothing).is_err());
            }
        }
    }
}
