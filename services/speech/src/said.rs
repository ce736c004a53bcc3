//! What one utterance consists of, and whether it can be taken.

use messages::{POINTED_AT_MAX_M, Source, is_somewhere};

use crate::{Config, Hypothesis};

/// Words, a pointing gesture, or both.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Content {
    /// What was heard, most likely first; nothing for a gesture without words.
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub(crate) gesture: Option<[f64; 3]>,
    /// Where it came from.
    pub(crate) source: Source,
}

impl Content {
    /// Words alone.
    pub(crate) fn words(hypotheses: Vec<Hypothesis>, source: Source) -> Self {
        Self { hypotheses, gesture: None, source }
    }

    /// A gesture, with words unless they are blank.
    pub(crate) fn pointing(target_m: [f64; 3], words: String) -> Self {
        let said = !words.trim().is_empty();
        let hypotheses = if said { vec![Hypothesis::certain(words)] } else { Vec::new() };
        Self { hypotheses, gesture: Some(target_m), source: Source::Gesture }
    }

    /// Why it cannot be taken, if it cannot.
    pub(crate) fn fault(&self, config: &Config) -> Option<String> {
        let best = self.hypotheses.first().map_or("", |best| best.text.as_str());
        let (bytes, max) = (best.len(), config.utterance_bytes_max);
        match &self.gesture {
            None if best.trim().is_empty() => Some("nothing was said".to_owned()),
            Some(_) if !config.gestures => Some(GESTURES_ARE_OFF.to_owned()),
            Some(target_m) if !is_somewhere(target_m) => Some(format!(
                "nobody points at {target_m:?}: use metres in frame base, each from \
                 -{POINTED_AT_MAX_M} to {POINTED_AT_MAX_M}"
            )),
            _ if bytes > max => Some(format!(
                "the utterance has {bytes} bytes, {max} at most are heard \
                 (speech.utterance_bytes_max)"
            )),
            _ => None,
        }
    }
}

const GESTURES_ARE_OFF: &str = "pointing gestures are not taken here; set \
    dialogue.gesture.enabled = true (file dialogue.toml, table [gesture]) and run: whichone reload";

/// What was said and shown, for people.
pub(crate) fn in_words(text: &str, gesture: Option<[f64; 3]>) -> String {
    let Some([x, y, z]) = gesture else { return text.to_owned() };
    let space = if text.is_empty() { "" } else { " " };
    format!("{text}{space}[points at {x:.3} {y:.3} {z:.3} m]")
}
