//! Words for things and qualities that the scene does not have.

use scene::{Role, UnknownWord};

use crate::clauses::{Clause, Topic};
use crate::tagger::{Tag, after, before};
use crate::token_class::{Class, classes};
use crate::vocabulary::is_unlisted_quality;

/// Most words of a compound.
const COMPOUND_MAX: usize = 3;

/// Attribute and object words that the scene does not have, for the robot's reply.
pub(crate) fn unknown_words(tags: &[Tag<'_>], clauses: &[Clause]) -> Vec<UnknownWord> {
    let mut words: Vec<UnknownWord> = Vec::new();
    for clause in clauses.iter().filter(|clause| clause.topic != Topic::Off) {
        for at in clause.span.clone() {
            let asked = clause.requests || clause.topic == Topic::AskBack;
            if !(tags[at].is(Class::Unlisted) || asked && is_in_noun_phrase(tags, at)) {
                continue;
            }
            let word = named(tags, at);
            if !words.contains(&word) {
                words.push(word);
            }
        }
    }
    words
}

/// An unknown word where a value or noun belongs: "the purpure one", "get me a foobar".
fn is_in_noun_phrase(tags: &[Tag<'_>], at: usize) -> bool {
    let Some(before) = before(tags, at) else {
        // "penicillin please"
        return tags[at].is_unknown() && tags[..at].iter().all(|tag| tag.is_any(classes![Filler]));
    };
    let lead = classes![Determiner Unlisted Quantifier Possessive];
    tags[at].is_unknown() && (before.is_value() || before.is_any(lead))
}

/// The word with those that it forms a compound with, and what it is.
fn named(tags: &[Tag<'_>], at: usize) -> UnknownWord {
    let mut last = at;
    let mut text = whole(&tags[at]);
    while last - at + 1 < COMPOUND_MAX
        && tags[last].is_unknown()
        && after(tags, last).is_some_and(Tag::is_unknown)
    {
        last += 1;
        text = format!("{text} {}", whole(&tags[last]));
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
    UnknownWord { text, role }
}

/// The words of a tag as far as it keeps them.
fn whole(tag: &Tag<'_>) -> String {
    if tag.word == tag.last { tag.word.to_owned() } else { format!("{} {}", tag.word, tag.last) }
}
