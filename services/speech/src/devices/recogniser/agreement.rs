//! Hypotheses from scored paths: what they weigh, and how sure each of their words is.
//!
//! A word of a hypothesis is as sure as the weight of all hypotheses that have it in the same place
//! (after aligning them by least edits): the posterior of a word in a confusion network (Mangu,
//! Brill and Stolcke 2000) with the hypothesis itself as its backbone.

use std::collections::BTreeMap;

use super::Hypothesis;

/// Hypotheses that vouch for words. The lighter ones weigh nothing.
const WITNESSES_MAX: usize = 50;

/// The `at_most` weightiest of the texts, heaviest first, the earlier before the later of equal
/// ones. `paths` are texts with the logarithm of their score; a text may appear more than once, and
/// texts without words count for nothing. A score falls by `e` every `scale`.
pub(super) fn hypotheses(paths: &[(String, f64)], scale: f64, at_most: usize) -> Vec<Hypothesis> {
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
    texts.truncate(WITNESSES_MAX.max(at_most));
    let total: f64 = texts.iter().map(|(_, weight)| weight).sum();
    let witnesses: Vec<(Vec<&str>, f64)> =
        (texts.iter()).map(|(text, weight)| (text.split(' ').collect(), weight / total)).collect();
    let told = |(words, weight): &(Vec<&str>, f64)| {
        let sure = agreement(words, &witnesses);
        let words = words.iter().zip(sure).map(|(word, sure)| ((*word).to_owned(), sure as f32));
        let words: Vec<(String, f32)> = words.collect();
        let text = words.iter().map(|(word, _)| word.as_str()).collect::<Vec<_>>().join(" ");
        Hypothesis { text, confidence: *weight as f32, words }
    };
    witnesses.iter().take(at_most).map(told).collect()
}

/// The weight of the witnesses that have each of the words in its place.
fn agreement(words: &[&str], witnesses: &[(Vec<&str>, f64)]) -> Vec<f64> {
    let mut sure = vec![0.0; words.len()];
    for (witness, weight) in witnesses {
        for place in shared(words, witness) {
            sure[place] += weight;
        }
    }
    sure.into_iter().map(|sure: f64| sure.min(1.0)).collect()
}

/// The places of `a` whose word stands also in `b` when `a` is turned into `b` by the fewest edits
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
    fn a_texts_paths_weigh_together_and_a_word_is_as_sure_as_those_that_have_it() {
        let paths = paths(&[
            ("the white one", -10.0),
            ("white one", -10.0),
            ("the white one", -10.0),
            ("the wide one", -10.0),
        ]);
        let found = hypotheses(&paths, 20.0, 5);
        assert_eq!(found.len(), 3);
        assert_eq!((found[0].text.as_str(), found[0].confidence), ("the white one", 0.5));
        assert_eq!(
            found[0].words,
            [("the", 0.75), ("white", 0.75), ("one", 1.0)].map(|(w, p)| (w.to_owned(), p))
        );
        assert_eq!(found[1].words, [("white", 0.75), ("one", 1.0)].map(|(w, p)| (w.to_owned(), p)));
        assert_eq!(found[2].words[1], ("wide".to_owned(), 0.25));
    }

    #[test]
    fn weight_falls_by_e_every_scale() {
        let found = hypotheses(&paths(&[("no", -30.0), ("yes", -10.0)]), 20.0, 5);
        assert_eq!(found[0].text, "yes");
        assert!((found[0].confidence / found[1].confidence - 1_f32.exp()).abs() < 1e-5);
    }

    #[test]
    fn silence_is_nothing_and_no_more_come_than_asked_for() {
        assert_eq!(hypotheses(&paths(&[("", -1.0)]), 20.0, 5), []);
        assert_eq!(hypotheses(&[], 20.0, 5), []);
        let many: Vec<_> = (0..90).map(|n| (format!("word{n}"), -f64::from(n))).collect();
        let found = hypotheses(&many, 20.0, 5);
        assert_eq!(found.len(), 5);
        assert!(found.iter().map(|h| h.confidence).sum::<f32>() < 1.0);
    }

    #[test]
    fn words_are_found_again_in_longer_and_shorter_texts() {
        let words = |text: &'static str| text.split(' ').collect::<Vec<_>>();
        let shared = |a, b| {
            let mut places = shared(&words(a), &words(b));
            places.sort_unstable();
            places
        };
        assert_eq!(shared("get me the bowl", "me the big bowl"), [1, 2, 3]);
        assert_eq!(shared("yes", "no"), [0; 0]);
        assert_eq!(shared("the one the one", "the one"), [2, 3]);
    }
}
