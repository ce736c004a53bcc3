//! From answers in the order given to the one that counts.

use scene::Response;

use crate::asked::Asked;
use crate::clauses::Clause;
use crate::cue::{Cue, cues};
use crate::lexicon::Sense;
use crate::marks::Mark;
use crate::meaning::{Meaning, Said};
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
    given: Vec<Given>,
}

/// One answer.
#[derive(Clone, Copy, Debug)]
struct Given {
    answer: Answer,
    /// Its mark.
    at: Option<usize>,
    /// Probability that it was not given.
    doubt: f64,
}

impl Answers {
    pub(crate) fn push(&mut self, answer: Answer, marks: &[Mark<'_>], at: usize) {
        self.given.push(Given { answer, at: Some(at), doubt: marks[at].answer_doubt() });
    }

    /// "not the white one", when white was asked about.
    pub(crate) fn push_denial(&mut self, doubt: f64) {
        self.given.push(Given { answer: Answer::No, at: None, doubt });
    }

    pub(crate) fn clear(&mut self) {
        self.given.clear();
    }

    /// Whether the last answer is a no.
    pub(crate) fn denies(&self) -> bool {
        self.given.last().is_some_and(|given| given.answer == Answer::No)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// The answer that stands: the last one, unless it is tied to its opposite ("yes and no"); and
    /// its doubt. An answer that was given twice is doubted as the surer one is.
    fn standing(&self, marks: &[Mark<'_>]) -> Option<(Answer, f64)> {
        let last = *self.given.last()?;
        if let [.., before, _] = self.given[..]
            && let (Some(from), Some(to)) = (before.at, last.at)
            && before.answer != last.answer
            && (is_tied(marks.get(from + 1..to).unwrap_or_default()) || is_doubled(marks, from, to))
        {
            return Some((Answer::Unsure, 0.0));
        }
        let again = self.given.iter().rev().take_while(|given| given.answer == last.answer);
        Some((last.answer, again.map(|given| given.doubt).fold(1.0, f64::min)))
    }
}

/// Only "and", "or" or "but" in between.
fn is_tied(between: &[Mark<'_>]) -> bool {
    let tie = |mark: &Mark<'_>| mark.is_any(cues![And Or But]);
    between.iter().any(tie)
        && between.iter().all(|mark| tie(mark) || mark.is_any(cues![Filler Plain]))
}

/// "sometimes yes, sometimes no", "could be yes, could be no".
fn is_doubled(marks: &[Mark<'_>], from: usize, to: usize) -> bool {
    let lead = |at: usize| at.checked_sub(1).and_then(|before| marks.get(before));
    let (Some(first), Some(second)) = (lead(from), lead(to)) else { return false };
    first.word == second.word && !second.is_any(cues![Yes No Repair Filler])
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
        Cue::WeakYes if is_judged(marks, clause, at) => Some(Answer::Yes),
        Cue::WeakNo if is_judged(marks, clause, at) => Some(Answer::No),
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
    let whole = after.is_none_or(|next| {
        next.is_any(cues![Head Attribute Courtesy Filler No Be]) || next.gap >= Gap::Pause
    });
    let plain = marks[clause.marks.clone()]
        .iter()
        .all(|mark| !matches!(mark.sense, Sense::Unknown) && mark.value().is_none());
    whole && plain && !before.is_some_and(|before| before.is_any(cues![Quantifier AskBack]))
}

/// "drawer is right", "white would be wrong".
fn is_judged(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let before = &marks[clause.marks.start..at];
    let plain = |mark: &Mark<'_>| {
        mark.value().is_some() || mark.is_any(cues![Determiner Head Filler Yes No Preposition])
    };
    matches!(before, [said @ .., be]
        if be.is(Cue::Be) && said.iter().all(plain) && said.iter().any(|mark| mark.value().is_some()))
        && at + 1 == clause.marks.end
}

/// A sentence about what was asked that says no more than yes.
fn is_affirmed(marks: &[Mark<'_>], clause: &Clause, at: usize) -> bool {
    let before = &marks[clause.marks.start..at];
    let subject = before.iter().rev().find(|mark| !mark.is(Cue::Plain));
    let said = &marks[at + 1..clause.marks.end];
    if said.is_empty() {
        // "it very much is", but not "if it is"
        const OPEN: &[Cue] = cues![Question Join Unsure Not Unlisted Ordinal AskBack];
        let plain = |mark: &Mark<'_>| {
            mark.sense != Sense::Unknown && mark.value().is_none() && !mark.is_any(OPEN)
        };
        return subject.is_some_and(|mark| mark.is(Cue::It)) && before.iter().all(plain);
    }
    let about_it = before.last().is_some_and(|mark| mark.is_any(cues![It Pointer]));
    let is = marks[at].is(Cue::Be);
    about_it && (is && (is_the_one(marks, clause, at) || is_what(said)) || is_it(said))
}

/// "that's where it is", "that's what I've been looking for".
fn is_what(said: &[Mark<'_>]) -> bool {
    let [what, whose, rest @ ..] = said else { return false };
    const STRANGE: &[Cue] = cues![Not No Unsure Unlisted Third Other Ordinal];
    // "what is in it" is a phrase
    let phrase = what.is(Cue::AskBack) && what.word == "what";
    (what.is(Cue::Question) || phrase)
        && (whose.is_any(cues![It First Possessive Be]) || whose.word == "it")
        && rest.iter().all(|mark| mark.value().is_none() && !mark.is_any(STRANGE))
        && rest.iter().filter(|mark| mark.sense == Sense::Unknown).count() <= 1
}

/// "it is made of that", "it does have that", "it's in there", "it is one".
fn is_it(said: &[Mark<'_>]) -> bool {
    let Some((last, rest)) = said.split_last() else { return false };
    let place = matches!(last.word, "in" | "there" | "here" | "up" | "down" | "over" | "right");
    let shown =
        last.is_any(cues![Pointer It]) || last.is(Cue::Plain) && (place || last.word == "one");
    shown
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
    let the_one = said.windows(2).any(|pair| {
        (pair[0].word == "the" || pair[0].is(Cue::Possessive)) && pair[1].is(Cue::Head)
    });
    plain && the_one
}

/// The response to the question: the answer that stands, or what the values said imply; and the
/// probability that it was not given.
pub(crate) fn response(
    meaning: &Meaning<'_>,
    marks: &[Mark<'_>],
    asked: Asked<'_>,
) -> (Response, f64) {
    if matches!(asked, Asked::Nothing) {
        return (Response::None, 0.0);
    }
    let certain = !meaning.hedged && !meaning.alternatives;
    match meaning.answers.standing(marks) {
        Some((Answer::Yes, doubt)) => (Response::Yes, doubt),
        Some((Answer::No, doubt)) => (Response::No, doubt),
        None if certain => implied(&meaning.base, asked),
        Some((Answer::Unsure, _)) | None => (Response::None, 0.0),
    }
}

/// "Is it white?" "The clear one." is a no, "The white one." a yes. It is as doubtful as the
/// surest of the values that imply it.
fn implied(base: &[Said<'_>], asked: Asked<'_>) -> (Response, f64) {
    let (response, implies): (Response, Vec<&Said<'_>>) = match asked {
        Asked::Value(attribute, word) => {
            let said = base.iter().filter(|value| value.attributes.contains(&attribute));
            let said: Vec<&Said<'_>> = said.collect();
            let agreeing = said.iter().filter(|value| value.word == word).count();
            match (agreeing, said.len()) {
                (0, 1..) => (Response::No, said),
                (agreeing, all) if all > 0 && agreeing == all => (Response::Yes, said),
                _ => (Response::None, Vec::new()),
            }
        }
        Asked::Object(words) => {
            let other = base.iter().filter(|value| !words.contains(&value.word));
            let other: Vec<&Said<'_>> = other.collect();
            (if other.is_empty() { Response::None } else { Response::No }, other)
        }
        Asked::Nothing | Asked::Attribute => (Response::None, Vec::new()),
    };
    (response, implies.iter().map(|value| value.doubt).reduce(f64::min).unwrap_or(0.0))
}
