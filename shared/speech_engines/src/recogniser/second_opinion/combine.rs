//! Two recognisers' views of an utterance as one list of hypotheses.
//!
//! The weight of a hypothesis is its weight with the first recogniser times a power of its
//! likelihood with the second: a log-linear combination. Texts that both find likely are certain; a
//! text that only one finds likely shares the weight with the other's favourite: doubt that the
//! belief accounts for.

use super::Opinion;
use crate::recogniser::word_confidence::hypotheses;
use messages::Hypothesis;

/// Exponent of the second recogniser's likelihood. Its words are not independent, and neither are
/// its errors of those of the first one.
const EXPONENT: f64 = 0.5;
/// Weight, with the first recogniser, of words that only the second one heard.
const UNHEARD: f64 = 0.01;
/// Largest share of words that only the second recogniser heard.
const ALONE_MAX: f64 = 0.5;

/// Returns the hypotheses of both, heaviest first. The second recogniser never acts alone: without
/// any of the first one there is none, and words of its own are at least as doubtful as a coin.
pub(super) fn combined(first: &[Hypothesis], opinion: &Opinion) -> Vec<Hypothesis> {
    let total: f64 = first.iter().map(|hypothesis| hypothesis.weight).sum();
    let mut texts: Vec<(String, f64)> = (first.iter().zip(&opinion.ln_likelihood))
        .map(|(h, ln)| (h.text.clone(), (h.weight / total).ln() + EXPONENT * ln))
        .collect();
    let is_new = texts.iter().all(|(text, _)| *text != opinion.text);
    if !texts.is_empty() && is_new && !opinion.text.is_empty() {
        let others = ln_sum(&texts);
        let alone = UNHEARD.ln() + EXPONENT * opinion.ln_own;
        let most = others + (ALONE_MAX / (1.0 - ALONE_MAX)).ln();
        texts.push((opinion.text.clone(), alone.min(most)));
    }
    hypotheses(&texts, 1.0)
}

/// Returns the logarithm of the sum of the weights, which are given by their logarithms.
fn ln_sum(texts: &[(String, f64)]) -> f64 {
    let top = texts.iter().map(|(_, ln)| *ln).fold(f64::NEG_INFINITY, f64::max);
    top + texts.iter().map(|(_, ln)| (ln - top).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first() -> Vec<Hypothesis> {
        let of = |text: &str, weight| Hypothesis { weight, ..Hypothesis::certain(text) };
        vec![of("the right one", 0.6), of("the white one", 0.4)]
    }

    fn opinion(text: &str, ln_likelihood: [f64; 2], ln_own: f64) -> Opinion {
        Opinion { text: text.into(), ln_own, ln_likelihood: ln_likelihood.into(), no_speech: 0.0 }
    }

    fn weights(opinion: &Opinion) -> Vec<(String, f64)> {
        combined(&first(), opinion).into_iter().map(|h| (h.text, h.weight)).collect()
    }

    #[test]
    fn agreement_is_confidence_and_disagreement_doubt() {
        let agreed = weights(&opinion("the right one", [-1.0, -9.0], -1.0));
        assert!(agreed[0].0 == "the right one" && agreed[0].1 > 0.98, "{agreed:?}");
        let other = weights(&opinion("the white one", [-3.0, -2.0], -2.0));
        assert!(other[0].0 == "the white one" && other[0].1 < 0.6, "{other:?}");
        let total: f64 = other.iter().map(|(_, weight)| weight).sum();
        assert!((total - 1.0).abs() < 1e-9);
    }

    #[test]
    fn words_of_the_second_one_alone_need_to_be_far_likelier_and_stay_doubtful() {
        let alone = weights(&opinion("the kite", [-8.0, -9.0], -4.0));
        assert_eq!(alone.iter().map(|(text, _)| text.as_str()).max(), Some("the white one"));
        assert!(alone.iter().any(|(text, weight)| text == "the kite" && *weight < 0.1));
        let sure = weights(&opinion("the kite", [-40.0, -40.0], -1.0));
        let kite = sure.iter().find(|(text, _)| text == "the kite").unwrap();
        assert!((kite.1 - ALONE_MAX).abs() < 1e-9, "{sure:?}");
        assert!(combined(&[], &opinion("the kite", [0.0, 0.0], -1.0)).is_empty());
    }
}
