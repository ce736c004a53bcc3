//! Disambiguates words by their neighbours: "one", "so", misheard values and nouns.

use scene::Role;

use crate::lexicon::{Lexicon, Sense};
use crate::tagger::{Tag, doubts};
use crate::token_class::{Class, classes};
use crate::tokens::Gap;

/// Resolves the tags that depend on their neighbours.
pub(crate) fn disambiguate(lexicon: &Lexicon, tags: &mut [Tag<'_>]) {
    for at in 0..tags.len() {
        let settled = match tags[at].sense {
            Sense::Class(Class::One) => one(tags, at),
            Sense::Class(Class::OtherLanguage) if tags[at].word == "non" => not_prefix(tags, at),
            Sense::Class(Class::But) => exception(tags, at),
            Sense::Class(Class::Join) if tags[at].word == "so" => degree(tags, at),
            Sense::Class(Class::Preposition) if tags[at].word == "as" => equal(tags, at),
            Sense::Class(Class::Courtesy) => named(tags, at),
            Sense::Class(Class::SideTalk) => pause_for_repair(tags, at),
            Sense::Class(Class::Put) if tags[at].word == "leave" => leave_out(lexicon, tags, at),
            Sense::Unknown => participle(lexicon, tags, at).or_else(|| {
                let (sense, doubt) =
                    misheard(lexicon, tags, at).or_else(|| misheard_place(lexicon, tags, at))?;
                tags[at].doubt = 1.0 - (1.0 - tags[at].doubt) * (1.0 - doubt);
                Some(sense)
            }),
            _ => None,
        };
        if let Some(sense) = settled {
            tags[at].sense = sense;
        }
    }
}

/// "one" is what an object is called after "the" or "white", and a number elsewhere.
fn one(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let before = tags[..at].last().filter(|_| tags[at].gap <= Gap::None);
    let head = before.is_some_and(|before| match before.sense {
        Sense::Value(_) | Sense::Unknown => true,
        Sense::Class(class) => matches!(
            class,
            Class::Determiner
                | Class::Pointer
                | Class::Quantifier
                | Class::Unlisted
                | Class::Ordinal
                | Class::Other
                | Class::Possessive
                | Class::Plain
                | Class::Question
                | Class::Filler
                | Class::WeakYes
                | Class::WeakNo
                | Class::Not
                | Class::Story
                | Class::Fetch
        ),
    });
    Some(Sense::Class(if head { Class::Head } else { Class::Plain }))
}

/// "non-metal" in English, "non merci" in French.
fn not_prefix(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let next = tags.get(at + 1).filter(|next| next.gap <= Gap::None)?;
    next.value().map(|_| Sense::Class(Class::Not))
}

/// "any bowl but the white one".
fn exception(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let before = &tags[at.saturating_sub(3)..at];
    let any = before.iter().any(|tag| matches!(tag.word, "any" | "every" | "all" | "anyone"));
    any.then_some(Sense::Class(Class::Except))
}

/// "so blue", where "so" joins nothing.
fn degree(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let after_verb = at > 0 && tags[at - 1].is_any(classes![Be Not]);
    let next = tags.get(at + 1).filter(|next| next.gap <= Gap::None);
    let before_value = next.is_some_and(|next| next.value().is_some());
    (after_verb || before_value).then_some(Sense::Class(Class::Plain))
}

/// "as big as the metal one": what follows the second "as" is another object.
fn equal(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let near = |tag: &&Tag<'_>| tag.gap <= Gap::None;
    let value = |tag: &Tag<'_>| tag.value().is_some();
    let first = tags[..at].last().is_some_and(value);
    let second = tags.get(at + 1).filter(near).is_some_and(value);
    match (first, second) {
        (_, true) => Some(Sense::Class(Class::Plain)),
        (true, false) => Some(Sense::Class(Class::Than)),
        _ => None,
    }
}

/// "the honey please": a thing, not what the robot is called.
fn named(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let before = tags[..at].last().filter(|_| tags[at].gap <= Gap::None)?;
    before.is(Class::Determiner).then_some(Sense::Unknown)
}

/// "the wide bowl", "the red ranch": where a value belongs, the one that sounds or looks like it.
fn misheard(lexicon: &Lexicon, tags: &[Tag<'_>], at: usize) -> Option<(Sense, f64)> {
    let word = tags[at].word;
    if lexicon.is_like_noun(word) && ends_noun_phrase(tags, at) {
        return Some((Sense::Class(Class::Head), 0.0));
    }
    let (value, doubt) = lexicon
        .sounds_like(word)
        .map(|value| (value, doubts::SOUND))
        .or_else(|| lexicon.looks_like(word).map(|value| (value, doubts::EVERYDAY)))?;
    let before = tags[..at].last().filter(|_| tags[at].gap <= Gap::None);
    let after = tags.get(at + 1).filter(|tag| tag.gap <= Gap::None);
    let describes = |tag: &Tag<'_>| {
        matches!(tag.sense, Sense::Value(_) | Sense::Class(Class::Determiner | Class::Fetch))
    };
    let belongs = match lexicon.value(value).role {
        Role::Quality => {
            let noun = |tag: &Tag<'_>| {
                tag.is_any(classes![Head One])
                    || tag.value().is_some_and(|v| lexicon.value(v).role == Role::Kind)
            };
            before.is_some_and(describes) && after.is_some_and(noun)
        }
        Role::Kind => {
            let qualified = |tag: &Tag<'_>| tag.value().is_some();
            let asked_for = || {
                let recent = &tags[at.saturating_sub(4)..at];
                recent.iter().any(|tag| tag.is_any(classes![Fetch Want]))
            };
            let ends = after.is_none_or(|tag| tag.is_any(AFTER_NOUN));
            ends && (before.is_some_and(qualified) || before.is_some_and(describes) && asked_for())
        }
        Role::Place => false,
    };
    belongs.then_some((Sense::Value(value), doubt))
}

