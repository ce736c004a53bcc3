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

    /// The last answer and its doubt. An answer given twice has the smaller doubt.
    fn standing(&self) -> Option<(Answer, f64)> {
        let last = *self.given.last()?;
        let again = self.given.iter().rev().take_while(|given| given.answer == last.answer);
        Some((last.answer, again.map(|given| given.doubt).fold(1.0, f64::min)))
    }
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
        Class::WeakNo if is_wrong_thing(tags, at) => Some(Answer::No),
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
    let answer = content.answers.standing().filter(|(answer, _)| counts(*answer));
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
