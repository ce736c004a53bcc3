//! A pronouncing dictionary cut to the words of a language model.
//!
//! Invariant: every word that was asked for is either in the dictionary or among the missing; none
//! is dropped in silence. (The decoder drops words without a pronunciation from a language model,
//! and takes seconds to load the whole dictionary.)

mod phones;
mod variants;

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt::Write as _;
use std::process::Command;
use std::time::Duration;

use crate::devices::child;

/// Where the phones of words that the dictionary lacks come from.
pub trait Spelling {
    /// The phones of a word, separated by blanks; `None` if it cannot be told.
    fn phones_of(&self, word: &str) -> Option<String>;
}

/// Words with their pronunciations, each a list of phones separated by blanks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pronunciations {
    entries: BTreeMap<String, Vec<String>>,
    missing: Vec<String>,
}

impl Pronunciations {
    /// Finds the words in `dictionary` (a text in the format of the CMU dictionary: a line for
    /// each pronunciation, further ones of a word marked `word(2)`). What it lacks is put together
    /// from the parts of a hyphenated word ("see-through") or of a compound ("worktop"), else
    /// asked of `spelling`. To these come the ways of saying them that rules of English tell.
    pub fn collect<'w>(
        words: impl IntoIterator<Item = &'w str>,
        dictionary: &str,
        spelling: &dyn Spelling,
    ) -> Self {
        let words: BTreeSet<&str> = words.into_iter().collect();
        let mut entries = look_up(dictionary, &words.iter().copied().collect());
        let lacking: Vec<&str> = words.into_iter().filter(|w| !entries.contains_key(*w)).collect();
        let known = look_up(dictionary, &lacking.iter().flat_map(|word| parts(word)).collect());
        let mut missing = Vec::new();
        for word in lacking {
            let phones = hyphenated(word, &known, spelling)
                .or_else(|| compound(word, &known))
                .or_else(|| spelling.phones_of(word));
            match phones {
                Some(phones) => {
                    entries.insert(word.to_owned(), vec![phones]);
                }
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

    /// Words without a pronunciation: they cannot be recognised.
    pub fn missing(&self) -> &[String] {
        &self.missing
    }

    /// The pronunciations of a word.
    pub fn of(&self, word: &str) -> &[String] {
        self.entries.get(word).map_or(&[], Vec::as_slice)
    }

    /// The dictionary in the CMU format.
    pub fn to_text(&self) -> String {
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

/// The pronunciations of the wanted words that the dictionary has.
fn look_up(dictionary: &str, wanted: &HashSet<&str>) -> BTreeMap<String, Vec<String>> {
    let mut known: BTreeMap<String, Vec<String>> = BTreeMap::new();
    if wanted.is_empty() {
        return known;
    }
    for line in dictionary.lines() {
        let Some((entry, phones)) = line.split_once([' ', '\t']) else { continue };
        let word = entry.split_once('(').filter(|(w, _)| !w.is_empty()).map_or(entry, |(w, _)| w);
        if wanted.contains(word) {
            known.entry(word.to_owned()).or_default().push(phones.trim().to_owned());
        }
    }
    known
}

/// The shortest part of a compound that is looked for: two letters make too many accidents.
const PART_MIN: usize = 3;

/// Every word that could help to pronounce `word`: what stands between hyphens, and both halves of
/// every cut of it.
fn parts(word: &str) -> Vec<&str> {
    word.split('-').chain(cuts(word).flat_map(|(head, tail)| [head, tail])).collect()
}

/// The cuts of a word into two, the most even ones first, the longer head before the longer tail.
fn cuts(word: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut at: Vec<usize> = (word.char_indices().map(|(i, _)| i))
        .filter(|&i| i >= PART_MIN && word.len() - i >= PART_MIN)
        .collect();
    at.sort_by_key(|&i| (i.abs_diff(word.len() - i), word.len() - i));
    at.into_iter().map(|i| word.split_at(i))
}

fn hyphenated(
    word: &str,
    known: &BTreeMap<String, Vec<String>>,
    spelling: &dyn Spelling,
) -> Option<String> {
    if !word.contains('-') {
        return None;
    }
    let phones: Option<Vec<String>> = (word.split('-').filter(|part| !part.is_empty()))
        .map(|part| first(part, known).or_else(|| spelling.phones_of(part)))
        .collect();
    phones.map(|phones| phones.join(" "))
}

fn compound(word: &str, known: &BTreeMap<String, Vec<String>>) -> Option<String> {
    cuts(word)
        .find_map(|(head, tail)| Some(format!("{} {}", first(head, known)?, first(tail, known)?)))
}

fn first(word: &str, known: &BTreeMap<String, Vec<String>>) -> Option<String> {
    known.get(word).and_then(|all| all.first()).cloned()
}

/// No source of further pronunciations.
pub struct NoSpelling;

impl Spelling for NoSpelling {
    fn phones_of(&self, _word: &str) -> Option<String> {
        None
    }
}

/// Asks espeak-ng how it would read the word aloud.
pub struct EspeakSpelling;

impl EspeakSpelling {
    /// espeak-ng answers in some 5 ms.
    const DEADLINE: Duration = Duration::from_secs(2);
}

impl Spelling for EspeakSpelling {
    fn phones_of(&self, word: &str) -> Option<String> {
        let mut command = Command::new("espeak-ng");
        command.args(["-q", "-x", "--sep= ", "-v", "en-us", "--", word]);
        let said = child::output(command, Self::DEADLINE).ok()?;
        phones::phones(&String::from_utf8_lossy(&said))
    }
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

    struct Letters;

    impl Spelling for Letters {
        fn phones_of(&self, word: &str) -> Option<String> {
            (word == "hex").then(|| "HH EH K S".to_owned())
        }
    }

    fn collect(words: &[&str]) -> Pronunciations {
        Pronunciations::collect(words.iter().copied(), DICTIONARY, &Letters)
    }

    #[test]
    fn words_keep_all_their_pronunciations() {
        let found = collect(&["get", "'bout"]);
        assert_eq!(found.of("get"), ["G EH T", "G IH T"]);
        assert_eq!(found.to_text(), "'bout B AW T\nget G EH T\nget(2) G IH T\n");
    }

    #[test]
    fn hyphens_and_compounds_are_put_together() {
        let found = collect(&["see-through", "worktop", "hex-top"]);
        assert_eq!(found.of("see-through"), ["S IY TH R UW"]);
        // The even cut wins: "work" + "top", not "wor" + "ktop".
        assert_eq!(found.of("worktop"), ["W ER K T AA P", "W AH K T AA P"]);
        assert_eq!(found.of("hex-top"), ["HH EH K S T AA P"]);
        assert!(found.missing().is_empty());
    }

    #[test]
    fn what_nothing_can_pronounce_is_missing() {
        let found = collect(&["zzgrx", "hex", "qq-get"]);
        assert_eq!(found.missing(), ["qq-get", "zzgrx"]);
        assert_eq!(found.of("zzgrx"), [""; 0]);
        assert_eq!(found.of("hex"), ["HH EH K S"]);
    }

    #[test]
    fn words_beyond_ascii_are_cut_at_letters() {
        assert_eq!(collect(&["größenwahn"]).missing(), ["größenwahn"]);
    }
}
