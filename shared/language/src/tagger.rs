//! Words to tags: each word or phrase with the part that it plays, misspelt, misheard and split
//! values included.

use crate::disambiguate::disambiguate;
use crate::lexicon::{Lexicon, Sense};
use crate::spelling::shortened;
use crate::token_class::Class;
use crate::tokens::{Gap, Token};

/// A word or phrase, what it is taken for, and the pause before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tag<'a> {
    pub(crate) sense: Sense,
    pub(crate) gap: Gap,
    /// Its first word.
    pub(crate) word: &'a str,
    /// Probability that something else was said: the recogniser's doubt, and that of taking the
    /// word for another.
    pub(crate) doubt: f64,
    /// The speaker's confidence in it.
    pub(crate) sure: f64,
}

/// A word or phrase taken for what it is not written as.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Guess {
    words: usize,
    sense: Sense,
    doubt: f64,
}

/// Doubts of taking a word for another, judged.
pub(crate) mod doubts {
    /// One slip of the finger, and no other value as near.
    pub(crate) const SLIP: f64 = 0.05;
    /// An everyday word one slip away, where a value belongs.
    pub(crate) const EVERYDAY: f64 = 0.3;
    /// The same consonants, where a value belongs.
    pub(crate) const SOUND: f64 = 0.3;
    /// Several words with the consonants of one value.
    pub(crate) const APART: f64 = 0.2;
}

impl<'a> Tag<'a> {
    /// The tag of `words` tokens, the first of which is `tokens[0]`.
    fn of(tokens: &[Token<'a>], words: usize, sense: Sense) -> Self {
        let run = &tokens[..words.min(tokens.len())];
        let least = run.iter().map(|token| token.confidence).fold(1.0, f32::min);
        let Token { word, gap, .. } = tokens[0];
        Self { sense, gap, word, doubt: 1.0 - f64::from(least), sure: 1.0 }
    }

    /// Taken for what it is, with this doubt.
    fn doubted(self, doubt: f64) -> Self {
        Self { doubt: 1.0 - (1.0 - self.doubt) * (1.0 - doubt), ..self }
    }

    /// Probability that a scene word that it stands for was not meant.
    pub(crate) fn word_doubt(&self) -> f64 {
        1.0 - (1.0 - self.doubt) * self.sure
    }

    /// Probability that an answer or a scope was not given: half of those that were not are right
    /// by chance.
    pub(crate) fn answer_doubt(&self) -> f64 {
        1.0 - (1.0 - self.doubt) * (2.0 * self.sure - 1.0)
    }

    pub(crate) fn class(&self) -> Option<Class> {
        match self.sense {
            Sense::Class(class) => Some(class),
            Sense::Value(_) | Sense::Unknown => None,
        }
    }

    pub(crate) fn is(&self, class: Class) -> bool {
        self.class() == Some(class)
    }

    pub(crate) fn is_any(&self, classes: &[Class]) -> bool {
        self.class().is_some_and(|class| classes.contains(&class))
    }

    pub(crate) fn value(&self) -> Option<u32> {
        match self.sense {
            Sense::Value(value) => Some(value),
            Sense::Class(_) | Sense::Unknown => None,
        }
    }
}

/// Fewest letters of a value that may be written as several words.
const JOINED_LETTERS_MIN: usize = 6;
/// Most letters of a word that is tried as two run together.
const RUN_ON_LETTERS_MAX: usize = 24;

/// The tags of some words.
pub(crate) fn tag<'a>(lexicon: &Lexicon, tokens: &[Token<'a>]) -> Vec<Tag<'a>> {
    let mut tags: Vec<Tag<'a>> = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        let here = &tokens[at..];
        let phrase = lexicon.longest(tokens, at);
        let apart = match phrase {
            Some(found) if found.words > 1 => None,
            _ => written_apart(lexicon, here),
        };
        if let Some(Guess { words, sense, doubt }) = apart {
            tags.push(Tag::of(here, words, sense).doubted(doubt));
            at += words;
            continue;
        }
        if let Some(found) = phrase {
            tags.push(Tag { sure: found.sure, ..Tag::of(here, found.words, found.sense) });
            at += found.words;
            continue;
        }
        let (first, second) = guessed(lexicon, here[0].word);
        if first.sense == Sense::Unknown
            && let Some(Guess { words, sense, doubt }) =
                heard_apart(lexicon, here, tags.last().is_some_and(describes))
        {
            tags.push(Tag::of(here, words, sense).doubted(doubt));
            at += words;
            continue;
        }
        let tag = Tag::of(here, 1, first.sense).doubted(first.doubt);
        tags.push(tag);
        tags.extend(second.map(|sense| Tag { sense, gap: Gap::Glued, ..tag }));
        at += 1;
    }
    disambiguate(lexicon, &mut tags);
    tags
}

