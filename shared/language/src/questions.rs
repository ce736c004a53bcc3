//! Subject of a question to the robot, and the objects asked about.

use scene::{Intent, WordId};

use crate::clauses::{Clause, Topic};
use crate::content::{Asserted, Content};
use crate::extractor::extract;
use crate::fates::Fates;
use crate::lexicon::{Lexicon, Sense};
use crate::question_words::{QuestionWords, SceneQuestions};
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// Returns the subject of a text whose intent is a question, and the words for the objects asked
/// about: "how many white cups are there".
pub(crate) fn question<'a>(
    tags: &[Tag<'a>],
    clauses: &[Clause],
    lexicon: &Lexicon,
    scene: &SceneQuestions,
) -> (Intent, Content<'a>) {
    let asking: Vec<Clause> = clauses.iter().map(of_question).collect();
    let mut content = extract(tags, &asking, &Fates::named(tags), QuestionWords::Nothing);
    let first = clauses.iter().find(|clause| clause.topic == Topic::AskBack);
    let intent = first.map_or(Intent::AskBack, |clause| {
        kind(&tags[clause.span.clone()], !content.base.is_empty())
    });
    let asked = first.and_then(|it| asked_values(&tags[it.span.clone()], lexicon, scene));
    // To `kind`, "how long is the wrench" asks whether there is one.
    if let Some(values) = asked
        && matches!(intent, Intent::AskBack | Intent::AskWhether)
        && !content.base.is_empty()
    {
        content.asked = values.to_vec();
        return (Intent::AskWhich, content);
    }
    let alternatives = alternatives(tags, &content.base);
    // "are there red or blue cups" asks about both, not about one of them.
    content.base.iter_mut().for_each(|value| value.choice = 0);
    if intent != Intent::AskWhether || alternatives.is_empty() {
        return (intent, content);
    }
    // "is it long or short" asks which of them.
    let base = content.base.iter().enumerate();
    let (asked, base) = base.partition::<Vec<_>, _>(|(n, _)| alternatives.contains(n));
    content.asked = asked.into_iter().map(|(_, value)| value.word).collect();
    content.base = base.into_iter().map(|(_, value)| *value).collect();
    (Intent::AskWhich, content)
}

/// "what colour is the wrench", "how long is it": the attribute's values, if more than one.
fn asked_values<'s>(
    tags: &[Tag<'_>],
    lexicon: &Lexicon,
    scene: &'s SceneQuestions,
) -> Option<&'s [WordId]> {
    let values = |tag: &Tag<'_>| match tag.class() {
        Some(Class::Attribute) => scene.values(tag.word),
        Some(Class::AskBack) if tag.word == "how" => match lexicon.word(tag.second) {
            Some(Sense::Value(value)) => scene.values_beside(value),
            _ => &[],
        },
        _ => &[],
    };
    tags.iter().map(values).find(|values| values.len() > 1)
}

/// Places in `base` of the values that "or" joins: "white or metallic", "white, clear or metallic".
fn alternatives(tags: &[Tag<'_>], base: &[Asserted<'_>]) -> Vec<usize> {
    let is_or = |n: &usize| {
        let (left, right) = (&base[*n], &base[*n + 1]);
        left.choice != right.choice && left.rivals(right)
    };
    let Some(first) = (0..base.len().saturating_sub(1)).find(is_or) else { return Vec::new() };
    let last = (first..base.len() - 1).rfind(is_or).unwrap_or(first);
    let is_listed = |n: &usize| base[*n].rivals(&base[*n + 1]) && tags[base[*n + 1].at].pauses();
    let listed = (0..first).rev().take_while(is_listed).count();
    (first - listed..=last + 1).collect()
}

/// "have you seen my red pen? bring it please": the object of the question is requested.
pub(crate) fn fetches_it(tags: &[Tag<'_>], clauses: &[Clause]) -> bool {
    let on_topic = clauses.iter().filter(|clause| clause.topic == Topic::On);
    on_topic.map(|clause| &tags[clause.span.clone()]).any(|clause| {
        clause.iter().any(|tag| tag.is(Class::Yes) && tag.last == "it" && tag.word != "that")
            || clause.windows(2).any(|pair| pair[0].is(Class::Fetch) && pair[1].is(Class::It))
    })
}

/// Returns the clause as part of a question, or as none.
fn of_question(clause: &Clause) -> Clause {
    let topic = if clause.topic == Topic::AskBack { Topic::On } else { Topic::Off };
    Clause { topic, ..clause.clone() }
}

/// The intent of a question; `describes`: it names objects of the scene.
fn kind(tags: &[Tag<'_>], describes: bool) -> Intent {
    let says = |class| tags.iter().any(|tag| tag.is(class));
    let opens = |word: &str| tags.iter().any(|tag| is_asking(tag) && tag.word == word);
    let ends = |words: &[&str]| tags.iter().any(|tag| is_asking(tag) && words.contains(&tag.last));
    if says(Class::AskStatus) {
        Intent::AskStatus
    } else if says(Class::AskHelp) {
        Intent::AskHelp
    } else if opens("why") || ends(&["come"]) {
        Intent::AskWhy
    } else if says(Class::Attribute)
        || ends(&["mean", "pointing", "talking", "referring", "asking"])
    {
        Intent::AskBack
    } else if ends(&["many"]) || is_number_asked(tags) {
        Intent::AskCount
    } else if opens("where") || ends(&["where"]) {
        Intent::AskWhere
    } else if describes && (opens("what") || opens("which")) {
        Intent::AskWhich
    } else if describes {
        Intent::AskWhether
    } else {
        Intent::AskBack
    }
}

/// "two or three".
fn is_number_asked(tags: &[Tag<'_>]) -> bool {
    let is_number = |tag: &Tag<'_>| tag.is_any(classes![Quantifier One]);
    tags.windows(3).any(|it| is_number(&it[0]) && it[1].is(Class::Or) && is_number(&it[2]))
}

fn is_asking(tag: &Tag<'_>) -> bool {
    tag.is(Class::AskBack) || tag.is(Class::Question)
}
