//! Marks whose part only their neighbours tell: "one", "so", misheard values and nouns.

use scene::Role;

use crate::cue::{Cue, cues};
use crate::lexicon::{Lexicon, Sense};
use crate::marks::{Mark, doubts};
use crate::tokens::Gap;

/// Settles what only the neighbours tell.
pub(crate) fn settle(lexicon: &Lexicon, marks: &mut [Mark<'_>]) {
    for at in 0..marks.len() {
        let settled = match marks[at].sense {
            Sense::Cue(Cue::One) => one(marks, at),
            Sense::Cue(Cue::OtherLanguage) if marks[at].word == "non" => not_prefix(marks, at),
            Sense::Cue(Cue::But) => exception(marks, at),
            Sense::Cue(Cue::Join) if marks[at].word == "so" => degree(marks, at),
            Sense::Cue(Cue::Preposition) if marks[at].word == "as" => equal(marks, at),
            Sense::Cue(Cue::Courtesy) => named(marks, at),
            Sense::Cue(Cue::Aside) => pause_for_repair(marks, at),
            Sense::Cue(Cue::Put) if marks[at].word == "leave" => leave_out(lexicon, marks, at),
            Sense::Unknown => participle(lexicon, marks, at).or_else(|| {
                let (sense, doubt) =
                    misheard(lexicon, marks, at).or_else(|| misheard_place(lexicon, marks, at))?;
                marks[at].doubt = 1.0 - (1.0 - marks[at].doubt) * (1.0 - doubt);
                Some(sense)
            }),
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
                | Cue::Story
                | Cue::Fetch
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

/// "as big as the metal one": what follows the second "as" is another object.
fn equal(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let near = |mark: &&Mark<'_>| mark.gap <= Gap::None;
    let value = |mark: &Mark<'_>| mark.value().is_some();
    let first = marks[..at].last().is_some_and(value);
    let second = marks.get(at + 1).filter(near).is_some_and(value);
    match (first, second) {
        (_, true) => Some(Sense::Cue(Cue::Plain)),
        (true, false) => Some(Sense::Cue(Cue::Than)),
        _ => None,
    }
}

/// "the honey please": a thing, not what the robot is called.
fn named(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let before = marks[..at].last().filter(|_| marks[at].gap <= Gap::None)?;
    before.is(Cue::Determiner).then_some(Sense::Unknown)
}

/// "the wide bowl", "the red ranch": where a value belongs, the one that sounds or looks like it.
fn misheard(lexicon: &Lexicon, marks: &[Mark<'_>], at: usize) -> Option<(Sense, f64)> {
    let word = marks[at].word;
    if lexicon.is_like_noun(word) && ends_noun_phrase(marks, at) {
        return Some((Sense::Cue(Cue::Head), 0.0));
    }
    let (value, doubt) = lexicon
        .sounds_like(word)
        .map(|value| (value, doubts::SOUND))
        .or_else(|| lexicon.looks_like(word).map(|value| (value, doubts::EVERYDAY)))?;
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
    belongs.then_some((Sense::Value(value), doubt))
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

/// "the clear one, hang on, the white one": a moment to think, and the words before are replaced.
fn pause_for_repair(marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    const REACH: usize = 4;
    let names = |mark: &Mark<'_>| mark.value().is_some() || mark.is_any(cues![Yes No]);
    let thinks = matches!(marks[at].word, "hang" | "hold" | "one" | "just");
    let before = marks[at.saturating_sub(REACH)..at].iter().any(names);
    let after = marks[at + 1..].iter().take(REACH).any(names);
    (thinks && before && after).then_some(Sense::Cue(Cue::Repair))
}

/// "leave the white one, …", but not "leave the white one on the counter".
fn leave_out(lexicon: &Lexicon, marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let rest = &marks[at + 1..];
    let phrase = rest.iter().position(|mark| mark.gap >= Gap::Pause).unwrap_or(rest.len());
    let place = |value: u32| lexicon.value(value).role == Role::Place;
    let values = || rest[..phrase].iter().filter_map(Mark::value);
    let headed = rest[..phrase].iter().any(|mark| mark.is_any(cues![Head One]))
        || values().any(|value| lexicon.value(value).role == Role::Kind);
    let strange = rest[..phrase].iter().any(|mark| mark.sense == Sense::Unknown);
    let named = values().next().is_some() && !values().any(place) && headed && !strange;
    named.then_some(Sense::Cue(Cue::Except))
}

/// "the shirt draped over the chair", "the pen clipped to the drawer": how it is where it is.
fn participle(lexicon: &Lexicon, marks: &[Mark<'_>], at: usize) -> Option<Sense> {
    let mark = &marks[at];
    let before = marks[..at].last().filter(|_| mark.gap <= Gap::None)?;
    let noun = before.is(Cue::Head)
        || before.value().is_some_and(|value| lexicon.value(value).role == Role::Kind);
    let next = marks.get(at + 1).filter(|next| next.gap <= Gap::None)?;
    let ends = mark.word.len() > 4 && (mark.word.ends_with("ed") || mark.word.ends_with("ing"));
    let leads = next.is_any(cues![Preposition Landmark Destination]);
    (noun && ends && leads).then_some(Sense::Cue(Cue::Plain))
}

/// "on the counted", "in the draw": where a place ends the sentence, the one that it sounds like.
fn misheard_place(lexicon: &Lexicon, marks: &[Mark<'_>], at: usize) -> Option<(Sense, f64)> {
    let [.., preposition, determiner] = &marks[..at] else { return None };
    let after = marks.get(at + 1).filter(|mark| mark.gap <= Gap::None);
    let stands = preposition.is(Cue::Preposition)
        && determiner.word == "the"
        && after.is_none_or(|mark| mark.is_any(cues![Courtesy Filler]));
    let word = marks[at].word;
    let value =
        lexicon.looks_like(word).or_else(|| lexicon.sounds_like(word)).filter(|_| stands)?;
    let place = lexicon.value(value).role == Role::Place;
    place.then_some((Sense::Value(value), doubts::EVERYDAY))
}
