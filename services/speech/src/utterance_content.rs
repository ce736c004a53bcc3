//! Content of one utterance, and its validation.

use messages::{HYPOTHESES_MAX, POINTED_AT_MAX_M, is_somewhere};

use crate::{Config, Hypothesis};

/// Largest weight of a hypothesis.
const WEIGHT_MAX: f64 = 1e9;

/// Words, a pointing gesture, or both.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct UtteranceContent {
    /// Hypotheses, most likely first; empty for a gesture without words.
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub(crate) gesture: Option<[f64; 3]>,
}

impl UtteranceContent {
    /// Returns words without a gesture.
    pub(crate) fn words(hypotheses: Vec<Hypothesis>) -> Self {
        Self { hypotheses, gesture: None }
    }

    /// Returns a gesture, with words unless they are blank.
    pub(crate) fn pointing(target_m: [f64; 3], words: String) -> Self {
        let is_blank = words.trim().is_empty();
        let hypotheses = if is_blank { Vec::new() } else { vec![Hypothesis::certain(words)] };
        Self { hypotheses, gesture: Some(target_m) }
    }

    /// Returns the hypotheses of a client's own recogniser, most likely first; only the best if
    /// there are too many.
    ///
    /// # Errors
    /// Invalid weights or confidences, for the client.
    pub(crate) fn transcript(mut hypotheses: Vec<Hypothesis>) -> Result<Self, String> {
        for Hypothesis { text, weight, word_confidence } in &hypotheses {
            let words = text.split_whitespace().count();
            // Their sum must be a number, too: the weights become shares.
            if !(*weight > 0.0 && *weight <= WEIGHT_MAX) {
                return Err(format!(
                    "transcript: expected a weight above 0, at most {WEIGHT_MAX}, found {weight}"
                ));
            }
            if let Some(wrong) = word_confidence.iter().find(|c| !(0.0..=1.0).contains(*c)) {
                return Err(format!(
                    "transcript: expected a confidence from 0 to 1, found {wrong}"
                ));
            }
            if word_confidence.len() > words {
                let found = word_confidence.len();
                return Err(format!(
                    "transcript: expected at most {words} confidences, one per word, found {found}"
                ));
            }
        }
        hypotheses.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        hypotheses.truncate(HYPOTHESES_MAX);
        Ok(Self::words(hypotheses))
    }

    /// Returns whether the words are an order to stop.
    pub(crate) fn is_stop(&self) -> bool {
        self.hypotheses.first().is_some_and(|best| language::is_stop(&best.text))
    }

    /// Returns the content if the configuration admits it.
    ///
    /// # Errors
    /// Why it is rejected, for users.
    pub(crate) fn checked(self, config: &Config) -> Result<Self, String> {
        let best = self.hypotheses.first().map_or("", |best| best.text.as_str());
        let (bytes, max) = (best.len(), config.utterance_bytes_max);
        Err(match &self.gesture {
            None if best.trim().is_empty() => "empty utterance".to_owned(),
            Some(_) if !config.gestures => GESTURES_ARE_OFF.to_owned(),
            Some(target_m) if !is_somewhere(target_m) => format!(
                "expected a point within ±{POINTED_AT_MAX_M} m in frame base, found {target_m:?}"
            ),
            _ if bytes > max => {
                format!("expected at most {max} bytes (speech.utterance_bytes_max), found {bytes}")
            }
            _ => return Ok(self),
        })
    }
}

const GESTURES_ARE_OFF: &str = "pointing gestures are disabled; help: set \
    dialogue.gesture.enabled = true (file dialogue.toml, table [gesture]) and run: whichone reload";

/// Returns words and gesture as text for users.
pub(crate) fn as_text(words: &str, gesture: Option<[f64; 3]>) -> String {
    let Some([x, y, z]) = gesture else { return words.to_owned() };
    let space = if words.is_empty() { "" } else { " " };
    format!("{words}{space}[points at {x:.3} {y:.3} {z:.3} m]")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transcript(weight: f64, confidence: &[f32]) -> Result<Vec<Hypothesis>, String> {
        let word_confidence = confidence.to_vec();
        let one = vec![Hypothesis { text: "the red one".to_owned(), weight, word_confidence }];
        UtteranceContent::transcript(one).map(|content| content.hypotheses)
    }

    #[test]
    fn transcript_keeps_the_best_hypotheses_first() {
        let many = (1..=9)
            .map(|n| Hypothesis { weight: f64::from(n), ..Hypothesis::certain(n.to_string()) })
            .collect();
        let hypotheses = UtteranceContent::transcript(many).unwrap().hypotheses;
        assert_eq!((hypotheses.len(), hypotheses[0].text.as_str()), (HYPOTHESES_MAX, "9"));
        assert_eq!(transcript(2.0, &[0.5, 1.0]).unwrap()[0].word_confidence, [0.5, 1.0]);
    }

    #[test]
    fn transcript_rejects_invalid_weights_and_confidences() {
        for (weight, confidence, expected) in [
            (0.0, &[][..], "weight above 0, at most 1000000000, found 0"),
            (f64::MAX, &[], "found 1797"),
            (f64::NAN, &[], "NaN"),
            (1.0, &[1.5], "found 1.5"),
            (1.0, &[f32::NAN], "NaN"),
            (1.0, &[1.0; 4], "at most 3 confidences, one per word, found 4"),
        ] {
            let error = transcript(weight, confidence).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
