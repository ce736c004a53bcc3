//! What a "not" denies: the word after it, the answer alone, or nothing.

use crate::clauses::Clause;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::word_sets::WordSet;

/// "not the smaller one": what the word says is not so.
pub(crate) fn is_denied(tags: &[Tag<'_>], at: usize) -> bool {
    let mut lead = tags[..at].iter().rev().take_while(|tag| tag.is_any(classes![Determiner Not]));
    !tags[at].pauses() && lead.any(|tag| tag.is(Class::Not))
}

/// "not that one", "it is not", "not right": nothing but the answer itself is denied.
pub(crate) fn is_whole_answer(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    const LINKS: &[Class] = classes![
        Determiner Pointer Be Plain Filler Courtesy Want Auxiliary Possessive
    ];
    // "nice weather, isn't it" is not about the question.
    let before = &tags[clause.span.start..at];
    if WordSet::Forget.has(tags[at].word) || before.iter().any(|tag| tag.is_unknown()) {
        return false;
    }
    if is_not_what(&tags[at + 1..clause.span.end]) {
        return true;
    }
    let mut rest = tags[at + 1..].iter().peekable();
    while rest.next_if(|tag| !tag.pauses() && tag.is_any(LINKS)).is_some() {}
    let head =
        rest.next_if(|tag| !tag.pauses() && tag.is_any(classes![Head It Yes WeakYes Likely]));
    while rest.next_if(|tag| !tag.pauses() && tag.is_any(classes![Plain Courtesy])).is_some() {}
    match rest.next() {
        None => true,
        Some(next) if next.pauses() => true,
        Some(next) if head.is_some() => next.is_any(classes![
            Determiner First Fetch Want It And But Join No Repair Filler Not Story
        ]),
        Some(next) => next.is_any(classes![No Yes Repair But Hedge]),
    }
}

/// "not what I'm after", "that's not where it is".
fn is_not_what(tags: &[Tag<'_>]) -> bool {
    let [what, whose, ..] = tags else { return false };
    let ours = whose.is_any(classes![First It Possessive]) || WordSet::It.has(whose.word);
    what.is(Class::Question) && ours
}
