//! From answers in the order given to the one that counts.

use scene::Response;

use crate::asked::Asked;
use crate::clauses::Clause;
use crate::cue::{Cue, cues};
use crate::lexicon::{Sense, ValueSense};
use crate::marks::Mark;
use crate::tokens::Gap;

/// An answer to the question asked, or the lack of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    Yes,
    No,
    /// "I do not know": takes back what was answered before.
    Unsure,
}

/// Answers in order, each with its mark; a denial of what was asked about has none.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    given: Vec<(Answer, Option<usize>)>,
}

impl Answers {
    pub(crate) fn push(&mut self, answer: Answer, at: usize) {
        self.given.push((answer, Some(at)));
    }

    /// "not the white one", when white was asked about.
    pub(crate) fn push_denial(&mut self) {
        self.given.push((Answer::No, None));
    }

    pub(crate) fn clear(&mut self) {
        self.given.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// The answer that stands: the last one, unless it is tied to its opposite ("yes and no").
    fn standing(&self, marks: &[Mark<'_>]) -> Option<Answer> {
        let (last, at) = *self.given.last()?;
        if let [.., (before, Some(from)), _] = self.given[..]
            && let Some(to) = at
            && before != last
            && is_tied(marks.get(from + 1..to).unwrap_or_default())
        {
            return Some(Answer::Unsure);
        }
        Some(last)
    }
}

/// Only "and", "or" or "but" in between.
fn is_tied(between: &[Mark<'_>]) -> bool {
    let tie = |mark: &Mark<'_>| mark.is_any(cues![And Or But]) || mark.word == "sometimes";
    between.iter().any(tie)
        && between.iter().all(|mark| tie(mark) || mark.is_any(cues![Filler Plain]))
}

/// The answer that a mark gives by itself.
pub(crate) fn answer(marks: &[Mark<'_>], clause: &Clause, at: usize) -> Option<Answer> {
    let denied = at > clause.marks.start && marks[at - 1].is(Cue::Not);
    if denied {
        return None;
    }
    match marks[at].cue()? {
        Cue::Yes => Some(Answer::Yes),
        Cue::WeakYes if is_bare(marks, clause) => Some(Answer::Yes),
        Cue::WeakNo if is_bare(marks, clause) => Some(Answer::No),
        Cue::Likely if is_bare(marks, clause) => Some(Answer::Yes),
        Cue::Other if is_other_one(marks, clause, at) => Some(Answer::No),
        Cue::Be | Cue::Auxiliary if is_affirmed(marks, clause, at) => Some(Answer::Yes),
        _ => None,
    }
}

/// Nothing in the clause says more than an answer does.
fn is_bare(marks: &[Mark<'_>], clause: &Clause) -> bool {
    const BARE: &[Cue] = cues![
        Yes No WeakYes WeakNo Likely Hedge Filler Courtesy Plain And But Join First Second It
        Pointer Preposition Be Auxiliary Determiner Head Repair
    ];
    marks[clause.marks.clone()].iter().all(|mark| mark.is_any(BARE))
}

/// "the other one", as opposed to "the other white one".
fn is_other_one(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let before = marks[clause.marks.start..at].last();
    let after = marks[at + 1..clause.marks.end].first();
    let whole = after
        .is_none_or(|next| next.is_any(cues![Head Courtesy Filler No]) || next.gap >= Gap::Pause);
    let plain = marks[clause.marks.clone()]
        .iter()
        .all(|mark| !matches!(mark.sense, Sense::Unknown) && mark.value().is_none());
    whole && plain && !before.is_some_and(|before| before.is_any(cues![Quantifier AskBack]))
}

/// A sentence about what was asked that says no more than yes.
fn is_affirmed(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let about_it =
        marks[clause.marks.start..at].last().is_some_and(|mark| mark.is_any(cues![It Pointer]));
    let said = &marks[at + 1..clause.marks.end];
    about_it
        && (marks[at].is(Cue::Be) && (is_the_one(marks, clause, at) || is_what(said))
            || is_it(said))
}

/// "that's where it is", "that's what I've been looking for".
fn is_what(said: &[Mark<'_>]) -> bool {
    let [what, whose, rest @ ..] = said else { return false };
    const STRANGE: &[Cue] = cues![Not No Unsure Unlisted Third Other Ordinal];
    what.is(Cue::Question)
        && (whose.is_any(cues![It First Possessive]) || whose.word == "it")
        && rest.iter().all(|mark| mark.value().is_none() && !mark.is_any(STRANGE))
        && rest.iter().filter(|mark| mark.sense == Sense::Unknown).count() <= 1
}

/// "it is made of that", "it does have that".
fn is_it(said: &[Mark<'_>]) -> bool {
    let Some((last, rest)) = said.split_last() else { return false };
    last.is_any(cues![Pointer It])
        && rest
            .iter()
            .all(|mark| mark.is_any(cues![Plain Preposition Attribute Auxiliary Be Filler]))
}

/// "that is exactly the one I want", "it's the one".
fn is_the_one(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let said = &marks[at + 1..clause.marks.end];
    let plain = marks[clause.marks.clone()].iter().all(|mark| {
        mark.value().is_none()
            && mark.sense != Sense::Unknown
            && !mark.is_any(cues![Not Ordinal Unlisted Other Question])
    });
    let the_one = said.windows(2).any(|pair| pair[0].word == "the" && pair[1].is(Cue::Head));
    plain && the_one
}

/// The response to the question: the answer that stands, or what the values said imply.
pub(crate) fn response(
    answers: &Answers,
    marks: &[Mark<'_>],
    base: &[&ValueSense],
    asked: Asked<'_>,
    certain: bool,
) -> Response {
    if matches!(asked, Asked::Nothing) {
        return Response::None;
    }
    match answers.standing(marks) {
        Some(Answer::Yes) => Response::Yes,
        Some(Answer::No) => Response::No,
        Some(Answer::Unsure) => Response::None,
        None if certain => implied(base, asked),
        None => Response::None,
    }
}

/// "Is it white?" "The clear one." is a no, "The white one." a yes.
fn implied(base: &[&ValueSense], asked: Asked<'_>) -> Response {
    match asked {
        Asked::Value(attribute, word) => {
            let mut said = base.iter().filter(|value| value.attributes.contains(&attribute));
            match said.next() {
                None => Response::None,
                Some(first) if first.word == word => {
                    if said.all(|value| value.word == word) {
                        Response::Yes
                    } else {
                        Response::None
                    }
                }
                Some(_) if said.all(|value| value.word != word) => Response::No,
                Some(_) => Response::None,
            }
        }
        Asked::Object(words) if base.iter().any(|value| !words.contains(&value.word)) => {
            Response::No
        }
        Asked::Object(_) | Asked::Nothing | Asked::Attribute => Response::None,
    }
}
