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
    if is_not_what(tags, clause, at) || is_not_by_far(tags, clause, at) || begins_anew(tags, at) {
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

/// "it isn't it is in the cabinet", "it isn't get me the clear one": the comma after the "not" is
/// not heard.
fn begins_anew(tags: &[Tag<'_>], at: usize) -> bool {
    let [next, then, ..] = &tags[at + 1..] else { return false };
    // "don't get me the clear one" negates the words after it.
    let is_ended = at > 0 && tags[at - 1].is(Class::Be);
    let states = is_verb(then) && (next.is(Class::It) || is_ended && next.is(Class::Pointer));
    let wants = next.is(Class::Fetch) || next.is(Class::First) && then.is(Class::Want);
    !next.pauses() && (states || is_ended && wants)
}

/// "not what I'm after", "that's not where it is".
fn is_not_what(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let [what, whose, ..] = &tags[at + 1..clause.span.end] else { return false };
    let ours = whose.is_any(classes![First It Possessive]) || whose.word == "it";
    what.is(Class::Question) && ours && denies_no_value(tags, clause, at)
}

/// "not by a mile", "not in a hundred years": how little it is so, and nothing else.
fn is_not_by_far(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let opens = tags[clause.span.start..at]
        .iter()
        .all(|tag| tag.is_any(classes![Filler Courtesy No Yes WeakNo]));
    let next = tags[at + 1..clause.span.end].first();
    opens
        && next.is_some_and(|next| next.is(Class::Preposition) && !next.pauses())
        && denies_no_value(tags, clause, at)
}

/// Nothing after the negation describes an object, not even one that the scene lacks.
fn denies_no_value(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    (at + 1..clause.span.end).all(|at| {
        let describes = tags[at].is_value() && clause.counts(at);
        !describes && !tags[at].is_any(classes![Unlisted Head Fetch])
    })
}
