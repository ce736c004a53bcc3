//! Objects that are pointed to by what was spoken of: "the other one", "the smaller one", "the same
//! again".

use scene::Reference;

use crate::clauses::{Clause, Topic};
use crate::question_words::QuestionWords;
use crate::tagger::{Tag, after, before};
use crate::token_class::{Class, classes};

/// Returns the last reference of an utterance; one by size is preferred to "other".
pub(crate) fn reference(
    tags: &[Tag<'_>],
    clauses: &[Clause],
    asked: QuestionWords<'_>,
) -> Reference {
    // "again!"
    let bare = |tag: &Tag<'_>| tag.word == "again" || tag.is_any(classes![Filler Courtesy]);
    if matches!(asked, QuestionWords::Nothing)
        && tags.iter().any(|tag| tag.word == "again")
        && tags.iter().all(bare)
    {
        return Reference::Same;
    }
    let again = tags.iter().any(|tag| tag.is_any(classes![Huh Repeat]) && tag.word == "again");
    let new = matches!(asked, QuestionWords::Nothing) || again;
    let spoken = clauses.iter().filter(|clause| clause.topic != Topic::Off);
    let all = spoken.flat_map(|clause| clause.span.clone()).map(|at| refers(tags, at, new));
    all.fold(Reference::None, |before, next| match (before, next) {
        (before, Reference::None) => before,
        (Reference::None | Reference::Other, next) => next,
        (before, Reference::Other) => before,
        (_, next) => next,
    })
}

/// What the tag refers to. `new`: no answer to a question, so that "same one" is not a yes.
fn refers(tags: &[Tag<'_>], at: usize, new: bool) -> Reference {
    let tag = &tags[at];
    if is_denied(tags, at) {
        return Reference::None;
    }
    let size = too_much(tags, at).unwrap_or(by_size(tag.word));
    if size != Reference::None {
        let relative = matches!(size, Reference::Smaller | Reference::Larger);
        return if relative && is_compared(tags, at) { Reference::None } else { size };
    }
    match tag.word {
        "other" | "different" | "another" | "next" if is_another(tags, at) => Reference::Other,
        // "try another one", "a different one", "some other one"
        "a" | "some" | "try" | "next" if tag.is(Class::No) => Reference::Other,
        "same" if tag.is_any(classes![Plain Yes]) && new && is_whole(tags, at) => Reference::Same,
        _ => Reference::None,
    }
}

/// "too big": a smaller one is wanted.
pub(crate) fn too_much(tags: &[Tag<'_>], at: usize) -> Option<Reference> {
    let is_too = before(tags, at).is_some_and(|before| before.last == "too");
    let is_noun = after(tags, at).is_some_and(|next| next.is(Class::Head) || next.is_value());
    match tags[at].word {
        _ if !is_too || is_noun => None,
        "big" | "large" | "huge" | "long" | "tall" | "thick" | "wide" => Some(Reference::Smaller),
        "small" | "little" | "tiny" | "short" | "thin" | "narrow" => Some(Reference::Larger),
        _ => None,
    }
}

/// What a comparative or superlative of size refers to.
pub(crate) fn by_size(word: &str) -> Reference {
    match word {
        "smaller" | "littler" | "tinier" | "shorter" => Reference::Smaller,
        "bigger" | "larger" | "longer" | "taller" => Reference::Larger,
        "smallest" | "littlest" | "tiniest" | "shortest" => Reference::Smallest,
        "biggest" | "largest" | "longest" | "tallest" => Reference::Largest,
        _ => Reference::None,
    }
}

/// "not the smaller one".
fn is_denied(tags: &[Tag<'_>], at: usize) -> bool {
    let mut lead = tags[..at].iter().rev().take_while(|tag| tag.is_any(classes![Determiner Not]));
    !tags[at].pauses() && lead.any(|tag| tag.is(Class::Not))
}

/// "bigger than the red one": compared with what is named, not with what was spoken of.
fn is_compared(tags: &[Tag<'_>], at: usize) -> bool {
    let named = |tag: &Tag<'_>| !tag.is_any(classes![It Pointer]);
    after(tags, at).is_some_and(|tag| tag.is(Class::Than)) && tags.get(at + 2).is_none_or(named)
}

/// "the other", "another mug", but not "another place" and "the other purple one".
fn is_another(tags: &[Tag<'_>], at: usize) -> bool {
    let one_word = tags[at].is_any(classes![Other Ordinal]) && tags[at].word == tags[at].last;
    let many = before(tags, at).is_some_and(|before| before.is(Class::Quantifier));
    one_word && !many && is_whole(tags, at)
}

/// What follows is a noun phrase of the scene's things, or nothing.
fn is_whole(tags: &[Tag<'_>], at: usize) -> bool {
    const AFTER: &[Class] =
        classes![Head Courtesy Filler Huh Repeat No Plain Preposition When Be And But];
    after(tags, at).is_none_or(|next| next.is_value() || next.is_any(AFTER))
}
