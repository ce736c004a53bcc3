//! Words to marks: each word or phrase with the part that it plays, misspelt, misheard and split
//! values included.

use crate::cue::Cue;
use crate::lexicon::{Lexicon, Sense};
use crate::settle::settle;
use crate::spelling::shortened;
use crate::tokens::{Gap, Token};

/// A word or phrase, what it is taken for, and the pause before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark<'a> {
    pub(crate) sense: Sense,
    pub(crate) gap: Gap,
    /// Its first word.
    pub(crate) word: &'a str,
}

impl Mark<'_> {
    pub(crate) fn cue(&self) -> Option<Cue> {
        match self.sense {
            Sense::Cue(cue) => Some(cue),
            Sense::Value(_) | Sense::Unknown => None,
        }
    }

    pub(crate) fn is(&self, cue: Cue) -> bool {
        self.cue() == Some(cue)
    }

    pub(crate) fn is_any(&self, cues: &[Cue]) -> bool {
        self.cue().is_some_and(|cue| cues.contains(&cue))
    }

    pub(crate) fn value(&self) -> Option<u32> {
        match self.sense {
            Sense::Value(value) => Some(value),
            Sense::Cue(_) | Sense::Unknown => None,
        }
    }
}

/// Fewest letters of a value that may be written as several words.
const JOINED_LETTERS_MIN: usize = 6;
/// Most letters of a word that is tried as two run together.
const RUN_ON_LETTERS_MAX: usize = 24;

/// The marks of some words.
pub(crate) fn marks<'a>(lexicon: &Lexicon, tokens: &[Token<'a>]) -> Vec<Mark<'a>> {
    let mut marks: Vec<Mark<'a>> = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        let Token { word, gap } = tokens[at];
        let phrase = lexicon.longest(tokens, at);
        let found = match phrase {
            Some((words, _)) if words > 1 => phrase,
            _ => written_apart(lexicon, &tokens[at..]).or(phrase),
        };
        if let Some((words, sense)) = found {
            marks.push(Mark { sense, gap, word });
            at += words;
            continue;
        }
        let (first, second) = guessed(lexicon, word);
        if first == Sense::Unknown
            && let Some((words, sense)) =
                heard_apart(lexicon, &tokens[at..], marks.last().is_some_and(describes))
        {
            marks.push(Mark { sense, gap, word });
            at += words;
            continue;
        }
        marks.push(Mark { sense: first, gap, word });
        marks.extend(second.map(|sense| Mark { sense, gap: Gap::Glued, word }));
        at += 1;
    }
    settle(lexicon, &mut marks);
    marks
}

/// "dish washer", "screw driver": neighbours that together are one value.
fn written_apart(lexicon: &Lexicon, tokens: &[Token<'_>]) -> Option<(usize, Sense)> {
    (2..=3).filter(|&words| words <= tokens.len()).find_map(|words| {
        let run = &tokens[..words];
        let letters: usize = run.iter().map(|token| token.word.len()).sum();
        if !(JOINED_LETTERS_MIN..=RUN_ON_LETTERS_MAX).contains(&letters)
            || run[1..].iter().any(|token| token.gap > Gap::None)
        {
            return None;
        }
        let joined: String = run.iter().map(|token| token.word).collect();
        let whole = matches!(lexicon.word(run[0].word), Some(Sense::Value(_)));
        let compound = || lexicon.misspelt_compound(&joined).filter(|_| !whole).map(Sense::Value);
        let sense = lexicon.word(&joined).or_else(compound)?;
        matches!(sense, Sense::Value(_)).then_some((words, sense))
    })
}

/// "mark her", "cab in it": neighbours that together sound like one long value; a shorter one
/// where a noun phrase goes on (`described`).
fn heard_apart(lexicon: &Lexicon, tokens: &[Token<'_>], described: bool) -> Option<(usize, Sense)> {
    (2..=3).filter(|&words| words <= tokens.len()).find_map(|words| {
        let run = &tokens[..words];
        if run[1..].iter().any(|token| token.gap > Gap::None) {
            return None;
        }
        let joined: String = run.iter().map(|token| token.word).collect();
        let value = lexicon.sounds_like_long(&joined).or_else(|| {
            let run = run.iter().map(|token| token.word);
            lexicon.sounds_like_run(run).filter(|_| described)
        })?;
        Some((words, Sense::Value(value)))
    })
}

fn describes(mark: &Mark<'_>) -> bool {
    mark.value().is_some() || mark.is(Cue::Determiner)
}

/// A word that the lexicon does not have as it stands: lengthened, misspelt, or two run together.
fn guessed(lexicon: &Lexicon, word: &str) -> (Sense, Option<Sense>) {
    let short = if lexicon.is_common(word) { None } else { shortened(word) };
    for candidate in short.iter().flatten() {
        if let Some(sense) = lexicon.word(candidate) {
            return (sense, None);
        }
    }
    if let Some(value) = lexicon.misspelt(word) {
        return (Sense::Value(value), None);
    }
    if let Some(stem) = word.strip_suffix('s')
        && let Some(sense @ Sense::Cue(Cue::Unlisted | Cue::Story)) = lexicon.word(stem)
    {
        return (sense, None);
    }
    // "honestly", "immediately": an adverb changes no meaning here.
    if word.len() > 4 && word.ends_with("ly") {
        return (Sense::Cue(Cue::Plain), None);
    }
    match run_on(lexicon, word) {
        Some((first, second)) => (first, Some(second)),
        None => (Sense::Unknown, None),
    }
}

/// "whitebowl", "nonmetal": a value and what it stands with, run together.
fn run_on(lexicon: &Lexicon, word: &str) -> Option<(Sense, Sense)> {
    if !word.is_ascii() || word.len() > RUN_ON_LETTERS_MAX || lexicon.is_common(word) {
        return None;
    }
    (3..word.len().saturating_sub(2)).find_map(|at| {
        let (left, right) = word.split_at(at);
        let right_sense = lexicon.word(right)?;
        if left == "non" && matches!(right_sense, Sense::Value(_)) {
            return Some((Sense::Cue(Cue::Not), right_sense));
        }
        let left_sense @ Sense::Value(_) = lexicon.word(left)? else { return None };
        match right_sense {
            Sense::Value(_) | Sense::Cue(Cue::Head) => Some((left_sense, right_sense)),
            Sense::Cue(Cue::One) => Some((left_sense, Sense::Cue(Cue::Head))),
            _ => None,
        }
    })
}
