//! Interpolated Witten-Bell trigram with a lower bound on its escapes, written as ARPA text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

const START: &str = "<s>";
const END: &str = "</s>";

/// Lower bound on the probability of an unseen continuation after any history.
const ESCAPE_MIN: f64 = 0.1;
/// Share of the background words in the distribution without history.
const BACKGROUND: f64 = 0.5;

/// A trigram model `p(w | u v)` over the words of its sentences and the background words.
///
/// For a history `h` with `c(h)` continuations by `T(h)` different words:
/// `p(w|h) = (1 - e) c(hw)/c(h) + e p(w|h')`, where `h'` lacks the oldest word and the escape is
/// `e = max(T(h) / (c(h) + T(h)), ESCAPE_MIN)` (Witten and Bell 1991, method C, with a floor). It
/// sums to one over all words and the sentence's end after every history, and an ARPA file holds
/// it exactly: the weight of an unseen word is `e`.
#[derive(Clone, Debug)]
pub(crate) struct Trigram {
    words: Vec<String>,
    unigrams: Vec<f64>,
    bigrams: BTreeMap<u32, History>,
    trigrams: BTreeMap<(u32, u32), History>,
}

/// Continuations of a history.
#[derive(Clone, Debug, Default)]
struct History {
    count: f64,
    next: BTreeMap<u32, f64>,
    escape: f64,
}

impl History {
    fn add(&mut self, word: u32) {
        self.count += 1.0;
        *self.next.entry(word).or_default() += 1.0;
    }

    fn close(&mut self, escape_min: f64) {
        let kinds = self.next.len() as f64;
        self.escape = (kinds / (self.count + kinds)).max(escape_min);
    }

    /// Returns the interpolation with `shorter`, the probability after the shorter history.
    fn probability(&self, word: u32, shorter: f64) -> f64 {
        let seen = self.next.get(&word).map_or(0.0, |n| n / self.count);
        (1.0 - self.escape) * seen + self.escape * shorter
    }
}

impl Trigram {
    /// Estimates the model from sentences (words separated by blanks) and `background` words. A
    /// word in both has both shares; an empty background has none.
    pub(crate) fn train<'b, S: AsRef<str>>(
        sentences: &[S],
        background: impl IntoIterator<Item = &'b str>,
    ) -> Self {
        let background: BTreeSet<&str> = background.into_iter().collect();
        let mut words: BTreeSet<&str> = background.clone();
        words.extend(sentences.iter().flat_map(|s| s.as_ref().split_whitespace()));
        // The end comes first and the start last, so that the predictable words are numbered
        // without a gap.
        let marked = std::iter::once(END).chain(words).chain(std::iter::once(START));
        let words: Vec<String> = marked.map(str::to_owned).collect();
        let index: BTreeMap<&str, u32> =
            words.iter().zip(0..).map(|(word, i)| (word.as_str(), i)).collect();

        let mut once = History::default();
        let mut bigrams: BTreeMap<u32, History> = BTreeMap::new();
        let mut trigrams: BTreeMap<(u32, u32), History> = BTreeMap::new();
        for sentence in sentences {
            let (mut u, mut v) = (None, index[START]);
            let said = sentence.as_ref().split_whitespace().chain(std::iter::once(END));
            for w in said.map(|word| index[word]) {
                once.add(w);
                bigrams.entry(v).or_default().add(w);
                if let Some(u) = u {
                    trigrams.entry((u, v)).or_default().add(w);
                }
                (u, v) = (Some(v), w);
            }
        }
        once.close(0.0);
        bigrams.values_mut().for_each(|h| h.close(ESCAPE_MIN));
        trigrams.values_mut().for_each(|h| h.close(ESCAPE_MIN));
        let background: Vec<u32> = background.into_iter().map(|word| index[word]).collect();
        let unigrams = unigrams(&once, words.len() - 1, &background);
        Self { words, unigrams, bigrams, trigrams }
    }

    /// Returns the vocabulary without the markers of start and end.
    pub(crate) fn vocabulary(&self) -> impl Iterator<Item = &str> {
        self.words[1..self.words.len() - 1].iter().map(String::as_str)
    }

    /// Returns the model as ARPA text.
    pub(crate) fn to_arpa(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_arpa(&mut text);
        text
    }

    fn write_arpa(&self, out: &mut String) -> std::fmt::Result {
        let pairs: usize = self.bigrams.values().map(|h| h.next.len()).sum();
        let triples: usize = self.trigrams.values().map(|h| h.next.len()).sum();
        writeln!(out, "\\data\\\nngram 1={}", self.words.len())?;
        writeln!(out, "ngram 2={pairs}\nngram 3={triples}\n\n\\1-grams:")?;
        for (word, i) in self.words.iter().zip(0u32..) {
            // The start of a sentence is never predicted; by convention its weight is 10^-99.
            let p = self.unigrams.get(i as usize).map_or(-99.0, |p| p.log10());
            writeln!(out, "{p:.5} {word}{}", backoff(self.bigrams.get(&i)))?;
        }
        writeln!(out, "\n\\2-grams:")?;
        for (&u, history) in &self.bigrams {
            for &w in history.next.keys() {
                let p = self.after_one(u, w).log10();
                let weight = backoff(self.trigrams.get(&(u, w)));
                writeln!(out, "{p:.5} {} {}{weight}", self.word(u), self.word(w))?;
            }
        }
        writeln!(out, "\n\\3-grams:")?;
        for (&(u, v), history) in &self.trigrams {
            for &w in history.next.keys() {
                let p = self.after_two(u, v, w).log10();
                writeln!(out, "{p:.5} {} {} {}", self.word(u), self.word(v), self.word(w))?;
            }
        }
        writeln!(out, "\n\\end\\")
    }

    fn word(&self, index: u32) -> &str {
        &self.words[index as usize]
    }

    fn after_one(&self, v: u32, w: u32) -> f64 {
        let shorter = self.unigrams[w as usize];
        self.bigrams.get(&v).map_or(shorter, |h| h.probability(w, shorter))
    }

    fn after_two(&self, u: u32, v: u32, w: u32) -> f64 {
        let shorter = self.after_one(v, w);
        self.trigrams.get(&(u, v)).map_or(shorter, |h| h.probability(w, shorter))
    }
}

