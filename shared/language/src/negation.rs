//! What a "no" or "not" is good for: an answer, a repair, a determiner, or nothing.

use crate::asked::Asked;
use crate::clauses::Clause;
use crate::cue::{Cue, cues};
use crate::lexicon::{Lexicon, Sense};
use crate::marks::Mark;
use crate::meaning::{Said, rivals};
use crate::tokens::Gap;

/// What a "no" does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoUse {
    /// "no, the clear one".
    Answer,
    /// "the red, no, the blue one".
    Repair,
    /// "with no metal".
    Determiner,
}

/// Tells the uses of "no" apart by what has been said and what follows.
pub(crate) fn use_of_no(
    lexicon: &Lexicon,
    marks: &[Mark<'_>],
    at: usize,
    base: &[Said<'_>],
    asked: Asked<'_>,
) -> NoUse {
    const GOVERNORS: &[Cue] = cues![Preposition Be Want Fetch Auxiliary];
    let governed = at > 0 && marks[at].gap <= Gap::None && marks[at - 1].is_any(GOVERNORS);
    let next = marks.get(at + 1).filter(|next| next.gap <= Gap::None);
    let value = next.and_then(|next| next.value()).map(|value| lexicon.value(value));
    if let Some(value) = value.filter(|_| marks[at].word == "no") {
        if governed {
            return NoUse::Determiner;
        }
        if base.is_empty() {
            let asked_about = match asked {
                Asked::Value(_, word) => word == value.word,
                Asked::Object(words) => words.contains(&value.word),
                Asked::Nothing | Asked::Attribute => true,
            };
            return if asked_about { NoUse::Determiner } else { NoUse::Answer };
        }
        if !base.iter().any(|before| rivals(before, value)) {
            return NoUse::Determiner;
        }
    }
    if !base.is_empty() && leads_to_value(&marks[at + 1..]) { NoUse::Repair } else { NoUse::Answer }
}

/// Whether a value is asserted soon, before the sentence ends or turns.
fn leads_to_value(marks: &[Mark<'_>]) -> bool {
    const REACH: usize = 10;
    for (n, mark) in marks.iter().take(REACH).enumerate() {
        if mark.value().is_some() {
            return true;
        }
        if mark.is_any(cues![Not Except]) || n > 0 && mark.gap == Gap::Stop {
            return false;
        }
    }
    false
}

/// "isn't it the white one", "can't you get me …": a negation in form only.
pub(crate) fn is_rhetorical(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let opening = &marks[clause.marks.start..at];
    let inverted = match opening {
        [.., question, verb] if question.is(Cue::Question) => is_verb(verb),
        [leads @ .., verb] => {
            is_verb(verb) && leads.iter().all(|mark| mark.is_any(cues![Filler Courtesy But]))
        }
        [] => false,
    };
    inverted
        && marks.get(at + 1).is_some_and(|next| {
            next.gap <= Gap::None && next.is_any(cues![Second It First Pointer])
        })
}

fn is_verb(mark: &Mark<'_>) -> bool {
    mark.is_any(cues![Auxiliary Be])
}

/// "not that one", "it is not", "not right": nothing but the answer itself is denied.
pub(crate) fn is_whole_answer(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    const LINKS: &[Cue] = cues![
        Determiner Pointer Be Plain Filler Courtesy Want Auxiliary Possessive
    ];
    // "nice weather, isn't it" is not about the question.
    let before = &marks[clause.marks.start..at];
    if marks[at].word == "forget" || before.iter().any(|mark| mark.sense == Sense::Unknown) {
        return false;
    }
    if is_not_what(marks, clause, at) || is_not_by_far(marks, clause, at) {
        return true;
    }
    let mut rest = marks[at + 1..].iter().peekable();
    while rest.next_if(|mark| mark.gap < Gap::Pause && mark.is_any(LINKS)).is_some() {}
    let head = rest.next_if(|mark| {
        let heads = [Cue::Head, Cue::It, Cue::Yes, Cue::WeakYes, Cue::Likely];
        mark.gap < Gap::Pause && mark.is_any(&heads)
    });
    while rest.next_if(|mark| mark.gap < Gap::Pause && mark.is_any(cues![Plain Courtesy])).is_some()
    {
    }
    match rest.next() {
        None => true,
        Some(next) if next.gap >= Gap::Pause => true,
        Some(next) if head.is_some() => next.is_any(cues![
            Determiner First Fetch Want It And But Join No Repair Filler Not Story
        ]),
        Some(next) => next.is_any(cues![No Yes Repair But Hedge]),
    }
}

/// "not what I'm after", "that's not where it is".
fn is_not_what(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let [what, whose, ..] = &marks[at + 1..clause.marks.end] else { return false };
    let ours = whose.is_any(cues![First It Possessive]) || whose.word == "it";
    what.is(Cue::Question) && ours && denies_no_value(marks, clause, at)
}

/// "not by a mile", "not in a hundred years": how little it is so, and nothing else.
fn is_not_by_far(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let opens = marks[clause.marks.start..at]
        .iter()
        .all(|mark| mark.is_any(cues![Filler Courtesy No Yes WeakNo]));
    let next = marks[at + 1..clause.marks.end].first();
    opens
        && next.is_some_and(|next| next.is(Cue::Preposition) && next.gap <= Gap::None)
        && denies_no_value(marks, clause, at)
}

/// Nothing after the negation describes an object, not even one that the scene lacks.
fn denies_no_value(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    (at + 1..clause.marks.end).all(|at| {
        let describes = marks[at].value().is_some() && clause.counts(at);
        !describes && !marks[at].is_any(cues![Unlisted Head Fetch])
    })
}
