//! English words and phrases of a dialogue about things to fetch, from the folder `vocabulary`.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::token_class::Class;

/// Returns every phrase with its class.
pub(crate) fn phrases() -> impl Iterator<Item = (Class, &'static str)> {
    let mut class = None;
    let lines = include_str!("vocabulary/phrases.txt").lines();
    lines.filter(|line| !line.starts_with('#')).flat_map(move |line| {
        let heading = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        class = heading.map_or(class, Class::named);
        let listed = class.filter(|_| heading.is_none() && !line.is_empty());
        let phrases = line.trim_end_matches(',').split(", ");
        phrases.filter_map(move |phrase| Some((listed?, phrase)))
    })
}

/// Everyday words that a misspelt value could be taken for; they are never corrected.
pub(crate) fn common_words() -> impl Iterator<Item = &'static str> {
    include_str!("vocabulary/common_words.txt").split_ascii_whitespace()
}

/// Returns the words of a contraction that its ending does not spell out.
pub(crate) fn expansion(word: &str) -> Option<&'static str> {
    static EXPANSIONS: LazyLock<HashMap<&str, &str>> = LazyLock::new(|| {
        let lines = include_str!("vocabulary/contractions.txt").lines();
        let rows = lines.filter_map(|line| line.split_once(" = "));
        rows.flat_map(|(words, expansion)| words.split(", ").map(move |word| (word, expansion)))
            .collect()
    });
    EXPANSIONS.get(word).copied()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::{Class, phrases};
    use crate::normalise::normalise;
    use crate::tokens::Tokens;

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
