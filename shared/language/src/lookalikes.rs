//! The values that a word outside the lexicon may stand for: misspelt by a typist, or taken for
//! another by a recogniser. Values are places in the lexicon.

use std::collections::{HashMap, HashSet};

use words::{normalise, skeleton};

use crate::spelling::SpellingIndex;
use crate::vocabulary::{self, is_thing};

/// A scene's values by spelling and sound.
#[derive(Clone, Debug)]
pub(crate) struct Lookalikes {
    spelling: SpellingIndex,
    /// Values of several words, written as one.
    compounds: SpellingIndex,
    /// The value with that skeleton, if it is the only one.
    sounds: HashMap<String, Option<usize>>,
    common: HashSet<&'static str>,
    noun: String,
}

impl Lookalikes {
    /// Starts with the scene's noun.
    pub(crate) fn new(noun: &str) -> Self {
        Self {
            spelling: SpellingIndex::default(),
            compounds: SpellingIndex::default(),
            sounds: HashMap::new(),
            common: vocabulary::common_words().collect(),
            noun: normalise(noun).into_owned(),
        }
    }

    /// Adds a value of one word.
    pub(crate) fn add_word(&mut self, word: &str, value: usize) {
        self.spelling.add(word, value);
        if let Some(sounds) = skeleton(word).filter(|sounds| sounds.len() > 1) {
            let only = self.sounds.entry(sounds).or_insert(Some(value));
            *only = only.filter(|other| *other == value);
        }
    }

    /// Adds a value of several words, written as one.
    pub(crate) fn add_compound(&mut self, joined: &str, value: usize) {
        self.spelling.add(joined, value);
        self.compounds.add(joined, value);
    }

    /// The value that the misspelt word must be.
    pub(crate) fn misspelt(&self, word: &str) -> Option<usize> {
        if self.is_common(word) || is_thing(word) { None } else { self.looks_like(word) }
    }

    /// The value of several words that is one slip away from words written as one.
    pub(crate) fn misspelt_compound(&self, joined: &str) -> Option<usize> {
        self.compounds.correct(joined)
    }

    /// The value one slip away, even from an everyday word.
    pub(crate) fn looks_like(&self, word: &str) -> Option<usize> {
        self.spelling.correct(word)
    }

    /// The only value that sounds like the word.
    pub(crate) fn sounds_like(&self, word: &str) -> Option<usize> {
        self.sounding(&skeleton(word)?, 0)
    }

    /// The only value that sounds like the word, if it has enough consonants to be sure.
    pub(crate) fn sounds_like_long(&self, word: &str) -> Option<usize> {
        self.sounding(&skeleton(word)?, 4)
    }

    /// The only value that sounds like the words one after the other, unstressed "her" as "er".
    pub(crate) fn sounds_like_run<'a>(&self, run: impl Iterator<Item = &'a str>) -> Option<usize> {
        let mut sounds = String::new();
        for word in run {
            let word = skeleton(word)?;
            let word = if sounds.is_empty() { &word } else { word.trim_start_matches(['H', 'A']) };
            let word = if word.chars().next() == sounds.chars().last() {
                &word[1.min(word.len())..]
            } else {
                word
            };
            sounds.push_str(word);
        }
        self.sounding(&sounds, 3)
    }

    fn sounding(&self, sounds: &str, consonants_min: usize) -> Option<usize> {
        self.sounds.get(sounds).copied().flatten().filter(|_| sounds.len() >= consonants_min)
    }

    /// Returns whether a recogniser or a typist could have turned the scene's noun into the word.
    pub(crate) fn is_like_noun(&self, word: &str) -> bool {
        const LETTERS_MAX: usize = 24;
        word.len() <= LETTERS_MAX
            && (strsim::osa_distance(word, &self.noun) <= 1
                || skeleton(word).is_some_and(|sounds| skeleton(&self.noun) == Some(sounds)))
    }

    /// Returns whether the word is everyday English, whatever else it may resemble.
    pub(crate) fn is_common(&self, word: &str) -> bool {
        self.common.contains(word)
    }
}
