//! What a "not" denies: the word after it, the answer alone, or nothing.

use crate::clauses::Clause;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};

/// "isn't it the white one", "can't you get me …": a negation in form only.
pub(crate) fn is_rhetorical(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let opening = &tags[clause.span.start..at];
    let inverted = match opening {
        [.., question, verb] if question.is(Class::Question) => is_verb(verb),
        [leads @ .., verb] => {
            is_verb(verb) && leads.iter().all(|tag| tag.is_any(classes![Filler Courtesy But]))
        }
        [] => false,
    };
    inverted && after(tags, at).is_some_and(|next| next.is_any(classes![Second It First Pointer]))
}

fn is_verb(tag: &Tag<'_>) -> bool {
    tag.is_any(classes![Auxiliary Be])
}

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
    if tags[at].word == "forget" || before.iter().any(|tag| tag.is_unknown()) {
        return false;
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
