//! Several objects in one request: "the red mug and the white cup". Never guessed: two things are
//! requested only if one cannot be both, or if two named things are joined.

use scene::Role;

use crate::content::{Asserted, Content};
use crate::question_words::QuestionWords;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// Head of a noun phrase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Noun {
    None,
    /// "the green one": the noun is the one before.
    One,
    Named,
}

/// A joined part of a description.
#[derive(Clone, Debug)]
struct Part<'a> {
    values: Vec<Asserted<'a>>,
    determined: bool,
    noun: Noun,
}

/// How two values are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Joint {
    /// Nothing that distinguishes two things.
    None,
    /// Joined by a comma, as in a list.
    Comma,
    /// Joined by "and", "then" or "plus".
    And,
}

/// Splits the values said into those of each requested object, at least one.
pub(crate) fn objects<'a>(
    tags: &[Tag<'a>],
    content: &Content<'a>,
    asked: QuestionWords<'_>,
) -> Vec<Vec<Asserted<'a>>> {
    let base = &content.base;
    // "red or blue" is one thing, and after a repair the order is not that of the words.
    if base.is_empty() || content.alternatives || !base.is_sorted_by_key(|value| value.at) {
        return vec![base.clone()];
    }
    let answers = !asked.is_nothing();
    let joined = |list| joined(parts(tags, base, list), answers);
    let mut parts = joined(false);
    if parts.len() > 1 {
        // "the red mug, the white cup and a spoon"
        parts = joined(true);
    }
    share_nouns(&mut parts);
    parts.into_iter().map(|part| part.values).collect()
}

/// The parts between the joints; in a `list` the commas count as well.
fn parts<'a>(tags: &[Tag<'a>], base: &[Asserted<'a>], list: bool) -> Vec<Part<'a>> {
    let mut parts: Vec<Part<'a>> = Vec::new();
    let mut begin = 0;
    for (n, value) in base.iter().enumerate() {
        let from = n.checked_sub(1).map_or(0, |before| base[before].at + 1);
        let (joint, lead) = joint(tags, from, value.at);
        let determined = tags[lead..value.at].iter().any(is_determiner);
        let splits = joint == Joint::And || joint == Joint::Comma && list && determined;
        if n == 0 || splits {
            if let Some(part) = parts.last_mut() {
                part.noun = noun(&tags[begin..lead]);
            }
            begin = value.at;
            parts.push(Part { values: Vec::new(), determined, noun: Noun::None });
        }
        if let Some(part) = parts.last_mut() {
            part.values.push(*value);
        }
    }
    if let Some(part) = parts.last_mut() {
        let rest = &tags[begin..];
        let more = |tag: &Tag<'_>| tag.is_any(classes![And Or Join]);
        part.noun = noun(&rest[..rest.iter().position(more).unwrap_or(rest.len())]);
    }
    parts
}

/// The joint between two values, and the tag after it; for the first value, the start of its noun
/// phrase.
fn joint(tags: &[Tag<'_>], from: usize, to: usize) -> (Joint, usize) {
    const BETWEEN: &[Class] = classes![
        And Determiner Quantifier Possessive Head Fetch Want First Second Auxiliary Courtesy Filler
        Plain Other Preposition Destination
    ];
    let is_and = |tag: &Tag<'_>| tag.is(Class::And) || tag.is(Class::Join) && tag.last == "then";
    let between = &tags[from..to];
    if !between.iter().all(|tag| tag.is_any(BETWEEN) || is_and(tag)) {
        let ends = |tag: &Tag<'_>| !is_determiner(tag);
        return (Joint::None, from + between.iter().rposition(ends).map_or(0, |at| at + 1));
    }
    if let Some(at) = between.iter().rposition(is_and) {
        return (Joint::And, from + at + 1);
    }
    match tags[from..=to].iter().rposition(Tag::pauses) {
        Some(at) if from > 0 => (Joint::Comma, from + at),
        _ => (Joint::None, from),
    }
}

fn is_determiner(tag: &Tag<'_>) -> bool {
    tag.is_any(classes![Determiner Quantifier Possessive Other])
}

fn noun(phrase: &[Tag<'_>]) -> Noun {
    if phrase.iter().any(|tag| tag.is_role(Role::Kind)) {
        return Noun::Named;
    }
    match phrase.iter().find(|tag| tag.is(Class::Head)) {
        Some(head) if head.word.starts_with("one") => Noun::One,
        Some(_) => Noun::Named,
        None => Noun::None,
    }
}

/// Puts the parts of one object together again. `answers`: in answer to a question, where "white
/// and clear" is not a request.
fn joined(parts: Vec<Part<'_>>, answers: bool) -> Vec<Part<'_>> {
    let mut objects: Vec<Part<'_>> = Vec::new();
    for part in parts {
        match objects.last_mut().filter(|object| !are_two(object, &part, answers)) {
            Some(object) => {
                object.values.extend(part.values);
                object.noun = if object.noun == Noun::None { part.noun } else { object.noun };
            }
            None => objects.push(part),
        }
    }
    objects
}

fn are_two(one: &Part<'_>, other: &Part<'_>, answers: bool) -> bool {
    let contradicts = other
        .values
        .iter()
        .any(|new| one.values.iter().any(|old| old.rivals(new) && old.word != new.word));
    let named = [one, other].iter().all(|part| part.determined && part.noun == Noun::Named);
    let phrases = other.determined || one.noun != Noun::None || other.noun != Noun::None;
    contradicts && (phrases || !answers) || named
}

/// "the red and the blue mug" are two mugs, and so are "the red mug and the blue one".
fn share_nouns(objects: &mut [Part<'_>]) {
    for at in 1..objects.len() {
        let (before, after) = objects.split_at_mut(at);
        let (one, other) = (&mut before[at - 1], &mut after[0]);
        if one.noun == Noun::None {
            let kinds = other.values.iter().filter(|value| value.role == Role::Kind);
            one.values.extend(kinds);
        } else if other.noun == Noun::One {
            let kinds = one.values.iter().filter(|value| value.role == Role::Kind);
            other.values.extend(kinds);
        }
    }
}
