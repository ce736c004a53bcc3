//! References to objects by earlier mention, by position or by comparison: "the other one", "the
//! smaller one", "the same again".

use scene::{Reference, WordId};

use crate::clauses::{Clause, Topic};
use crate::negation::is_denied;
use crate::question_words::QuestionWords;
use crate::related::Related;
use crate::tagger::{Tag, after, before};
use crate::token_class::{Class, classes};

/// Returns the last reference of an utterance, and the words of each object that it is to; a
/// relation is preferred to the others.
pub(crate) fn reference(
    tags: &[Tag<'_>],
    clauses: &[Clause],
    asked: QuestionWords<'_>,
    mut related: Vec<Related>,
) -> (Reference, Vec<Vec<WordId>>) {
    if let Some(Related { relation, to, .. }) = related.pop() {
        return (Reference::Relation(relation), to);
    }
    (spoken_of(tags, clauses, asked), Vec::new())
}

fn spoken_of(tags: &[Tag<'_>], clauses: &[Clause], asked: QuestionWords<'_>) -> Reference {
    // "again!"
    let bare = |tag: &Tag<'_>| tag.word == "again" || tag.is_any(classes![Filler Courtesy]);
    if asked.is_nothing() && tags.iter().any(|tag| tag.word == "again") && tags.iter().all(bare) {
        return Reference::Same;
    }
    let again = tags.iter().any(|tag| tag.is_any(classes![Huh Repeat]) && tag.word == "again");
    let new = asked.is_nothing() || again;
    let spoken = clauses.iter().filter(|clause| clause.topic != Topic::Off);
    let all = spoken.flat_map(|clause| clause.span.clone()).map(|at| refers(tags, at, new));
    all.fold(Reference::None, |before, next| match (before, next) {
        (before, Reference::None) => before,
        (Reference::None | Reference::Other, next) => next,
        (before, Reference::Other) => before,
        (_, next) => next,
    })
}

/// Returns the reference of the tag. `new`: not an answer, so that "same one" is not a yes.
fn refers(tags: &[Tag<'_>], at: usize, new: bool) -> Reference {
    let tag = &tags[at];
    if is_denied(tags, at) {
        return Reference::None;
    }
    match tag.word {
        "other" | "different" | "another" | "next" if is_another(tags, at) => Reference::Other,
        // "try another one", "a different one", "some other one"
        "a" | "some" | "try" | "next" if tag.is(Class::No) => Reference::Other,
        "same" if tag.is_any(classes![Plain Yes]) && new && is_whole(tags, at) => Reference::Same,
        _ => Reference::None,
    }
}

/// "the other", "another mug", but not "another place" and "the other purple one".
fn is_another(tags: &[Tag<'_>], at: usize) -> bool {
    let one_word = tags[at].is_any(classes![Other Ordinal]) && tags[at].word == tags[at].last;
    let many = before(tags, at).is_some_and(|before| before.is(Class::Quantifier));
    one_word && !many && is_whole(tags, at)
}

/// Returns whether a noun phrase of the scene's things, or nothing, follows.
fn is_whole(tags: &[Tag<'_>], at: usize) -> bool {
    const AFTER: &[Class] =
        classes![Head Courtesy Filler Huh Repeat No Plain Preposition When Be And But];
    after(tags, at).is_none_or(|next| next.is_value() || next.is_any(AFTER))
}
