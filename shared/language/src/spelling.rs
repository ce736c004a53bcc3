//! Misspelt values: one slip of the finger in a word of five letters or more.
//!
//! The index holds, for every known word, the word itself and every string that is left when one
//! letter is taken out. Two words that are one slip apart share such a string, so a lookup costs
//! the length of the word, however many values a scene has.

use std::collections::HashMap;

/// Shortest known word that is corrected to: shorter ones have too many neighbours.
const KNOWN_LETTERS_MIN: usize = 5;
/// Length of the longest word that is looked up.
const LETTERS_MAX: usize = 32;

/// Known words by their reduced spelling.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpellingIndex {
    words: Vec<(String, usize)>,
    remains: HashMap<String, Vec<usize>>,
}

impl SpellingIndex {
    /// Adds a known word with its sense.
    pub(crate) fn add(&mut self, word: &str, sense: usize) {
        let letters = word.chars().count();
        if !(KNOWN_LETTERS_MIN..=LETTERS_MAX).contains(&letters) {
            return;
        }
        let at = self.words.len();
        self.words.push((word.to_owned(), sense));
        for remain in remains(word) {
            let at_remain = self.remains.entry(remain).or_default();
            if at_remain.last() != Some(&at) {
                at_remain.push(at);
            }
        }
    }

    /// Returns the meaning of the word, if exactly one is one slip away.
    pub(crate) fn correct(&self, word: &str) -> Option<usize> {
        let letters = word.chars().count();
        if !(KNOWN_LETTERS_MIN - 1..=LETTERS_MAX).contains(&letters) {
            return None;
        }
        let mut found = None;
        for remain in remains(word) {
            for &at in self.remains.get(&remain).into_iter().flatten() {
                let (known, sense) = &self.words[at];
                if found != Some(*sense) && strsim::osa_distance(word, known) <= 1 {
                    if found.is_some() {
                        return None;
                    }
                    found = Some(*sense);
                }
            }
        }
        found
    }
}

/// The word, and the word without each of its letters.
fn remains(word: &str) -> impl Iterator<Item = String> + '_ {
    let without = word.char_indices().map(|(at, c)| {
        let mut remain = String::with_capacity(word.len());
        remain.push_str(&word[..at]);
        remain.push_str(&word[at + c.len_utf8()..]);
        remain
    });
    std::iter::once(word.to_owned()).chain(without)
}

/// A word said or typed long ("biiiig", "nooo"), with every run of a letter cut to two, as English
/// spells some words, and to one.
pub(crate) fn shortened(word: &str) -> Option<[String; 2]> {
    let repeats = word.chars().zip(word.chars().skip(1)).any(|(c, next)| c == next);
    repeats.then_some(())?;
    let mut runs: Vec<(char, usize)> = Vec::new();
    for c in word.chars() {
        match runs.last_mut() {
            Some((last, length)) if *last == c => *length += 1,
            _ => runs.push((c, 1)),
        }
    }
    Some([2, 1].map(|longest| {
        let cut = |&(c, length): &(char, usize)| std::iter::repeat_n(c, length.min(longest));
        runs.iter().flat_map(cut).collect()
    }))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{SpellingIndex, shortened};

    fn index() -> SpellingIndex {
        let mut index = SpellingIndex::default();
        for (sense, word) in (0..).zip(["white", "plastic", "metal", "dishwasher", "big", "blend"])
        {
            index.add(word, sense);
        }
        index.add("blond", 6);
        index
    }

    #[test]
    fn spelling_corrects_one_slip() {
        let index = index();
        for (word, sense) in [
            ("whte", Some(0)),
            ("whtie", Some(0)),
            ("whhite", Some(0)),
            ("plastoc", Some(1)),
            ("dishwaser", Some(3)),
            ("bg", None),
            ("wiht", None),
            ("blnd", None),
            ("blind", None),
        ] {
            assert_eq!(index.correct(word), sense, "{word}");
        }
    }

    #[test]
    fn spelling_shortens_lengthened_words() {
        assert_eq!(shortened("biiiig"), Some(["biig".into(), "big".into()]));
        assert_eq!(shortened("smalllll"), Some(["small".into(), "smal".into()]));
        assert_eq!(shortened("big"), None);
    }

    proptest! {
        #[test]
        fn agrees_with_comparing_every_word(word in "[bdehilnstw]{3,7}") {
            let index = index();
            let near: std::collections::BTreeSet<usize> = (index.words.iter())
                .filter(|(known, _)| strsim::osa_distance(&word, known) <= 1)
                .map(|(_, sense)| *sense)
                .collect();
            let only = (near.len() == 1).then(|| *near.first().expect("one"));
            let long_enough = word.len() >= 4;
            prop_assert_eq!(index.correct(&word), only.filter(|_| long_enough));
        }
    }
}