/// Returns the distribution without history over all words but the start: Witten-Bell with a
/// uniform distribution, mixed with the uniform one over the background words.
fn unigrams(once: &History, len: usize, background: &[u32]) -> Vec<f64> {
    let share = if background.is_empty() { 0.0 } else { BACKGROUND };
    let mut p: Vec<f64> =
        (0..len as u32).map(|w| (1.0 - share) * once.probability(w, 1.0 / len as f64)).collect();
    for &w in background {
        p[w as usize] += share / background.len() as f64;
    }
    p
}

/// Returns the back-off column of an ARPA line.
fn backoff(history: Option<&History>) -> String {
    history.map(|h| format!(" {:.5}", h.escape.log10())).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Trigram {
        let sentences = ["get the white bowl", "the white one", "yes", "no the big white bowl"];
        Trigram::train(&sentences, ["weather", "time", "one"])
    }

    #[test]
    fn trigram_probabilities_sum_to_one_after_every_history() {
        let model = model();
        let words = 0..model.unigrams.len() as u32;
        let close = |sum: f64| assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        close(model.unigrams.iter().sum());
        for u in 0..model.words.len() as u32 {
            close(words.clone().map(|w| model.after_one(u, w)).sum());
            for v in words.clone() {
                close(words.clone().map(|w| model.after_two(u, v, w)).sum());
            }
        }
    }

    /// Evaluates the ARPA text by the rules of the format.
    #[test]
    fn trigram_arpa_text_is_equivalent_and_deterministic() {
        let model = model();
        let text = model.to_arpa();
        assert_eq!(super::tests::model().to_arpa(), text);
        let mut grams: BTreeMap<Vec<&str>, (f64, f64)> = BTreeMap::new();
        for line in text.lines().filter(|l| !l.starts_with('\\') && !l.starts_with("ngram")) {
            let mut fields = line.split(' ');
            let Some(p) = fields.next().and_then(|p| p.parse::<f64>().ok()) else { continue };
            let mut gram: Vec<&str> = fields.collect();
            let weight = match gram.last().and_then(|last| last.parse::<f64>().ok()) {
                Some(weight) => {
                    gram.pop();
                    weight
                }
                None => 0.0,
            };
            grams.insert(gram, (p, weight));
        }
        assert!(text.contains(&format!("ngram 1={}\n", model.words.len())));
        let read = |gram: &[&str]| -> f64 {
            let mut penalty = 0.0;
            for from in 0..gram.len() {
                if let Some((p, _)) = grams.get(&gram[from..]) {
                    return penalty + p;
                }
                penalty += grams.get(&gram[from..gram.len() - 1]).map_or(0.0, |g| g.1);
            }
            panic!("no unigram for {gram:?}");
        };
        let n = model.unigrams.len() as u32;
        for (u, v, w) in
            (0..n).flat_map(|u| (0..n).flat_map(move |v| (0..n).map(move |w| (u, v, w))))
        {
            let read = read(&[model.word(u), model.word(v), model.word(w)]);
            assert!((read - model.after_two(u, v, w).log10()).abs() < 1e-4);
        }
    }
}
