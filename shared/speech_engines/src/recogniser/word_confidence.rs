//! Hypotheses from scored paths: their weights and the confidence in each of their words.
//!
//! The confidence in a word is the weight of all hypotheses that have it in the same place (after
//! aligning them by least edits): the posterior of a word in a confusion network (Mangu, Brill and
//! Stolcke 2000) with the hypothesis itself as backbone.

use std::collections::BTreeMap;

use super::N_BEST_MAX;
use messages::Hypothesis;

/// Hypotheses that support words. The lighter ones weigh nothing.
const SUPPORTERS_MAX: usize = 50;

/// Returns the [`N_BEST_MAX`] heaviest texts in order of weight, then of appearance. `paths` are
/// texts with the logarithm of their score; a text may appear more than once, and texts without
/// words are ignored. A weight falls by `e` every `scale`.
pub(super) fn hypotheses(paths: &[(String, f64)], scale: f64) -> Vec<Hypothesis> {
    let top = paths.iter().map(|(_, score)| *score).fold(f64::NEG_INFINITY, f64::max);
    let mut place: BTreeMap<&str, usize> = BTreeMap::new();
    let mut texts: Vec<(&str, f64)> = Vec::new();
    for (text, score) in paths.iter().filter(|(text, _)| !text.is_empty()) {
        let weight = ((score - top) / scale).exp();
        let at = *place.entry(text).or_insert(texts.len());
        match texts.get_mut(at) {
            Some((_, sum)) => *sum += weight,
            None => texts.push((text, weight)),
        }
    }
    texts.sort_by(|a, b| b.1.total_cmp(&a.1));
    texts.truncate(SUPPORTERS_MAX);
    let total: f64 = texts.iter().map(|(_, weight)| weight).sum();
    let supporters: Vec<(Vec<&str>, f64)> =
        (texts.iter()).map(|(text, weight)| (text.split(' ').collect(), weight / total)).collect();
    let hypothesis = |(words, weight): &(Vec<&str>, f64)| {
        let confidence = word_confidence(words, &supporters);
        let words = words.iter().zip(confidence).map(|(word, c)| ((*word).to_owned(), c as f32));
        Hypothesis::of_words(words, *weight)
    };
    supporters.iter().take(N_BEST_MAX).map(hypothesis).collect()
}

/// Returns the weight of the supporters that have each of the words in its place.
fn word_confidence(words: &[&str], supporters: &[(Vec<&str>, f64)]) -> Vec<f64> {
    let mut confidence = vec![0.0; words.len()];
    for (supporter, weight) in supporters {
        for place in shared(words, supporter) {
            confidence[place] += weight;
        }
    }
    confidence.into_iter().map(|sum: f64| sum.min(1.0)).collect()
}

/// Returns the places of `a` whose word is kept when `a` is turned into `b` by the fewest edits
/// (Wagner and Fischer 1974).
fn shared(a: &[&str], b: &[&str]) -> Vec<usize> {
    let width = b.len() + 1;
    let mut edits = vec![0_usize; (a.len() + 1) * width];
    for (i, j) in (0..=a.len()).flat_map(|i| (0..width).map(move |j| (i, j))) {
        edits[i * width + j] = match (i, j) {
            (0, j) => j,
            (i, 0) => i,
            (i, j) => {
                let replaced = edits[(i - 1) * width + j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let left_out = edits[(i - 1) * width + j] + 1;
                replaced.min(left_out).min(edits[i * width + j - 1] + 1)
            }
        };
    }
    let (mut i, mut j) = (a.len(), b.len());
    let mut places = Vec::new();
    while i > 0 && j > 0 {
        let here = edits[i * width + j];
        let same = a[i - 1] == b[j - 1];
        if here == edits[(i - 1) * width + j - 1] + usize::from(!same) {
            (i, j) = (i - 1, j - 1);
            places.extend(same.then_some(i));
        } else if here == edits[(i - 1) * width + j] + 1 {
            i -= 1;
        } else {
            j -= 1;
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(scored: &[(&str, f64)]) -> Vec<(String, f64)> {
        scored.iter().map(|(text, score)| ((*text).to_owned(), *score)).collect()
    }

    #[test]
    fn word_confidence_sums_the_weight_of_the_hypotheses_with_the_word() {
        let found = hypotheses(
            &paths(&[
                ("the white one", -10.0),
                ("white one", -10.0),
                ("the white one", -10.0),
                ("the wide one", -10.0),
            ]),
            20.0,
        );
        let expected = [
            ("the white one", 0.5, vec![0.75, 0.75, 1.0]),
            ("white one", 0.25, vec![0.75, 1.0]),
            ("the wide one", 0.25, vec![0.75, 0.25, 1.0]),
        ];
        for (found, (text, weight, confidence)) in found.iter().zip(expected) {
            assert_eq!((found.text.as_str(), found.weight), (text, weight));
            assert_eq!(found.word_confidence, confidence, "{text}");
        }
    }

    #[test]
    fn word_confidence_weights_fall_by_e_every_scale() {
        let found = hypotheses(&paths(&[("no", -30.0), ("yes", -10.0)]), 20.0);
        assert_eq!(found[0].text, "yes");
        assert!((found[0].weight / found[1].weight - 1_f64.exp()).abs() < 1e-5);
    }

    #[test]
    fn word_confidence_ignores_silence_and_limits_the_hypotheses() {
        assert_eq!(hypotheses(&paths(&[("", -1.0)]), 20.0), []);
        assert_eq!(hypotheses(&[], 20.0), []);
        let many: Vec<_> = (0..90).map(|n| (format!("word{n}"), -f64::from(n))).collect();
        let found = hypotheses(&many, 20.0);
        assert_eq!(found.len(), 5);
        assert!(found.iter().map(|h| h.weight).sum::<f64>() < 1.0);
    }

    #[test]
    fn word_alignment_finds_words_in_longer_and_shorter_texts() {
        for (a, b, expected) in [
            ("get me the bowl", "me the big bowl", &[1, 2, 3][..]),
            ("yes", "no", &[]),
            ("the one the one", "the one", &[2, 3]),
        ] {
            let (a, b) = (a.split(' ').collect::<Vec<_>>(), b.split(' ').collect::<Vec<_>>());
            let mut places = shared(&a, &b);
            places.sort_unstable();
            assert_eq!(places, expected, "{a:?} {b:?}");
        }
    }
}
