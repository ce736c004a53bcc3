//! Words of the closed classes: negators, answers, articles, pronouns, and dialogue commands.
//! Values cannot replace them: one of that name needs its attribute or noun. Slips are corrected.

use std::collections::{HashMap, HashSet};
use std::sync::LazyLock;

use words::contractions;

use crate::token_class::{Class, classes};
use crate::vocabulary;

/// The classes whose words no value takes away.
const CLOSED: &[Class] = classes![
    Not Except No Yes One Determiner Pointer Possessive First Second It
    Cancel StartOver Repeat PutBack Unsure Indifferent AskHelp AskStatus
];
/// Shortest negator corrected for a missing or added letter. Other slips are swapped neighbours: a
/// wrong letter often makes another English word ("cancer", "messed", "loader").
const LETTERS_MIN: usize = 6;

/// Returns whether the words are one phrase of a closed class.
pub(crate) fn is_closed(words: &[String]) -> bool {
    static PHRASES: LazyLock<HashSet<&str>> = LazyLock::new(|| {
        let closed = vocabulary::phrases().filter(|(class, _)| CLOSED.contains(class));
        closed.map(|(_, phrase)| phrase.trim_end_matches(" .")).collect()
    });
    PHRASES.contains(&*words.join(" "))
}

/// Returns whether a misspelt value cannot begin with a word of this class.
pub(crate) fn is_closed_class(class: Class) -> bool {
    CLOSED.contains(&class)
}

/// Returns the class of the closed-class word that is one slip away, if it is the only class.
pub(crate) fn misspelt(word: &str) -> Option<Class> {
    let letters = word.chars().count();
    let is_near = |known: &str, class: Class| {
        let negates = matches!(class, Class::Not | Class::Except) && known.len() >= LETTERS_MIN;
        let one_letter =
            letters.abs_diff(known.len()) == 1 && word.chars().next() == known.chars().next();
        (negates && one_letter || letters == known.len() && is_transposed(word, known))
            && strsim::osa_distance(word, known) == 1
    };
    let mut near =
        words().iter().filter(|(known, class)| is_near(known, **class)).map(|(_, class)| *class);
    let class = near.next()?;
    near.all(|other| other == class).then_some(class)
}

/// Returns whether two words differ in the order of their letters alone.
fn is_transposed(one: &str, other: &str) -> bool {
    let sorted = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    sorted(one) == sorted(other)
}

/// The words of the closed classes; a contraction that denies is a negator.
fn words() -> &'static HashMap<&'static str, Class> {
    static WORDS: LazyLock<HashMap<&str, Class>> = LazyLock::new(|| {
        let is_word = |(class, phrase): &(Class, &str)| {
            CLOSED.contains(class) && !phrase.contains(' ') && phrase.len() > 2
        };
        let listed = vocabulary::phrases().filter(is_word).map(|(class, word)| (word, class));
        let denies = |(word, expansion): (&'static str, &'static str)| {
            expansion.ends_with(" not").then_some((word, Class::Not))
        };
        listed.chain(contractions().filter_map(denies)).collect()
    });
    &WORDS
}

/// Returns whether lone words are an answer, whatever else they name in a scene.
pub(crate) fn is_answer(class: Class) -> bool {
    matches!(class, Class::Yes | Class::No | Class::WeakYes | Class::WeakNo)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_in_closed_class_words_are_mended() {
        for (word, class) in [
            ("nto", Some(Class::Not)),
            ("wihtout", Some(Class::Not)),
            ("excpet", Some(Class::Except)),
            ("exept", Some(Class::Except)),
            ("dotn", Some(Class::Not)),
            ("teh", Some(Class::Determiner)),
            ("yse", Some(Class::Yes)),
            ("lever", None),
            ("newer", None),
            ("nut", None),
            ("ton", None),
            ("bye", None),
            ("messed", None),
            ("hardy", None),
            ("cancer", None),
            ("loader", None),
            ("relay", None),
            ("estate", None),
            ("kissed", None),
        ] {
            assert_eq!(misspelt(word), class, "{word}");
        }
    }
}
