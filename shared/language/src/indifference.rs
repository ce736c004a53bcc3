//! "I don't care", "any cup will do": the user leaves the choice to the robot.

use crate::clauses::{Clause, Topic};
use crate::fates::{Fates, Polarity};
use crate::question_words::QuestionWords;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};
use crate::word_sets::WordSet;

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
            // "ducks I couldn't care less about" says so of them, unless it is an answer.
            let is_of_it = |next: &Tag<'_>| next.is_any(classes![Join Preposition]);
            let said = tags[at].is(Class::Indifferent)
                && (answers || !after(tags, at).is_some_and(is_of_it));
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
    let free =
        clause[at].is_any(classes![Quantifier Plain Head]) && WordSet::Any.has(clause[at].word);
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
    let said = tags[at + 1..].iter().position(Tag::pauses).map_or(tags.len(), |end| at + 1 + end);
    WordSet::Mattering.has(tags[at].last)
        || tags[at..said].iter().any(|tag| tag.is(Class::Attribute) || tag.word == "be")
}
