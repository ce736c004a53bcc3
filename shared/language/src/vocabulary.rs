//! English words and phrases of a dialogue about things to fetch, from the folder `vocabulary`.

use std::collections::HashSet;
use std::sync::LazyLock;

use crate::token_class::Class;

/// Returns every phrase of the dialogue with its class.
pub(crate) fn phrases() -> impl Iterator<Item = (Class, &'static str)> {
    let mut class = None;
    let lines = include_str!("vocabulary/phrases.txt").lines();
    lines.filter(|line| !line.starts_with('#')).flat_map(move |line| {
        let heading = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        class = heading.map_or(class, |heading| Class::named(class_of(heading)));
        let listed = class.filter(|_| heading.is_none() && !line.is_empty());
        let phrases = line.trim_end_matches(',').split(", ");
        phrases.filter_map(move |phrase| Some((listed?, phrase)))
    })
}

/// Returns the patterns that halt the arm, each with its section.
pub(crate) fn halting() -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut section = "";
    let lines = include_str!("vocabulary/halting.txt").lines();
    lines.filter(|line| !line.starts_with('#') && !line.is_empty()).filter_map(move |line| {
        match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            Some(heading) => {
                section = heading;
                None
            }
            None => Some((section, line)),
        }
    })
}

/// Returns the class of a heading; the text after the name subdivides the class.
fn class_of(heading: &str) -> &str {
    heading.split(' ').next().unwrap_or(heading)
}

/// Returns whether a word that people ask for is a quality of things: "purple", "wooden".
pub(crate) fn is_unlisted_quality(word: &str) -> bool {
    static QUALITIES: LazyLock<HashSet<&str>> = LazyLock::new(|| {
        let text = include_str!("vocabulary/phrases.txt");
        let section = text.split_once("[Unlisted quality]\n").map_or("", |(_, rest)| rest);
        let section = section.split_once("\n\n").map_or(section, |(section, _)| section);
        section.split([',', '\n']).map(str::trim).filter(|word| !word.is_empty()).collect()
    });
    QUALITIES.contains(word)
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
