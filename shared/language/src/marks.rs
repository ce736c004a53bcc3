//! Words to marks: each word or phrase with the part that it plays, misspelt, misheard and split
//! values included.

use scene::Role;

use crate::cue::{Cue, cues};
use crate::lexicon::{Lexicon, Sense};
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
            && let Some((words, sense)) = heard_apart(lexicon, &tokens[at..])
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
        let sense = lexicon.word(&joined)?;
        matches!(sense, Sense::Value(_)).then_some((words, sense))
    })
}

/// "mark her", "cab in it": neighbours that together sound like one long value.
fn heard_apart(lexicon: &Lexicon, tokens: &[Token<'_>]) -> Option<(usize, Sense)> {
    (2..=3).filter(|&words| words <= tokens.len()).find_map(|words| {
        let run = &tokens[..words];
        if run[1..].iter().any(|token| token.gap > Gap::None) {
            return None;
        }
        let joined: String = run.iter().map(|token| token.word).collect();
        let value = lexicon.sounds_like_long(&joined)?;
        Some((words, Sense::Value(value)))
    })
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

/// Settles what only the neighbours tell.
fn settle(lexicon: &Lexicon, marks: &mut [Mark<'_>]) {
    for at in 0..marks.len() {
        let settled = match marks[at].sense {
            Sense::Cue(Cue::One) => one(marks, at),
            Sense::Cue(Cue::OtherLanguage) if marks[at].word == "non" => not_prefix(marks, at),
            Sense::Cue(Cue::But) => exception(marks, at),
            Sense::Cue(Cue::Join) if marks[at].word == "so" => degree(marks, at),
            Sense::Unknown => misheard(lexicon, marks, at),
            _ => None,
        };
        if let Some(sense) = settled {
            marks[at].sense = sense;
        }
    }
}

/// "one" is what an object is called after "the" or "white", and a number elsewhere.
fn one(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let before = marks[..at].last().filter(|_| marks[at].gap <= Gap::None);
    let head = before.is_some_and(|before| match before.sense {
        Sense::Value(_) | Sense::Unknown => true,
        Sense::Cue(cue) => matches!(
            cue,
            Cue::Determiner
                | Cue::Pointer
                | Cue::Quantifier
                | Cue::Unlisted
                | Cue::Ordinal
                | Cue::Other
                | Cue::Possessive
                | Cue::Plain
                | Cue::Question
                | Cue::Filler
                | Cue::WeakYes
                | Cue::WeakNo
                | Cue::Not
        ),
    });
    Some(Sense::Cue(if head { Cue::Head } else { Cue::Plain }))
}

/// "non-metal" in English, "non merci" in French.
fn not_prefix(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let next = marks.get(at + 1).filter(|next| next.gap <= Gap::None)?;
    next.value().map(|_| Sense::Cue(Cue::Not))
}

/// "any bowl but the white one".
fn exception(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let before = &marks[at.saturating_sub(3)..at];
    let any = before.iter().any(|mark| matches!(mark.word, "any" | "every" | "all" | "anyone"));
    any.then_some(Sense::Cue(Cue::Except))
}

/// "so blue", where "so" joins nothing.
fn degree(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let after_verb = at > 0 && marks[at - 1].is_any(cues![Be Not]);
    let next = marks.get(at + 1).filter(|next| next.gap <= Gap::None);
    let before_value = next.is_some_and(|next| next.value().is_some());
    (after_verb || before_value).then_some(Sense::Cue(Cue::Plain))
}

/// "the wide bowl", "the red ranch": where a value belongs, the one that sounds or looks like it.
fn misheard(lexicon: &Lexicon, marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let word = marks[at].word;
    if lexicon.is_like_noun(word) && ends_noun_phrase(marks, at) {
        return Some(Sense::Cue(Cue::Head));
    }
    let value = lexicon.sounds_like(word).or_else(|| lexicon.looks_like(word))?;
    let before = marks[..at].last().filter(|_| marks[at].gap <= Gap::None);
    let after = marks.get(at + 1).filter(|mark| mark.gap <= Gap::None);
    let describes = |mark: &Mark<'_>| {
        matches!(mark.sense, Sense::Value(_) | Sense::Cue(Cue::Determiner | Cue::Fetch))
    };
    let belongs = match lexicon.value(value).role {
        Role::Quality => {
            let noun = |mark: &Mark<'_>| {
                mark.is_any(cues![Head One])
                    || mark.value().is_some_and(|v| lexicon.value(v).role == Role::Kind)
            };
            before.is_some_and(describes) && after.is_some_and(noun)
        }
        Role::Kind => {
            let qualified = |mark: &Mark<'_>| mark.value().is_some();
            let asked_for = || {
                let recent = &marks[at.saturating_sub(4)..at];
                recent.iter().any(|mark| mark.is_any(cues![Fetch Want]))
            };
            let ends = after.is_none_or(|mark| mark.is_any(AFTER_NOUN));
            ends && (before.is_some_and(qualified) || before.is_some_and(describes) && asked_for())
        }
        Role::Place => false,
    };
    belongs.then_some(Sense::Value(value))
}

/// What may follow the noun of a noun phrase.
const AFTER_NOUN: &[Cue] = cues![Preposition Courtesy Filler Pointer];

/// "the small white bold": where the noun belongs.
fn ends_noun_phrase(marks: &[Mark<'_>], at: usize) -> bool {
    let before = marks[..at].last().filter(|_| marks[at].gap <= Gap::None);
    let after = marks.get(at + 1).filter(|mark| mark.gap <= Gap::None);
    before.is_some_and(|mark| mark.value().is_some())
        && after.is_none_or(|mark| mark.is_any(AFTER_NOUN))
}