/// Classes that may follow the noun of a noun phrase.
const AFTER_NOUN: &[Class] = classes![Preposition Courtesy Filler Pointer];

/// "the small white bold": where the noun belongs.
fn ends_noun_phrase(tags: &[Tag<'_>], at: usize) -> bool {
    let before = tags[..at].last().filter(|_| tags[at].gap <= Gap::None);
    let after = tags.get(at + 1).filter(|tag| tag.gap <= Gap::None);
    before.is_some_and(|tag| tag.value().is_some())
        && after.is_none_or(|tag| tag.is_any(AFTER_NOUN))
}

/// "the clear one, hang on, the white one": a moment to think, and the words before are replaced.
fn pause_for_repair(tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    const REACH: usize = 4;
    let names = |tag: &Tag<'_>| tag.value().is_some() || tag.is_any(classes![Yes No]);
    let thinks = matches!(tags[at].word, "hang" | "hold" | "one" | "just");
    let before = tags[at.saturating_sub(REACH)..at].iter().any(names);
    let after = tags[at + 1..].iter().take(REACH).any(names);
    (thinks && before && after).then_some(Sense::Class(Class::Repair))
}

/// "leave the white one, …", but not "leave the white one on the counter".
fn leave_out(lexicon: &Lexicon, tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let rest = &tags[at + 1..];
    let phrase = rest.iter().position(|tag| tag.gap >= Gap::Pause).unwrap_or(rest.len());
    let place = |value: u32| lexicon.value(value).role == Role::Place;
    let values = || rest[..phrase].iter().filter_map(Tag::value);
    let headed = rest[..phrase].iter().any(|tag| tag.is_any(classes![Head One]))
        || values().any(|value| lexicon.value(value).role == Role::Kind);
    let strange = rest[..phrase].iter().any(|tag| tag.sense == Sense::Unknown);
    let named = values().next().is_some() && !values().any(place) && headed && !strange;
    named.then_some(Sense::Class(Class::Except))
}

/// "the shirt draped over the chair", "the pen clipped to the drawer": how it is where it is.
fn participle(lexicon: &Lexicon, tags: &[Tag<'_>], at: usize) -> Option<Sense> {
    let tag = &tags[at];
    let before = tags[..at].last().filter(|_| tag.gap <= Gap::None)?;
    let noun = before.is(Class::Head)
        || before.value().is_some_and(|value| lexicon.value(value).role == Role::Kind);
    let next = tags.get(at + 1).filter(|next| next.gap <= Gap::None)?;
    let ends = tag.word.len() > 4 && (tag.word.ends_with("ed") || tag.word.ends_with("ing"));
    let leads = next.is_any(classes![Preposition Landmark Destination]);
    (noun && ends && leads).then_some(Sense::Class(Class::Plain))
}

/// "on the counted", "in the draw": where a place ends the sentence, the one that it sounds like.
fn misheard_place(lexicon: &Lexicon, tags: &[Tag<'_>], at: usize) -> Option<(Sense, f64)> {
    let [.., preposition, determiner] = &tags[..at] else { return None };
    let after = tags.get(at + 1).filter(|tag| tag.gap <= Gap::None);
    let stands = preposition.is(Class::Preposition)
        && determiner.word == "the"
        && after.is_none_or(|tag| tag.is_any(classes![Courtesy Filler]));
    let word = tags[at].word;
    let value =
        lexicon.looks_like(word).or_else(|| lexicon.sounds_like(word)).filter(|_| stands)?;
    let place = lexicon.value(value).role == Role::Place;
    place.then_some((Sense::Value(value), doubts::EVERYDAY))
}
