//! Which parts of an utterance are about the objects. A listener who knows the objects ignores
//! "red wine" and "the dishwasher is broken", and takes "the red one" and "in the dishwasher".

use std::ops::Range;

use crate::cue::{Cue, cues};
use crate::lexicon::{Lexicon, Sense};
use crate::marks::Mark;
use crate::tokens::Gap;
use crate::topic::Sketch;

/// What a clause is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Topic {
    /// The wanted object, or the dialogue itself.
    On,
    /// A question to the robot.
    AskBack,
    /// Anything else.
    Off,
}

/// A stretch of marks with one topic.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) marks: Range<usize>,
    pub(crate) topic: Topic,
    /// Names something to fetch, even something that the scene does not have.
    pub(crate) requests: bool,
    /// Values that describe something else.
    pub(crate) aside: Vec<usize>,
}

impl Clause {
    /// Whether the value at this mark describes the wanted object.
    pub(crate) fn counts(&self, at: usize) -> bool {
        self.topic == Topic::On && !self.aside.contains(&at)
    }
}

/// Longest clause that is judged as one, so that the work stays linear in the utterance.
const CLAUSE_MARKS_MAX: usize = 64;

/// Splits an utterance and finds the topic of each part. `code` marks a text that no person says.
pub(crate) fn clauses(lexicon: &Lexicon, marks: &[Mark<'_>], code: bool) -> Vec<Clause> {
    let injected = code || marks.iter().any(|mark| mark.is(Cue::Injection));
    let mut clauses: Vec<Clause> = Vec::new();
    let mut start = 0;
    for at in 1..=marks.len() {
        if at == marks.len() || at - start == CLAUSE_MARKS_MAX || starts_clause(marks, at) {
            let sketch = Sketch::of(lexicon, marks, start..at);
            clauses.push(sketch.judge(clauses.last(), injected));
            start = at;
        }
    }
    clauses
}

fn starts_clause(marks: &[Mark<'_>], at: usize) -> bool {
    const SUBJECTS: &[Cue] = cues![
        First Second Third Possessive It Fetch Want Put Story Question Auxiliary Stop Cancel
        AskBack StartOver Repeat Join When Aside Injection Yes No
    ];
    let mark = &marks[at];
    let before = &marks[at - 1];
    let next = marks.get(at + 1);
    match mark.cue() {
        _ if mark.gap >= Gap::Pause => true,
        Some(Cue::Join) => !before.is(Cue::Not),
        Some(Cue::But) => true,
        Some(Cue::And) => {
            next.is_some_and(|next| next.is_any(SUBJECTS) || next.sense == Sense::Unknown)
        }
        // "yes my hands are full", "no get me the red one"
        Some(Cue::First | Cue::Fetch | Cue::Want | Cue::Possessive | Cue::It) => {
            before.is_any(cues![
                Yes No WeakYes WeakNo Repair Withdraw
            ])
        }
        _ => false,
    }
}
