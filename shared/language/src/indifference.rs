//! "I don't care", "any cup will do": the user leaves the choice to the robot.

use crate::clauses::{Clause, Topic};
use crate::fates::{Fates, Polarity};
use crate::question_words::QuestionWords;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};

/// Returns the tag that says so.
pub(crate) fn indifference(
    tags: &[Tag<'_>],
    clauses: &[Clause],
    fates: &Fates,
    asked: QuestionWords<'_>,
) -> Option<usize> {
    let answers = !asked.is_nothing();
    let on_topic = clauses.iter().filter(|clause| clause.topic == Topic::On);
    on_topic.flat_map(|clause| clause.span.clone().map(move |at| (clause, at))).find_map(
        |(clause, at)| {
            // "I don't care what colour" is about the question, if there is one.
            let said = tags[at].is(Class::Indifferent) && (answers || !wonders_after(tags, at));
            let is_any = is_any(&tags[clause.span.clone()], at - clause.span.start, answers);
            (said || is_any && !is_denied(tags, fates, at)).then_some(at)
        },
    )
}

/// "anything spotted is out of the question"
fn is_denied(tags: &[Tag<'_>], fates: &Fates, at: usize) -> bool {
    let ends = |tag: &Tag<'_>| tag.pauses() || tag.is_any(classes![Except But Not]);
    let mut phrase = (at + 1..tags.len()).take_while(|at| !ends(&tags[*at]));
    phrase.any(|at| fates.of(at) == Polarity::Denied)
}

/// "any", "any white one will do", "whichever", "give me either".
fn is_any(clause: &[Tag<'_>], at: usize, answers: bool) -> bool {
    const OTHERWISE: &[Class] = classes![Not No AskBack Story Cancel];
    const NOUN_PHRASE: &[Class] = classes![Head Preposition Determiner Possessive Attribute It];
    const AFTER: &[Class] = classes![
        Be Auxiliary Courtesy Filler Except WeakYes Plain First Second Indifferent But
    ];
    let free = clause[at].is_any(classes![Quantifier Plain Head])
        && matches!(clause[at].word, "any" | "either" | "whichever" | "whatever" | "anything");
    if !free || clause.iter().any(|tag| tag.is_any(OTHERWISE)) {
        return false;
    }
    let rest = &clause[at + 1..];
    let rest = &rest[..rest.iter().position(Tag::pauses).unwrap_or(rest.len())];
    let noun_phrase = rest
        .iter()
        .take_while(|tag| tag.is_value() || tag.is_any(NOUN_PHRASE) || tag.word == "old")
        .count();
    let (named, after) = rest.split_at(noun_phrase);
    // "either the red one or the blue one" is a choice of two.
    let two =
        clause[at].word == "either" && named.first().is_some_and(|tag| tag.is(Class::Determiner));
    // "any colour" says nothing of the rest, but answers a question for the colour.
    let of_attribute = named.iter().any(|tag| tag.is(Class::Attribute));
    !two && (answers || !of_attribute) && after.first().is_none_or(|tag| tag.is_any(AFTER))
}

/// Returns whether it is about the question ("it does not matter", "any colour"), and not of the
/// object ("I do not care", "either").
pub(crate) fn is_of_attribute(tags: &[Tag<'_>], at: usize) -> bool {
    const WORDS: &[&str] =
        &["matter", "difference", "important", "irrelevant", "immaterial", "odds"];
    let said = tags[at + 1..].iter().position(Tag::pauses).map_or(tags.len(), |end| at + 1 + end);
    WORDS.contains(&tags[at].last)
        || tags[at..said].iter().any(|tag| tag.is(Class::Attribute) || tag.word == "be")
}

/// "I don't care what colour", "it doesn't have to be white".
fn wonders_after(tags: &[Tag<'_>], at: usize) -> bool {
    let open = matches!(tags[at].word, "does" | "do" | "need" | "it" | "i" | "at");
    let ends = after(tags, at + 1).is_none_or(|tag| tag.is_any(classes![Courtesy Filler]));
    after(tags, at).is_some_and(|next| {
        // "I don't care which"
        next.is_any(classes![Join Preposition])
            || next.is(Class::Question) && !ends
            || open && (next.is_value() || next.is(Class::Determiner))
    })
}
