//! Journal records for programs: the output of `whichone journal --json`.
//!
//! Each service translates its own records into these types, with the scene's names for numbers. A
//! number's key ends with its unit (`_ns`, `_ms`, `_s`, `_m`, `_rad`, `_db`); without one it is an
//! index, a count, a probability or a weight. Times in `_ns` are of the machine's monotonic clock.
//! `docs/journals.md` has the table, `tests/golden/journal_*.jsonl` an example of each type.

mod arm;
pub mod golden;
mod named;
mod policy;
mod speech;

use serde::{Deserialize, Serialize};

pub use arm::{ArmCause, ArmRecord, HeldRecord, PickRecord, PostureRecord};
pub use named::Named;
pub use policy::{
    AlternativeRecord, DecisionRecord, EndedRecord, InterpretationRecord, PickKey, PolicyCause,
    PolicyRecord, PresentationKey, UserRecord,
};
pub use speech::{AcceptedRecord, PresentationRecord, SpeechRecord};

/// A line of `whichone journal --json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JournalLine {
    /// Number of the record in the journal.
    pub seq: u64,
    /// When it was written, nanoseconds of the machine's monotonic clock.
    pub at_ns: u64,
    /// Milliseconds since 1970 by the wall clock; `None` if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unix_ms: Option<u64>,
    /// The record as a sentence.
    pub text: String,
    /// The record.
    pub record: JournalRecord,
}

/// A record of one of the journals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "service", rename_all = "snake_case")]
pub enum JournalRecord {
    /// Record of the speech service.
    Speech(Box<SpeechRecord>),
    /// Record of the policy.
    Policy(Box<PolicyRecord>),
    /// Record of the arm.
    Arm(Box<ArmRecord>),
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    const GOLDEN: [&str; 3] = [
        include_str!("../../../tests/golden/journal_speech.jsonl"),
        include_str!("../../../tests/golden/journal_policy.jsonl"),
        include_str!("../../../tests/golden/journal_arm.jsonl"),
    ];
    const UNITS: [&str; 7] = ["_ns", "_ms", "_s", "_m", "_rad", "_db", "_xyzw"];
    /// Numbers of things, counts, probabilities and weights.
    const WITHOUT_UNIT: [&str; 28] = [
        "seq",
        "utterance",
        "prompt",
        "presentation",
        "interaction",
        "attempt",
        "act",
        "applied",
        "numbers_over",
        "version",
        "segment",
        "segments",
        "questions",
        "misses",
        "expected_questions",
        "confidence",
        "word_confidence",
        "weight",
        "share",
        "none",
        "absent",
        "belief",
        "p_l",
        "epsilon",
        "object",
        "text",
        "key",
        "name",
    ];

    /// Keys of numbers without a unit. Those below `belief` are names of objects.
    fn unitless(key: &str, value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Number(_) => {
                let has_unit = UNITS.iter().any(|unit| key.ends_with(unit));
                if !has_unit && !WITHOUT_UNIT.contains(&key) {
                    found.push(key.to_owned());
                }
            }
            Value::Array(all) => all.iter().for_each(|value| unitless(key, value, found)),
            Value::Object(all) => {
                for (name, value) in all {
                    let key = if key == "belief" { key } else { name };
                    unitless(key, value, found);
                }
            }
            _ => {}
        }
    }

    #[test]
    fn every_record_is_read_back_and_every_number_has_its_unit() {
        let lines: Vec<&str> = GOLDEN.iter().flat_map(|golden| golden.lines()).collect();
        assert!(lines.len() > 20, "{}", lines.len());
        for text in lines {
            let line: JournalLine = serde_json::from_str(text).unwrap();
            let mut value: Value = serde_json::from_str(text).unwrap();
            assert_eq!(value.as_object_mut().unwrap().remove("schema"), Some(1.into()));
            assert_eq!(serde_json::to_value(&line).unwrap(), value);
            let mut found = Vec::new();
            unitless("", &value, &mut found);
            assert!(found.is_empty(), "{found:?} in {text}");
        }
    }
}
