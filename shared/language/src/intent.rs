//! What the person wants with an utterance.

use scene::Intent;

use crate::clauses::{Clause, Topic};
use crate::cue::{Cue, cues};
use crate::lexicon::Sense;
use crate::marks::Mark;
use crate::meaning::Meaning;
use crate::tokens::Gap;

/// The intent of an utterance whose meaning is known.
///
/// In text that no person says (`code`) only the opening counts as a command.
pub(crate) fn intent(
    marks: &[Mark<'_>],
    clauses: &[Clause],
    meaning: &Meaning<'_>,
    code: bool,
) -> Intent {
    let says_nothing = meaning.base.is_empty() && meaning.excluded.is_empty();
    let spoken = if code { clauses.len().min(1) } else { clauses.len() };
    let commands = |cue| clauses[..spoken].iter().any(|clause| commands(marks, clause, cue));
    if commands(Cue::Stop) || is_only_wait(marks) {
        Intent::Stop
    } else if commands(Cue::StartOver) {
        Intent::StartOver
    } else if says_nothing
        && (commands(Cue::Cancel)
            || commands(Cue::Withdraw)
            || meaning.answers.is_empty() && clauses.iter().any(|clause| declines(marks, clause)))
    {
        Intent::Cancel
    } else if says_nothing && (commands(Cue::Repeat) || is_only_huh(marks)) {
        Intent::Repeat
    } else if says_nothing && clauses.iter().any(|clause| clause.topic == Topic::AskBack) {
        Intent::AskBack
    } else if !says_nothing || informs(marks, clauses, meaning) {
        Intent::Inform
    } else {
        Intent::None
    }
}

/// Whether the clause gives this command to the robot: nothing strange is said beside it, and it
/// is not negated.
pub(crate) fn commands(marks: &[Mark<'_>], clause: &Clause, cue: Cue) -> bool {
    let range = clause.marks.clone();
    let Some(at) = range.clone().find(|&at| marks[at].is(cue)) else { return false };
    if at > range.start && marks[at - 1].is(Cue::Not) {
        return false;
    }
    let plain = marks[range.clone()].iter().all(|mark| mark.sense != Sense::Unknown);
    let leads = [
        Cue::Filler,
        Cue::Courtesy,
        Cue::No,
        Cue::Yes,
        Cue::Repair,
        Cue::WeakYes,
        Cue::And,
        Cue::But,
        Cue::Join,
        Cue::Plain,
    ];
    let opens = marks[range.start..at].iter().all(|mark| mark.is_any(&leads));
    match cue {
        // Better to stop once too often.
        Cue::Stop => {
            let next = marks[at + 1..range.end].first();
            let joined =
                next.is_some_and(|next| next.sense == Sense::Unknown || next.is(Cue::Preposition));
            opens && !joined || plain && clause.topic == Topic::On
        }
        _ => plain && clause.topic != Topic::Off,
    }
}

/// "I don't want a bowl any more", "forget about the bowl": what is declined is any of them.
fn declines(marks: &[Mark<'_>], clause: &Clause) -> bool {
    let marks = &marks[clause.marks.clone()];
    let denies = marks.iter().any(|mark| mark.is(Cue::Not));
    let fetches = marks.iter().any(|mark| mark.is_any(cues![Fetch Want]) || mark.word == "forget");
    let noun = marks.iter().any(|mark| mark.is(Cue::Head) && !mark.word.starts_with("one"));
    let told = marks.iter().all(|mark| {
        mark.sense != Sense::Unknown
            && !mark.is_any(cues![Pointer Other Unlisted Ordinal Attribute Preposition Landmark])
    });
    clause.topic == Topic::On && denies && fetches && noun && told
}

/// "wait", and nothing else.
fn is_only_wait(marks: &[Mark<'_>]) -> bool {
    let wait = |mark: &Mark<'_>| mark.is(Cue::Repair) && mark.word == "wait";
    marks.iter().any(wait)
        && marks.iter().all(|mark| wait(mark) || mark.is_any(cues![Filler Courtesy]))
}

/// "what", "sorry", "huh", and nothing else.
fn is_only_huh(marks: &[Mark<'_>]) -> bool {
    let huh = |mark: &Mark<'_>| {
        mark.is(Cue::Huh)
            || mark.is(Cue::Question) && mark.word == "what"
            || mark.is(Cue::Repair) && matches!(mark.word, "sorry" | "pardon" | "excuse" | "i")
    };
    marks.iter().any(huh)
        && marks.iter().all(|mark| huh(mark) || mark.is_any(cues![Filler Courtesy It Be]))
}

/// Whether anything was said that is meant for the robot.
fn informs(marks: &[Mark<'_>], clauses: &[Clause], meaning: &Meaning<'_>) -> bool {
    const REPLIES: &[Cue] = cues![Yes No Unsure Hedge Likely Indifferent Reply];
    !meaning.answers.is_empty()
        || clauses.iter().filter(|clause| clause.topic == Topic::On).any(|clause| {
            clause.requests || marks[clause.marks.clone()].iter().any(|mark| mark.is_any(REPLIES))
        })
}

/// "no, I was talking to my wife", "yes I'll have it done by Friday": an answer, but not to the
/// robot.
pub(crate) fn is_side_talk(marks: &[Mark<'_>], clauses: &[Clause]) -> bool {
    let plans = |clause: &Clause| {
        let marks = &marks[clause.marks.clone()];
        let speaker = marks.first().is_some_and(|mark| matches!(mark.word, "i" | "we"));
        let will = |mark: &Mark<'_>| mark.word == "will" || mark.is(Cue::Want);
        speaker && marks.iter().any(will) && marks.iter().any(|mark| mark.is(Cue::When))
    };
    let aside = marks.iter().any(|mark| mark.is(Cue::Aside)) || clauses.iter().any(plans);
    aside && !clauses.iter().any(|clause| clause.requests)
}

/// Attribute and object words that the scene does not have, for the robot's reply.
pub(crate) fn unknown_words(marks: &[Mark<'_>], clauses: &[Clause]) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for clause in clauses.iter().filter(|clause| clause.topic != Topic::Off) {
        for at in clause.marks.clone() {
            let mark = &marks[at];
            let new = mark.is(Cue::Unlisted) || clause.requests && is_in_noun_phrase(marks, at);
            if new && !words.iter().any(|word| word == mark.word) {
                words.push(mark.word.to_owned());
            }
        }
    }
    words
}

/// An unknown word where a value or noun belongs: "the purpure one", "get me a foobar".
fn is_in_noun_phrase(marks: &[Mark<'_>], at: usize) -> bool {
    let before = at.checked_sub(1).map(|before| &marks[before]);
    marks[at].sense == Sense::Unknown
        && marks[at].gap <= Gap::None
        && before.is_some_and(|before| {
            before.value().is_some() || before.is_any(cues![Determiner Unlisted])
        })
}
