//! Speech that a client's own recogniser has recognised.

use messages::HYPOTHESES_MAX;

use crate::Hypothesis;

/// The hypotheses of a transcript, most likely first; of more than are handed on the best.
///
/// # Errors
/// Weights or confidences that make no sense, in words for whoever sent them.
pub(crate) fn hypotheses(
    transcript: Vec<(String, f64, Vec<f32>)>,
) -> Result<Vec<Hypothesis>, String> {
    let mut hypotheses = Vec::new();
    for (text, weight, confidence) in transcript {
        let words = text.split_whitespace().count();
        if !(weight.is_finite() && weight > 0.0) {
            return Err(format!("a transcript has weight {weight}: use numbers above 0"));
        }
        if let Some(wrong) = confidence.iter().find(|sure| !(0.0..=1.0).contains(*sure)) {
            return Err(format!("a word has confidence {wrong}: use numbers from 0 to 1"));
        }
        if confidence.len() > words {
            let told = confidence.len();
            return Err(format!(
                "a transcript of {words} words has {told} confidences: one each at most"
            ));
        }
        hypotheses.push(Hypothesis { text, weight, confidence });
    }
    hypotheses.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    hypotheses.truncate(HYPOTHESES_MAX);
    Ok(hypotheses)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(weight: f64, confidence: &[f32]) -> Vec<(String, f64, Vec<f32>)> {
        vec![("the red one".to_owned(), weight, confidence.to_vec())]
    }

    #[test]
    fn the_best_come_first() {
        let many = (1..=9).map(|n| (n.to_string(), f64::from(n), Vec::new())).collect();
        let hypotheses = hypotheses(many).unwrap();
        assert_eq!((hypotheses.len(), hypotheses[0].text.as_str()), (HYPOTHESES_MAX, "9"));
        assert_eq!(super::hypotheses(one(2.0, &[0.5, 1.0])).unwrap()[0].confidence, [0.5, 1.0]);
    }

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        for (weight, confidence, word) in [
            (0.0, &[][..], "weight 0"),
            (f64::NAN, &[], "NaN"),
            (1.0, &[1.5], "confidence 1.5"),
            (1.0, &[f32::NAN], "NaN"),
            (1.0, &[1.0; 4], "3 words has 4"),
        ] {
            let error = hypotheses(one(weight, confidence)).unwrap_err();
            assert!(error.contains(word), "{error}");
        }
    }
}
