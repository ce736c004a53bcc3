//! A pronouncing dictionary with the words of a language model.
//!
//! Invariant: every requested word is either in the dictionary or among the missing ones. (The
//! decoder silently drops words without one, and takes seconds to load the whole dictionary.)

mod phones;
mod variants;

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt::Write as _;
use std::process::Command;
use std::time::Duration;

use crate::child_process;

/// Returns the known phones of a word that is not in the dictionary, separated by blanks.
type LetterToSound = dyn Fn(&str) -> Option<String>;

/// Words with their pronunciations, each a list of phones separated by blanks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pronunciations {
    entries: BTreeMap<String, Vec<String>>,
    missing: Vec<String>,
}

impl Pronunciations {
    /// Looks the words up in `dictionary` (in the format of the CMU dictionary: one line per
    /// pronunciation, further ones of a word marked `word(2)`). Missing words are composed of the
    /// parts of a hyphenated word ("see-through") or of a compound ("worktop"), otherwise looked up
    /// in `letter_to_sound`. Regular variants of English are added.
    pub(crate) fn collect<'w>(
        words: impl IntoIterator<Item = &'w str>,
        dictionary: &str,
        letter_to_sound: &LetterToSound,
    ) -> Self {
        let words: BTreeSet<&str> = words.into_iter().collect();
        // Parts as well: the dictionary has a hundred thousand lines, which are read once.
        let wanted = words.iter().flat_map(|word| parts(word)).chain(words.iter().copied());
        let known = look_up(dictionary, &wanted.collect());
        let mut entries = BTreeMap::new();
        let mut missing = Vec::new();
        for word in words {
            let composed = || {
                hyphenated(word, &known, letter_to_sound)
                    .or_else(|| compound(word, &known))
                    .or_else(|| letter_to_sound(word))
                    .map(|phones| vec![phones])
            };
            match known.get(word).cloned().or_else(composed) {
                Some(phones) => drop(entries.insert(word.to_owned(), phones)),
                None => missing.push(word.to_owned()),
            }
        }
        for pronunciations in entries.values_mut() {
            let further: Vec<String> =
                pronunciations.iter().flat_map(|phones| variants::variants(phones)).collect();
            for phones in further {
                if !pronunciations.contains(&phones) {
                    pronunciations.push(phones);
                }
            }
        }
        Self { entries, missing }
    }

    /// Returns the words without a pronunciation, which cannot be recognised.
    pub(crate) fn missing(&self) -> &[String] {
        &self.missing
    }

    /// Returns the pronunciations of a word.
    #[cfg(test)]
    fn of(&self, word: &str) -> &[String] {
        self.entries.get(word).map_or(&[], Vec::as_slice)
    }

    /// Returns the dictionary in the CMU format.
    pub(crate) fn to_text(&self) -> String {
        let mut text = String::new();
        for (word, pronunciations) in &self.entries {
            for (n, phones) in (1..).zip(pronunciations) {
                // Writing to a string cannot fail.
                let _ = match n {
                    1 => writeln!(text, "{word} {phones}"),
                    _ => writeln!(text, "{word}({n}) {phones}"),
                };
            }
        }
        text
    }
}

/// Returns the pronunciations of the wanted words in the dictionary.
fn look_up(dictionary: &str, wanted: &HashSet<&str>) -> BTreeMap<String, Vec<String>> {
    let mut known: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for line in dictionary.lines() {
        let Some((entry, phones)) = line.split_once([' ', '\t']) else { continue };
        let word = entry.split_once('(').filter(|(w, _)| !w.is_empty()).map_or(entry, |(w, _)| w);
        if wanted.contains(word) {
            known.entry(word.to_owned()).or_default().push(phones.trim().to_owned());
        }
    }
    known
}

/// Shortest part of a compound: two letters match too often by accident.
const PART_MIN: usize = 3;

/// Returns every word that could help to pronounce `word`: its parts between hyphens, and both
/// halves of every split.
fn parts(word: &str) -> Vec<&str> {
    word.split('-').chain(splits(word).flat_map(|(head, tail)| [head, tail])).collect()
}

/// Returns the splits of a word into two, the most even ones first, the longer head before the
/// longer tail.
fn splits(word: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut at: Vec<usize> = (word.char_indices().map(|(i, _)| i))
        .filter(|&i| i >= PART_MIN && word.len() - i >= PART_MIN)
        .collect();
    at.sort_by_key(|&i| (i.abs_diff(word.len() - i), word.len() - i));
    at.into_iter().map(|i| word.split_at(i))
}

fn hyphenated(
    word: &str,
    known: &BTreeMap<String, Vec<String>>,
    letter_to_sound: &LetterToSound,
) -> Option<String> {
    if !word.contains('-') {
        return None;
    }
    let phones: Option<Vec<String>> = (word.split('-').filter(|part| !part.is_empty()))
        .map(|part| first(part, known).or_else(|| letter_to_sound(part)))
        .collect();
    phones.map(|phones| phones.join(" "))
}

fn compound(word: &str, known: &BTreeMap<String, Vec<String>>) -> Option<String> {
    splits(word)
        .find_map(|(head, tail)| Some(format!("{} {}", first(head, known)?, first(tail, known)?)))
}

fn first(word: &str, known: &BTreeMap<String, Vec<String>>) -> Option<String> {
    known.get(word).and_then(|all| all.first()).cloned()
}

/// espeak-ng takes about 5 ms.
const DEADLINE: Duration = Duration::from_secs(2);

/// Returns the phones of a word by espeak-ng.
pub(crate) fn espeak_phones(word: &str) -> Option<String> {
    let mut command = Command::new("espeak-ng");
    command.args(["-q", "-x", "--sep= ", "-v", "en-us", "--", word]);
    let said = child_process::output(command, DEADLINE).ok()?;
    phones::phones(&String::from_utf8_lossy(&said))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DICTIONARY: &str = "\
'bout B AW T
get G EH T
get(2) G IH T
see S IY
top T AA P
through TH R UW
work W ER K
wor W AO R
ktop K T AA P
";

    fn collect(words: &[&str]) -> Pronunciations {
        let letters = |word: &str| (word == "hex").then(|| "HH EH K S".to_owned());
        Pronunciations::collect(words.iter().copied(), DICTIONARY, &letters)
    }

    #[test]
    fn pronunciations_include_all_of_the_dictionary() {
        let found = collect(&["get", "'bout"]);
        assert_eq!(found.of("get"), ["G EH T", "G IH T"]);
        assert_eq!(found.to_text(), "'bout B AW T\nget G EH T\nget(2) G IH T\n");
    }

    #[test]
    fn pronunciations_of_hyphenated_words_and_compounds_are_composed() {
        let found = collect(&["see-through", "worktop", "hex-top"]);
        assert_eq!(found.of("see-through"), ["S IY TH R UW"]);
        // The even split wins: "work" + "top", not "wor" + "ktop".
        assert_eq!(found.of("worktop"), ["W ER K T AA P", "W AH K T AA P"]);
        assert_eq!(found.of("hex-top"), ["HH EH K S T AA P"]);
        assert!(found.missing().is_empty());
    }

    #[test]
    fn pronunciations_list_missing_words() {
        let found = collect(&["zzgrx", "hex", "qq-get"]);
        assert_eq!(found.missing(), ["qq-get", "zzgrx"]);
        assert_eq!(collect(&["größenwahn"]).missing(), ["größenwahn"], "split at characters");
        assert_eq!(found.of("zzgrx"), [""; 0]);
        assert_eq!(found.of("hex"), ["HH EH K S"]);
    }
}
