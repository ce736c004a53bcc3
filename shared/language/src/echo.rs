//! The robot's own lines, heard back by a microphone.

use std::collections::HashSet;
use std::sync::LazyLock;

use words::{Tokens, normalise};

use crate::token_class::Class;
use crate::vocabulary;

/// Fewest words of a sentence that counts.
const WORDS_MIN: usize = 3;

/// Returns whether the heard text is a line of the robot, or some of its sentences in a row, with
/// at most one article or filler more or less. Other words may be the answer ("is it small or big
/// big"), and a phrase without a verb ("The red one?") may be repeated as one: neither is an echo.
pub fn is_echo(heard: &str, line: &str) -> bool {
    let heard = spoken(heard);
    let sentences: Vec<_> =
        line.split(['.', '?', '!']).map(spoken).filter(|words| !words.is_empty()).collect();
    let of_its_length =
        |run: &&[Vec<String>]| run.iter().map(Vec::len).sum::<usize>().abs_diff(heard.len()) <= 1;
    let runs_from = |from: usize| (from + 1..=sentences.len()).map(move |to| from..to);
    (0..sentences.len())
        .flat_map(runs_from)
        .map(|run| &sentences[run])
        .filter(of_its_length)
        .any(|run| is_repeated(&run.concat(), &heard))
}

fn is_repeated(said: &[String], heard: &[String]) -> bool {
    let has_verb = said.iter().any(|word| VERBS.contains(&**word));
    if said.len().min(heard.len()) < WORDS_MIN || !has_verb {
        return false;
    }
    let same = said.iter().zip(heard).take_while(|(a, b)| a == b).count();
    match heard.len().checked_sub(said.len()) {
        Some(0) => same == said.len(),
        Some(1) => is_small(&heard[same]) && said[same..] == heard[same + 1..],
        None => {
            said.len() == heard.len() + 1
                && is_small(&said[same])
                && said[same + 1..] == heard[same..]
        }
        Some(_) => false,
    }
}

fn is_small(word: &str) -> bool {
    SMALL.contains(word)
}

/// Splits a text into words as a recogniser writes them.
fn spoken(text: &str) -> Vec<String> {
    let text = normalise(text);
    Tokens::of(&text).words.iter().map(|token| token.word.to_owned()).collect()
}

/// Verbs of questions and statements, and question words.
static VERBS: LazyLock<HashSet<&str>> =
    LazyLock::new(|| of(&[Class::Be, Class::Auxiliary, Class::Question]).collect());

/// Words that recognisers add and lose, and that change nothing.
static SMALL: LazyLock<HashSet<&str>> =
    LazyLock::new(|| of(&[Class::Determiner, Class::Filler]).collect());

fn of(classes: &'static [Class]) -> impl Iterator<Item = &'static str> {
    vocabulary::phrases().filter(|(class, _)| classes.contains(class)).map(|(_, phrase)| phrase)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_heard_back_are_echoes() {
        for (heard, line) in [
            ("is it white", "Is it white?"),
            ("is it the white one", "All right. Is it the white one?"),
            ("all right is it the white one", "All right. Is it the white one?"),
            ("is it white one", "Is it the white one?"),
            ("is it the the white one", "Is it the white one?"),
            ("I will get the clear bowl", "I will get the clear bowl."),
            ("i'll get the clear bowl", "I'll get the clear bowl."),
            ("what colour is it", "What colour is it?"),
        ] {
            assert!(is_echo(heard, line), "{heard}");
        }
    }

    #[test]
    fn answers_are_no_echoes() {
        for (heard, line) in [
            ("it is white", "Is it white?"),
            ("the white one", "Is it the white one?"),
            ("the white one", "The white one?"),
            ("it is the white one", "Is it the white one?"),
            ("is it the red one", "Is it the white one?"),
            ("no is it the white one", "Is it the white one?"),
            ("it is not the white one", "It is the white one."),
            ("it isn't the white one", "It is the white one."),
            ("it the white one", "Is it the white one?"),
            ("is the white one", "Is it the white one?"),
            ("is it small or big small", "Is it small or big?"),
            ("what colour is it red", "What colour is it?"),
            ("the bowl on the counter", "Is the bowl on the counter?"),
            ("the color white", "Is the color white?"),
            ("i will get the clear bowl cancel", "I will get the clear bowl."),
            ("i will take the red mug", "I will take the mug."),
            ("yes", "Yes?"),
            ("white", "Is it white?"),
            ("", ""),
        ] {
            assert!(!is_echo(heard, line), "{heard}");
        }
    }
}
