//! English words and phrases of a dialogue about things to fetch, from the folder `vocabulary`.

use std::collections::HashSet;
use std::sync::LazyLock;

use crate::token_class::Class;

const PHRASES: &str = include_str!("vocabulary/phrases.txt");

/// Returns the lines of a file, each with the heading of its section.
pub(crate) fn lines(file: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut section = "";
    let lines = file.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.filter_map(move |line| {
        let heading = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        section = heading.unwrap_or(section);
        heading.is_none().then_some((section, line))
    })
}

/// Returns the entries of a line that lists them.
pub(crate) fn entries(line: &str) -> impl Iterator<Item = &str> {
    line.trim_end_matches(',').split(", ")
}

/// Returns every phrase of the dialogue with its class; text after a class subdivides it.
pub(crate) fn phrases() -> impl Iterator<Item = (Class, &'static str)> {
    lines(PHRASES).flat_map(|(section, line)| {
        let class = section.split(' ').next().and_then(Class::named);
        entries(line).filter_map(move |phrase| Some((class?, phrase)))
    })
}

/// Returns whether the words are a phrase of the dialogue.
pub(crate) fn is_phrase(words: &str) -> bool {
    static PHRASES: LazyLock<HashSet<&str>> =
        LazyLock::new(|| phrases().map(|(_, phrase)| phrase.trim_end_matches(" .")).collect());
    PHRASES.contains(words)
}

/// Returns the patterns that halt the arm, each with its section.
pub(crate) fn halting() -> impl Iterator<Item = (&'static str, &'static str)> {
    lines(include_str!("vocabulary/halting.txt"))
}

/// Returns whether a word that people ask for is a quality of things: "purple", "wooden".
pub(crate) fn is_unlisted_quality(word: &str) -> bool {
    let mut qualities = lines(PHRASES).filter(|(section, _)| *section == "Unlisted quality");
    qualities.any(|(_, line)| entries(line).any(|quality| quality == word))
}

/// Everyday words that a misspelt value could be taken for; they are never corrected.
pub(crate) fn common_words() -> impl Iterator<Item = &'static str> {
    include_str!("vocabulary/common_words.txt").split_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::{Class, phrases};
    use words::Tokens;
    use words::normalise;

    #[test]
    fn phrases_are_written_as_tokens() {
        for (_, phrase) in phrases() {
            let phrase = phrase.trim_end_matches(" .");
            let text = normalise(phrase);
            let words: Vec<&str> = Tokens::of(&text).words.iter().map(|t| t.word).collect();
            assert_eq!(words.join(" "), phrase);
        }
    }

    #[test]
    fn phrases_have_one_class() {
        assert!(phrases().count() > 2_000, "a line without a class is lost");
        let mut parts: HashMap<&str, Class> = HashMap::new();
        for (class, phrase) in phrases() {
            if let Some(other) = parts.insert(phrase, class) {
                panic!("`{phrase}` is listed as {other:?} and as {class:?}");
            }
        }
    }
}
