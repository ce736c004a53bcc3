//! Parts of an utterance that are about the objects. A listener who knows the objects ignores "red
//! wine" and "the dishwasher is broken", and takes "the red one" and "in the dishwasher".

use std::ops::Range;

use crate::fates::Fates;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::classify;

/// Topic of a clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Topic {
    /// The wanted object, or the dialogue itself.
    On,
    /// A question to the robot.
    AskBack,
    /// Anything else.
    Off,
}

/// A stretch of tags with one topic.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) span: Range<usize>,
    pub(crate) topic: Topic,
    /// Names something to fetch, even something that the scene does not have.
    pub(crate) requests: bool,
    /// Orders something else than to fetch.
    pub(crate) chore: bool,
}

/// Longest clause that is judged as one, so that the work stays linear in the utterance.
const CLAUSE_MARKS_MAX: usize = 64;

/// Splits an utterance and finds the topic of each part. `code` tags a text that no person says.
pub(crate) fn clauses(tags: &[Tag<'_>], fates: &Fates, code: bool) -> Vec<Clause> {
    let injected = code || tags.iter().any(|tag| tag.is(Class::Injection));
    let mut clauses: Vec<Clause> = Vec::new();
    let mut start = 0;
    for at in 1..=tags.len() {
        if at == tags.len() || at - start == CLAUSE_MARKS_MAX || starts_clause(tags, at) {
            clauses.push(classify(tags, fates, start..at, clauses.last(), injected));
            start = at;
        }
    }
    clauses
}

fn starts_clause(tags: &[Tag<'_>], at: usize) -> bool {
    const SUBJECTS: &[Class] = classes![
        First Second Third Possessive It Fetch Want Put Story Question Auxiliary Stop Cancel
        AskBack AskStatus AskHelp PutBack StartOver Repeat Join When SideTalk Injection Yes No
    ];
    let tag = &tags[at];
    let before = &tags[at - 1];
    let next = tags.get(at + 1);
    match tag.class() {
        _ if tag.pauses() => true,
        Some(Class::Join) => !before.is(Class::Not),
        Some(Class::But) => true,
        Some(Class::And) => next.is_some_and(|next| next.is_any(SUBJECTS) || next.is_unknown()),
        // "yes my hands are full", "no get me the red one", "forget it I found one"
        Some(Class::First | Class::Fetch | Class::Want | Class::Possessive | Class::It) => {
            before.is_any(classes![Yes No WeakYes WeakNo Repair Withdraw])
                || before.is(Class::Cancel) && before.word != "not"
        }
        _ => false,
    }
}
