//! The English that a dialogue about things to fetch is made of, as data: each list is one
//! [`Cue`]. Scene words are not here; a scene's own word always wins over a list.
//!
//! A phrase that ends with " ." counts only where its clause ends. Phrases are parted by commas and written as the tokens read them: contractions opened, no hyphens.

mod answers;
mod grammar;
mod intents;
mod topics;

use crate::cue::Cue;

/// Every phrase with its cue.
pub(crate) fn phrases() -> impl Iterator<Item = (Cue, &'static str)> {
    let lists = [grammar::LISTS, answers::LISTS, intents::LISTS, topics::LISTS];
    let lists = lists.into_iter().flatten();
    lists.flat_map(|(cue, list)| list.split(", ").map(|phrase| (*cue, phrase)))
}

/// Everyday words that a misspelt value could be taken for; they are never corrected.
pub(crate) fn common_words() -> impl Iterator<Item = &'static str> {
    include_str!("common_words.txt").split_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::{Cue, phrases};
    use crate::normalise::normalise;
    use crate::tokens::Tokens;

    #[test]
    fn phrases_are_written_as_tokens_read_them() {
        for (_, phrase) in phrases() {
            let phrase = phrase.trim_end_matches(" .");
            let text = normalise(phrase);
            let words: Vec<&str> = Tokens::of(&text).words.iter().map(|t| t.word).collect();
            assert_eq!(words.join(" "), phrase);
        }
    }

    #[test]
    fn a_phrase_plays_one_part() {
        let mut parts: HashMap<&str, Cue> = HashMap::new();
        for (cue, phrase) in phrases() {
            if let Some(other) = parts.insert(phrase, cue) {
                panic!("`{phrase}` is listed as {other:?} and as {cue:?}");
            }
        }
    }
}
