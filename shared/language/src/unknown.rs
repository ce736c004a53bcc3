//! Words for things, qualities and relations that the scene does not have.

use std::ops::Range;

use scene::{Role, UnknownWord};
use words::Tokens;

use crate::clauses::{Clause, Topic};
use crate::related::Related;
use crate::relation_words::by_quality;
use crate::tagger::{Tag, after, before};
use crate::token_class::{Class, classes};
use crate::vocabulary::is_unlisted_quality;

/// Most words of a compound.
const COMPOUND_MAX: usize = 3;

/// Most words of a landmark that are repeated: "the small white cup".
const LANDMARK_MAX: usize = 4;

/// Attribute and object words that the scene does not have, for the robot's reply; last the places
/// that it may know how to tell.
pub(crate) fn unknown_words(
    tokens: &Tokens<'_>,
    tags: &[Tag<'_>],
    clauses: &[Clause],
    related: &[Related],
) -> Vec<UnknownWord> {
    let (mut words, mut places): (Vec<UnknownWord>, Vec<UnknownWord>) = Default::default();
    for clause in clauses.iter().filter(|clause| clause.topic != Topic::Off) {
        let asked = clause.requests || clause.topic == Topic::AskBack;
        let mut rest = clause.span.clone();
        while let Some(at) = rest.next() {
            if let Some(known) = related.iter().find(|it| it.tags.contains(&at)) {
                rest.start = known.tags.end;
                let text = said(tokens, tags, known.tags.clone());
                places
                    .extend(known.is_of_place().then_some(UnknownWord { text, role: Role::Place }));
                continue;
            }
            let word = if let Some(relation) = relation(&tags[..clause.span.end], at) {
                rest.start = relation.end;
                UnknownWord { text: said(tokens, tags, relation), role: Role::Place }
            } else if tags[at].is(Class::Unlisted) || asked && is_in_noun_phrase(tags, at) {
                named(tokens, tags, at)
            } else {
                continue;
            };
            if !words.contains(&word) {
                words.push(word);
            }
        }
    }
    words.extend(places);
    words
}

/// "next to the cup", "on the left", "third": the position of an object among others.
fn relation(tags: &[Tag<'_>], at: usize) -> Option<Range<usize>> {
    const ALONG: [&str; 4] = ["same", "along", "together", "around"];
    const NOUN_PHRASE: &[Class] =
        classes![Determiner Pointer Possessive Quantifier Head One Unlisted];
    let tag = &tags[at];
    if tag.is(Class::Landmark) && !ALONG.contains(&tag.word) {
        let in_phrase = |tag: &&Tag<'_>| {
            !tag.pauses() && (tag.is_value() || tag.is_unknown() || tag.is_any(NOUN_PHRASE))
        };
        let noun = tags[at + 1..].iter().take(LANDMARK_MAX).take_while(in_phrase).count();
        let next = after(tags, at);
        // "close to me", "nearby": the scene has no words for the places of robot and person.
        let is_person = next.is_some_and(|next| matches!(next.word, "me" | "you" | "us"));
        let is_bare = noun == 0 && !next.is_some_and(|next| next.is(Class::It));
        return (!is_person && !is_bare).then_some(at..at + 1 + noun);
    }
    (tag.is(Class::Ordinal) && is_counted(tags, at)).then_some(at..at + 1)
}

/// "the third bowl", "the one on the left", but not "first the bowl" and "the next one".
fn is_counted(tags: &[Tag<'_>], at: usize) -> bool {
    const SPOKEN_OF: [&str; 6] = ["last", "next", "previous", "former", "latter", "final"];
    let tag = &tags[at];
    if tag.word != tag.last {
        // "on the left", "number two", but not "the right one", which may be the wanted one.
        return tag.word != "right";
    }
    let is_led = before(tags, at).is_some_and(|it| it.is_any(classes![Determiner Possessive]));
    // "the top shelf" is a place.
    let is_part = after(tags, at).is_some_and(|next| next.is_role(Role::Place));
    let is_known = SPOKEN_OF.contains(&tag.word) || by_quality(tag.word).is_some();
    is_led && !is_part && !is_known
}

/// The words of some tags.
fn said(tokens: &Tokens<'_>, tags: &[Tag<'_>], range: Range<usize>) -> String {
    let begin = tags[range.start].at;
    let end = tags.get(range.end).map_or(tokens.words.len(), |tag| tag.at);
    // Two tags may come from one word.
    let words = tokens.words[begin..end.max(begin + 1)].iter().map(|token| token.word);
    words.collect::<Vec<_>>().join(" ")
}

/// An unknown word at the position of a value or noun: "the purpure one", "get me a foobar".
fn is_in_noun_phrase(tags: &[Tag<'_>], at: usize) -> bool {
    let Some(before) = before(tags, at) else {
        // "penicillin please"
        return tags[at].is_unknown() && tags[..at].iter().all(|tag| tag.is_any(classes![Filler]));
    };
    let lead = classes![Determiner Unlisted Quantifier Possessive];
    tags[at].is_unknown() && (before.is_value() || before.is_any(lead)) && !is_clause(tags, at)
}

/// "my grandmother gave me": the last unknown word is a verb.
fn is_clause(tags: &[Tag<'_>], at: usize) -> bool {
    let unknown = tags[at..].iter().take_while(|tag| tag.is_unknown()).count();
    let is_object = |tag: &Tag<'_>| tag.word == "me" || tag.is_any(classes![First Second It]);
    unknown > 1 && after(tags, at + unknown - 1).is_some_and(is_object)
}

/// The word with the rest of its compound, and its kind.
fn named(tokens: &Tokens<'_>, tags: &[Tag<'_>], at: usize) -> UnknownWord {
    let mut last = at;
    while last - at + 1 < COMPOUND_MAX
        && tags[last].is_unknown()
        && after(tags, last).is_some_and(Tag::is_unknown)
    {
        last += 1;
    }
    let describes = after(tags, last).is_some_and(|next| {
        next.is_any(classes![Head Unlisted Attribute]) || next.is_unknown() || next.is_value()
    });
    let in_phrase = |tag: &&Tag<'_>| {
        tag.is_value() || tag.is_any(classes![Determiner Possessive Quantifier Unlisted])
    };
    // "the mug in the garage"
    let is_place = tags[..at]
        .iter()
        .rev()
        .find(|tag| !in_phrase(tag))
        .is_some_and(|tag| tag.is_any(classes![Preposition Landmark Destination Than]));
    let role = if is_place {
        Role::Place
    } else if describes || is_unlisted_quality(tags[last].word) {
        Role::Quality
    } else {
        Role::Kind
    };
    UnknownWord { text: said(tokens, tags, at..last + 1), role }
}
