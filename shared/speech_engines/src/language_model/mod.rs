//! Trigram language model of people's sentences about a scene.
//!
//! Invariant: the same scene yields the same model, byte for byte, without clock, files or system
//! randomness.

mod sentences;
mod templates;
mod trigram;

pub use sentences::scene_sentences;
pub(crate) use trigram::Trigram;

/// Returns common English words. They are in the language model so that talk about other things is
/// recognised as such; without them every sentence would be recognised as words of the scene.
pub(crate) fn common_words() -> impl Iterator<Item = &'static str> {
    include_str!("common_words.txt").split_whitespace()
}

/// Returns the words of a text in the form of the language model: lower case letters and digits
/// with inner hyphens and apostrophes.
pub fn words(text: &str) -> Vec<String> {
    text.split_whitespace()
        .map(|raw| {
            let word: String = raw
                .chars()
                .flat_map(char::to_lowercase)
                .map(|c| if c == '\u{2019}' { '\'' } else { c })
                .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '\''))
                .collect();
            word.trim_matches(|c| c == '-' || c == '\'').to_owned()
        })
        .filter(|word| !word.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::{common_words, words};

    #[test]
    fn language_model_words_keep_inner_hyphens_and_apostrophes() {
        assert_eq!(
            words("  It\u{2019}s the See-Through ONE, 'please'! -- "),
            ["it's", "the", "see-through", "one", "please"]
        );
        assert!(words(" ... ").is_empty());
    }

    #[test]
    fn common_words_are_unique() {
        let all: Vec<&str> = common_words().collect();
        assert!(all.len() > 190);
        assert_eq!(all.iter().collect::<HashSet<_>>().len(), all.len());
    }
}
