//! Sets of words that rules look for, from `vocabulary/word_sets.txt`.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::vocabulary::{entries, lines};

/// Declares the sets, by their names in the file.
macro_rules! word_sets {
    ($($(#[$doc:meta])* $set:ident,)+) => {
        /// A set of words.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum WordSet { $($(#[$doc])* $set,)+ }

        impl WordSet {
            /// Returns the set of that name.
            fn named(name: &str) -> Option<Self> {
                match name {
                    $(stringify!($set) => Some(Self::$set),)+
                    _ => None,
                }
            }
        }
    };
}

word_sets! {
    /// "along with": landmarks that are none.
    Along,
    /// "any", "whichever".
    Any,
    /// "the", "a".
    Article,
    /// Words that ask, whatever is asked.
    Asking,
    /// "back", after "put it".
    Back,
    /// "how come".
    Come,
    /// "goodbye".
    Farewell,
    /// "hello".
    Greeting,
    /// "how many".
    Many,
    /// "matter", after "it does not".
    Mattering,
    /// "pardon", as a request to repeat.
    Pardon,
    /// Those who talk, as landmarks.
    Person,
    /// Verbs before "back".
    Returning,
    /// "me".
    Speaker,
    /// Ordinals of things spoken of.
    SpokenOf,
    /// "thanks", "that is very kind".
    Thanks,
    /// "there", after "it is".
    There,
    /// Verbs before "away".
    Throwing,
    /// "i", as the subject of a plan.
    We,
    /// "where".
    Where,
    /// "which".
    Which,
    /// "why".
    Why,
}

/// The sets that have a word, one bit for each.
static SETS: LazyLock<HashMap<&str, u64>> = LazyLock::new(|| {
    let mut sets = HashMap::new();
    for (name, line) in lines(include_str!("vocabulary/word_sets.txt")) {
        let bit = WordSet::named(name).map_or(0, WordSet::bit);
        entries(line).for_each(|word| *sets.entry(word).or_default() |= bit);
    }
    sets
});

impl WordSet {
    fn bit(self) -> u64 {
        1 << self as u64
    }

    /// Returns whether the word is in the set.
    pub(crate) fn has(self, word: &str) -> bool {
        SETS.get(word).is_some_and(|sets| sets & self.bit() != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_the_file_are_declared_and_have_words() {
        let listed = lines(include_str!("vocabulary/word_sets.txt"));
        for (name, line) in listed {
            let set =
                WordSet::named(name).unwrap_or_else(|| panic!("expected a set, found {name}"));
            assert!(entries(line).all(|word| set.has(word)), "{line}");
        }
    }
}
