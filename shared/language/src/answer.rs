//! Selection of the valid one from answers in the order given.

use scene::Response;

use crate::clauses::Clause;
use crate::content::{Asserted, Content};
use crate::lexicon::{Lexicon, Sense};
use crate::question_words::QuestionWords;
use crate::tagger::{Tag, after};
use crate::token_class::{Class, classes};

/// An answer to the question asked, or the lack of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    Yes,
    No,
    /// "I do not know": takes back the earlier answers.
    Unsure,
    /// "let me think": takes it back as well, and says nothing instead.
    Pondering,
}

/// Answers in order, each with its tag; the scope of the question has none.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    given: Vec<Given>,
}

/// One answer.
#[derive(Clone, Copy, Debug)]
struct Given {
    answer: Answer,
    /// Index of the answer's tag.
    at: Option<usize>,
    /// Probability that the answer was not given.
    doubt: f64,
}

impl Answers {
    pub(crate) fn push(&mut self, answer: Answer, tags: &[Tag<'_>], at: usize) {
        let doubt = match answer {
            Answer::Yes | Answer::No => tags[at].answer_doubt(),
            // That one does not know is no less sure for being said so.
            Answer::Unsure | Answer::Pondering => tags[at].doubt,
        };
        self.given.push(Given { answer, at: Some(at), doubt });
    }

    /// "not the white one", when white was asked about.
    pub(crate) fn push_negation(&mut self, doubt: f64) {
        self.given.push(Given { answer: Answer::No, at: None, doubt });
    }

    pub(crate) fn clear(&mut self) {
        self.given.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Returns whether the last answer was given by a tag before `at`.
    fn are_before(&self, at: usize) -> bool {
        self.given.last().is_some_and(|given| given.at.is_some_and(|given| given < at))
    }

    /// The valid answer: the last one, unless it is tied to its opposite ("yes and no"); and its
    /// doubt. An answer given twice has the smaller doubt.
    fn standing(&self, tags: &[Tag<'_>]) -> Option<(Answer, f64)> {
        let last = *self.given.last()?;
        if let [.., before, _] = self.given[..]
            && let (Some(from), Some(to)) = (before.at, last.at)
            && before.answer != last.answer
            && (is_tied(tags.get(from + 1..to).unwrap_or_default()) || is_doubled(tags, from, to))
        {
            return Some((Answer::Unsure, 0.0));
        }
        let again = self.given.iter().rev().take_while(|given| given.answer == last.answer);
        Some((last.answer, again.map(|given| given.doubt).fold(1.0, f64::min)))
    }
}

/// Only "and", "or" or "but" in between.
fn is_tied(between: &[Tag<'_>]) -> bool {
    let tie = |tag: &Tag<'_>| tag.is_any(classes![And Or But]);
    between.iter().any(tie)
        && between.iter().all(|tag| tie(tag) || tag.is_any(classes![Filler Plain]))
}

/// "sometimes yes, sometimes no", "could be yes, could be no".
fn is_doubled(tags: &[Tag<'_>], from: usize, to: usize) -> bool {
    let lead = |at: usize| at.checked_sub(1).and_then(|before| tags.get(before));
    let (Some(first), Some(second)) = (lead(from), lead(to)) else { return false };
    first.word == second.word && !second.is_any(classes![Yes No Repair Filler])
}

/// Returns the answer that a tag gives on its own.
pub(crate) fn answer(tags: &[Tag<'_>], clause: &Clause, at: usize) -> Option<Answer> {
    let denied = at > clause.span.start && tags[at - 1].is(Class::Not);
    if denied {
        return None;
    }
    match tags[at].class()? {
        Class::Yes => Some(Answer::Yes),
        Class::WeakYes if is_bare(tags, clause) => Some(Answer::Yes),
        Class::WeakNo if is_bare(tags, clause) => Some(Answer::No),
        Class::Likely if is_bare(tags, clause) => Some(Answer::Yes),
        Class::Other if is_other_one(tags, clause, at) => Some(Answer::No),
        Class::Ordinal if tags[at].word == "next" && is_other_one(tags, clause, at) => {
            Some(Answer::No)
        }
        Class::PutBack => Some(Answer::No),
        Class::Be | Class::Auxiliary if is_affirmed(tags, clause, at) => Some(Answer::Yes),
        Class::WeakYes if is_judged(tags, clause, at) => Some(Answer::Yes),
        Class::WeakNo if is_judged(tags, clause, at) || is_wrong_thing(tags, at) => {
            Some(Answer::No)
        }
        _ => None,
    }
}

/// Nothing in the clause says more than an answer does.
fn is_bare(tags: &[Tag<'_>], clause: &Clause) -> bool {
    const BARE: &[Class] = classes![
        Yes No WeakYes WeakNo Likely Hedge Filler Courtesy Plain And But Join First Second It
        Pointer Preposition Be Auxiliary Determiner Head Repair
    ];
    tags[clause.span.clone()].iter().all(|tag| tag.is_any(BARE))
}

/// "the other one", as opposed to "the other white one".
fn is_other_one(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let before = tags[clause.span.start..at].last();
    let after = tags[at + 1..clause.span.end].first();
    let whole = after.is_none_or(|next| {
        next.is_any(classes![Head Attribute Courtesy Filler No Be]) || next.pauses()
    });
    let plain = tags[clause.span.clone()].iter().all(|tag| !tag.is_unknown() && !tag.is_value());
    whole && plain && !before.is_some_and(|before| before.is_any(classes![Quantifier AskBack]))
}

/// "the wrong spoon", "wrong medicine": the thing after it is refused.
pub(crate) fn is_wrong_thing(tags: &[Tag<'_>], at: usize) -> bool {
    tags[at].word == "wrong"
        && after(tags, at)
            .is_some_and(|next| next.is_value() || next.is_any(classes![Head Attribute Unlisted]))
}

/// "drawer is right", "white would be wrong".
fn is_judged(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let before = &tags[clause.span.start..at];
    let plain = |tag: &Tag<'_>| {
        tag.is_value() || tag.is_any(classes![Determiner Head Filler Yes No Preposition])
    };
    matches!(before, [said @ .., be]
        if be.is(Class::Be) && said.iter().all(plain) && said.iter().any(|tag| tag.is_value()))
        && at + 1 == clause.span.end
}

/// Returns whether a sentence about the question says no more than yes.
fn is_affirmed(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let before = &tags[clause.span.start..at];
    let subject = before.iter().rev().find(|tag| !tag.is(Class::Plain));
    let said = &tags[at + 1..clause.span.end];
    if said.is_empty() {
        // "it very much is", but not "if it is"
        const OPEN: &[Class] =
            classes![Question Join Unsure Pondering Not Unlisted Ordinal AskBack];
        let plain = |tag: &Tag<'_>| !tag.is_unknown() && !tag.is_value() && !tag.is_any(OPEN);
        return subject.is_some_and(|tag| tag.is(Class::It)) && before.iter().all(plain);
    }
    let about_it = before.last().is_some_and(|tag| tag.is_any(classes![It Pointer]));
    let is = tags[at].is(Class::Be);
    about_it && (is && (is_the_one(tags, clause, at) || is_what(said)) || is_it(said))
}

/// "that's where it is", "that's what I've been looking for".
fn is_what(said: &[Tag<'_>]) -> bool {
    let [what, whose, rest @ ..] = said else { return false };
    const STRANGE: &[Class] = classes![Not No Unsure Pondering Unlisted Third Other Ordinal];
    // "what is in it" is a phrase
    let phrase = what.is(Class::AskBack) && what.word == "what";
    (what.is(Class::Question) || phrase)
        && (whose.is_any(classes![It First Possessive Be]) || whose.word == "it")
        && rest.iter().all(|tag| !tag.is_value() && !tag.is_any(STRANGE))
        && rest.iter().filter(|tag| tag.is_unknown()).count() <= 1
}

/// "it is made of that", "it does have that", "it's in there", "it is one".
fn is_it(said: &[Tag<'_>]) -> bool {
    let Some((last, rest)) = said.split_last() else { return false };
    let place = matches!(last.word, "in" | "there" | "here" | "up" | "down" | "over" | "right");
    let shown =
        last.is_any(classes![Pointer It]) || last.is(Class::Plain) && (place || last.word == "one");
    shown
        && rest
            .iter()
            .all(|tag| tag.is_any(classes![Plain Preposition Attribute Auxiliary Be Filler]))
}

/// "that is exactly the one I want", "it's the one".
fn is_the_one(tags: &[Tag<'_>], clause: &Clause, at: usize) -> bool {
    let said = &tags[at + 1..clause.span.end];
    let plain = tags[clause.span.clone()].iter().all(|tag| {
        !tag.is_value()
            && !tag.is_unknown()
            && !tag.is_any(classes![Not Ordinal Unlisted Other Question])
    });
    let the_one = said.windows(2).any(|pair| {
        (pair[0].word == "the" || pair[0].is(Class::Possessive)) && pair[1].is(Class::Head)
    });
    plain && the_one
}

/// "the bowl, yes", "okay, get it"
fn names_thing(tags: &[Tag<'_>]) -> bool {
    let names = |word: &str| match Lexicon::own().word(word) {
        Some(Sense::Class(class)) => matches!(class, Class::It | Class::Pointer | Class::Head),
        _ => false,
    };
    tags.iter()
        .any(|tag| tag.is(Class::Head) || [tag.word, tag.second, tag.last].into_iter().any(names))
}

/// The response to the question: the last answer, or the one implied by the values; and the
/// probability that it was not given. `indifferent`: whether it was said that the answer does not
/// matter.
pub(crate) fn response(
    content: &Content<'_>,
    tags: &[Tag<'_>],
    asked: QuestionWords<'_>,
    indifferent: Option<usize>,
) -> (Response, f64) {
    let careless = indifferent.map(|at| (Response::DoesNotMatter, tags[at].doubt));
    let certain = !content.hedged && !content.alternatives;
    let described = !content.base.is_empty() || !content.excluded.is_empty();
    // A mere answer to nothing is known as one, so that it opens no dialogue.
    let opens = asked.is_nothing();
    let is_mere = || !described && !names_thing(tags);
    let counts = |answer| !opens || matches!(answer, Answer::Yes | Answer::No) && is_mere();
    let answer = content.answers.standing(tags).filter(|(answer, _)| counts(*answer));
    match (answer, careless) {
        (Some((Answer::Yes, doubt)), _) => (Response::Yes, doubt),
        // "no, I don't mind" denies nothing.
        (Some((Answer::No, _)), Some(careless))
            if !described && indifferent.is_some_and(|at| content.answers.are_before(at)) =>
        {
            careless
        }
        (Some((Answer::No, doubt)), _) => (Response::No, doubt),
        (None, _) if certain => match implied(&content.base, asked) {
            (Response::None, _) => careless.unwrap_or((Response::None, 0.0)),
            implied => implied,
        },
        (_, Some(careless)) => careless,
        (Some((Answer::Unsure, doubt)), None) if !described => (Response::CannotTell, doubt),
        (Some((Answer::Unsure | Answer::Pondering, _)) | None, None) => (Response::None, 0.0),
    }
}

/// "Is it white?" "The clear one." is a no, "The white one." a yes. It is as doubtful as the
/// surest of the values that imply it.
fn implied(base: &[Asserted<'_>], asked: QuestionWords<'_>) -> (Response, f64) {
    let (response, implies): (Response, Vec<&Asserted<'_>>) = match asked {
        QuestionWords::Value(attribute, word) => {
            let said = base.iter().filter(|value| value.attributes.contains(&attribute));
            let said: Vec<&Asserted<'_>> = said.collect();
            let agreeing = said.iter().filter(|value| value.word == word).count();
            match (agreeing, said.len()) {
                (0, 1..) => (Response::No, said),
                (agreeing, all) if all > 0 && agreeing == all => (Response::Yes, said),
                _ => (Response::None, Vec::new()),
            }
        }
        QuestionWords::Object(words) => {
            let other = base.iter().filter(|value| !words.contains(&value.word));
            let other: Vec<&Asserted<'_>> = other.collect();
            (if other.is_empty() { Response::None } else { Response::No }, other)
        }
        QuestionWords::Nothing
        | QuestionWords::PerceivedObject
        | QuestionWords::Attribute
        | QuestionWords::Choice(_) => (Response::None, Vec::new()),
    };
    (response, implies.iter().map(|value| value.doubt).reduce(f64::min).unwrap_or(0.0))
}
