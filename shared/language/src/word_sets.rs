//! Sets of words that rules look for, from `vocabulary/word_sets.txt`.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::vocabulary::{entries, lines};

/// Declares the sets, by their names in the file.
macro_rules! word_sets {
    ($($set:ident),+) => {
        /// A set of words; the file describes each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum WordSet { $($set),+ }

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
    Adverb, Again, All, Along, Another, Any, Article, Asking, Back, Come, Farewell, Forget,
    Greeting, Is, It, Many, Mattering, Me, Next, No, Of, One, OneOf, OneOfThem, Pair, Pardon,
    Pause, Person, Please, Returning, Same, Some, Speaker, SpokenOf, Thanked, Thanks, The, Then,
    There, Think, Throwing, We, What, Where, Which, Why, Wrong
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