/// "dish washer", "screw driver": neighbours that together are one value.
fn written_apart(lexicon: &Lexicon, tokens: &[Token<'_>]) -> Option<Guess> {
    (2..=3).filter(|&words| words <= tokens.len()).find_map(|words| {
        let run = &tokens[..words];
        let letters: usize = run.iter().map(|token| token.word.len()).sum();
        if !(JOINED_LETTERS_MIN..=RUN_ON_LETTERS_MAX).contains(&letters)
            || run[1..].iter().any(|token| token.gap > Gap::None)
        {
            return None;
        }
        let joined: String = run.iter().map(|token| token.word).collect();
        if let Some(sense @ Sense::Value(_)) = lexicon.word(&joined) {
            return Some(Guess { words, sense, doubt: 0.0 });
        }
        let whole = matches!(lexicon.word(run[0].word), Some(Sense::Value(_)));
        let value = lexicon.misspelt_compound(&joined).filter(|_| !whole)?;
        Some(Guess { words, sense: Sense::Value(value), doubt: doubts::SLIP })
    })
}

/// "mark her", "cab in it": neighbours that together sound like one long value; a shorter one where
/// a noun phrase continues (`described`).
fn heard_apart(lexicon: &Lexicon, tokens: &[Token<'_>], described: bool) -> Option<Guess> {
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
        Some(Guess { words, sense: Sense::Value(value), doubt: doubts::APART })
    })
}

fn describes(tag: &Tag<'_>) -> bool {
    tag.value().is_some() || tag.is(Class::Determiner)
}

/// A word that the lexicon does not have as it stands: lengthened, misspelt, or two run together.
fn guessed(lexicon: &Lexicon, word: &str) -> (Guess, Option<Sense>) {
    let one = |sense, doubt| (Guess { words: 1, sense, doubt }, None);
    let short = if lexicon.is_common(word) { None } else { shortened(word) };
    for candidate in short.iter().flatten() {
        if let Some(sense) = lexicon.word(candidate) {
            return one(sense, 0.0);
        }
    }
    if let Some(value) = lexicon.misspelt(word) {
        return one(Sense::Value(value), doubts::SLIP);
    }
    if let Some(stem) = word.strip_suffix('s')
        && let Some(sense @ Sense::Class(Class::Unlisted | Class::Story)) = lexicon.word(stem)
    {
        return one(sense, 0.0);
    }
    // "honestly", "immediately": an adverb changes no meaning here.
    if word.len() > 4 && word.ends_with("ly") {
        return one(Sense::Class(Class::Plain), 0.0);
    }
    match run_on(lexicon, word) {
        Some((sense, second)) => (Guess { words: 1, sense, doubt: 0.0 }, Some(second)),
        None => one(Sense::Unknown, 0.0),
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
            return Some((Sense::Class(Class::Not), right_sense));
        }
        let left_sense @ Sense::Value(_) = lexicon.word(left)? else { return None };
        match right_sense {
            Sense::Value(_) | Sense::Class(Class::Head) => Some((left_sense, right_sense)),
            Sense::Class(Class::One) => Some((left_sense, Sense::Class(Class::Head))),
            _ => None,
        }
    })
}
