//! What a question to the robot is about, and of which objects.

use scene::Intent;

use crate::clauses::{Clause, Topic};
use crate::content::Content;
use crate::extractor::extract;
use crate::question_words::QuestionWords;
use crate::tagger::Tag;
use crate::token_class::Class;

/// Returns what is asked in a text whose intent is a question, and the words for the objects that it
/// is asked of: "how many white cups are there".
pub(crate) fn question<'a>(tags: &[Tag<'a>], clauses: &[Clause]) -> (Intent, Content<'a>) {
    let asking: Vec<Clause> = clauses.iter().map(of_question).collect();
    let mut content = extract(tags, &asking, QuestionWords::Nothing);
    // "are there red or blue cups" asks about both, not about one of them.
    content.base.iter_mut().for_each(|value| value.choice = 0);
    let first = clauses.iter().find(|clause| clause.topic == Topic::AskBack);
    let intent = first.map_or(Intent::AskBack, |clause| {
        kind(&tags[clause.span.clone()], !content.base.is_empty())
    });
    // "is it long or short" asks which of them.
    let is_choice = intent == Intent::AskWhether && content.alternatives;
    (if is_choice { Intent::AskWhich } else { intent }, content)
}

/// "have you seen my red pen? bring it please": what was asked about is asked for.
pub(crate) fn fetches_it(tags: &[Tag<'_>], clauses: &[Clause]) -> bool {
    let on_topic = clauses.iter().filter(|clause| clause.topic == Topic::On);
    on_topic.map(|clause| &tags[clause.span.clone()]).any(|clause| {
        clause.iter().any(|tag| tag.is(Class::Yes) && tag.last == "it" && tag.word != "that")
            || clause.windows(2).any(|pair| pair[0].is(Class::Fetch) && pair[1].is(Class::It))
    })
}

/// The clause as it is read for what a question is asked of: nothing in it describes another thing.
fn of_question(clause: &Clause) -> Clause {
    let topic = if clause.topic == Topic::AskBack { Topic::On } else { Topic::Off };
    Clause { topic, distractors: Vec::new(), ..clause.clone() }
}

/// The intent of a question; `describes`: it names objects of the scene.
fn kind(tags: &[Tag<'_>], describes: bool) -> Intent {
    let says = |class| tags.iter().any(|tag| tag.is(class));
    let opens = |word: &str| tags.iter().any(|tag| is_asking(tag) && tag.word == word);
    let ends = |words: &[&str]| tags.iter().any(|tag| is_asking(tag) && words.contains(&tag.last));
    // "what colour is"
    let asks_for_attribute =
        opens("what") && tags.iter().any(|tag| tag.is(Class::AskBack) && tag.last == "is");
    if says(Class::AskStatus) {
        Intent::AskStatus
    } else if says(Class::AskHelp) {
        Intent::AskHelp
    } else if opens("why") || ends(&["come"]) {
        Intent::AskWhy
    } else if says(Class::Attribute)
        || asks_for_attribute
        || ends(&["mean", "pointing", "talking", "referring", "asking"])
    {
        Intent::AskBack
    } else if ends(&["many"]) {
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

fn is_asking(tag: &Tag<'_>) -> bool {
    tag.is(Class::AskBack) || tag.is(Class::Question)
}
