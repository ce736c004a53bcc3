//! The intent of an utterance.

use scene::{Intent, Role};
use words::Gap;

use crate::clauses::{Clause, Topic};
use crate::content::Content;
use crate::fates::Fates;
use crate::question_words::QuestionWords;
use crate::questions::fetches_it;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};

/// The intent of an utterance whose content is known.
///
/// In text that no person says (`code`) only the opening counts as a command.
pub(crate) fn intent(
    tags: &[Tag<'_>],
    clauses: &[Clause],
    content: &Content<'_>,
    asked: QuestionWords<'_>,
    code: bool,
) -> Intent {
    let new = asked.is_nothing();
    let says_nothing = content.base.is_empty() && content.excluded.is_empty();
    let spoken = if code { clauses.len().min(1) } else { clauses.len() };
    let commands = |class| clauses[..spoken].iter().any(|clause| commands(tags, clause, class));
    let withdraws = commands(Class::Cancel) || commands(Class::Withdraw) || puts_off(tags);
    let declines = |new| clauses.iter().any(|clause| declines(tags, clause, new));
    let stops = tags.iter().any(|tag| tag.is(Class::Stop));
    if stops && says_nothing && (withdraws || declines(true)) {
        Intent::StopAndCancel
    } else if stops {
        Intent::Stop
    } else if commands(Class::StartOver) {
        Intent::StartOver
    } else if says_nothing && (withdraws || (new || content.answers.is_empty()) && declines(new)) {
        Intent::Cancel
    } else if says_nothing && (commands(Class::Repeat) || is_only_huh(tags)) {
        Intent::Repeat
    } else if says_nothing && clauses.iter().any(|clause| clause.topic == Topic::AskBack) {
        Intent::AskBack
    } else if new && clauses.iter().any(|clause| puts_it_back(tags, clause))
        || clauses.iter().any(|clause| puts_back(tags, clause))
    {
        Intent::PutBack
    } else if is_chore(tags, clauses) {
        Intent::Chore
    } else if let Some(courtesy) =
        courtesy(tags).filter(|_| says_nothing && (new || content.answers.is_empty()))
    {
        courtesy
    } else if new && content.base.is_empty() && !says_nothing && refuses(tags, clauses) {
        Intent::Cancel
    } else if !says_nothing || informs(tags, clauses, content) {
        Intent::Inform
    } else {
        Intent::None
    }
}

/// Returns whether the clause gives this command to the robot: it says nothing unrelated, and it is
/// not negated.
pub(crate) fn commands(tags: &[Tag<'_>], clause: &Clause, class: Class) -> bool {
    let range = clause.span.clone();
    let Some(at) = range.clone().find(|&at| tags[at].is(class)) else { return false };
    if at > range.start && tags[at - 1].is(Class::Not) {
        return false;
    }
    let plain = tags[range].iter().all(|tag| !tag.is_unknown());
    plain && clause.topic != Topic::Off
}

/// Returns whether the order at `at` leaves something in one case only: "if it's empty leave it", but
/// not "if you have it forget it" and "if it's there, never mind".
pub(crate) fn is_conditional(tags: &[Tag<'_>], at: usize) -> bool {
    const ENDS: &[Class] = classes![Fetch Want No Repair];
    let is_condition =
        |tag: &Tag<'_>| tag.is(Class::Join) && matches!(tag.word, "if" | "unless" | "when");
    let Some(condition) = tags[..at].iter().rposition(|tag| is_condition(tag) || tag.is_any(ENDS))
    else {
        return false;
    };
    let opens =
        condition == 0 || tags[condition].pauses() || tags[condition - 1].is_any(classes![And But]);
    let mut gaps = tags[condition + 1..=at].iter().map(|tag| tag.gap);
    let leaves = matches!(tags[at].last, "it" | "them") && tags[at].word != "cancel";
    let asks = tags[condition + 1].is(Class::Second);
    leaves
        && !asks
        && is_condition(&tags[condition])
        && gaps.all(|gap| gap < Gap::Pause || opens && gap < Gap::Stop)
}

/// "I don't want a bowl any more", "forget about the bowl": any of them is declined. `new`: not an
/// answer, so that "I don't want it" is not a denial.
fn declines(tags: &[Tag<'_>], clause: &Clause, new: bool) -> bool {
    let tags = &tags[clause.span.clone()];
    let denies = tags.iter().any(|tag| tag.is(Class::Not));
    let fetches = tags.iter().any(|tag| tag.is_any(classes![Fetch Want]) || tag.word == "forget");
    let noun = tags
        .iter()
        .any(|tag| tag.is(Class::Head) && !tag.word.starts_with("one") || new && tag.is(Class::It));
    let plain = tags.iter().all(|tag| {
        !tag.is_unknown()
            && !tag.is_any(classes![Pointer Other Unlisted Ordinal Attribute Preposition Landmark])
    });
    clause.topic == Topic::On && denies && fetches && noun && plain
}

/// "put it back", "put it back on the shelf".
fn puts_it_back(tags: &[Tag<'_>], clause: &Clause) -> bool {
    let described = |tag: &Tag<'_>| tag.is_value() && !tag.is_role(Role::Place);
    tags[clause.span.clone()].iter().any(|tag| tag.is(Class::PutBack))
        && !tags.iter().any(described)
}

/// "put the red mug back", "return the red mug to the shelf", "put the red mug away", but not "put
/// it back on" and "bring the red mug back to me".
fn puts_back(tags: &[Tag<'_>], clause: &Clause) -> bool {
    let [verb, rest @ ..] = order(&tags[clause.span.clone()]) else { return false };
    // "put back the red mug"
    let is_back_first = rest.first().is_some_and(|tag| tag.word == "back");
    let rest = &rest[usize::from(is_back_first)..];
    let is_thing = |tag: &Tag<'_>| tag.is_value() || tag.is_any(classes![Pointer It Head]);
    let in_phrase = |tag: &&Tag<'_>| is_thing(tag) || tag.is_any(classes![Determiner Possessive]);
    let (thing, rest) = rest.split_at(rest.iter().take_while(in_phrase).count());
    let place = match (verb.word, verb.last, rest) {
        ("put", "away", rest) => rest,
        ("put" | "take" | "bring" | "return", _, [back, rest @ ..]) if back.word == "back" => rest,
        ("put" | "take", _, [away, rest @ ..]) if away.word == "away" => rest,
        ("return", _, rest) => rest,
        ("put" | "take", _, rest) if is_back_first => rest,
        _ => return false,
    };
    thing.iter().any(is_thing) && is_where_it_was(place)
}

/// Continuations of "put it back": nothing, "on the shelf", "where it was", "in its place".
fn is_where_it_was(tags: &[Tag<'_>]) -> bool {
    const BESIDE: &[Class] = classes![Courtesy Filler];
    const IN_PLACE: &[Class] =
        classes![Courtesy Filler Preposition Destination Determiner Possessive It Be];
    // "in its place", where "its" is read as "it is".
    let is_own_place = |tag: &Tag<'_>| matches!(tag.word, "place" | "spot");
    let is_place =
        |tag: &Tag<'_>| tag.is_role(Role::Place) || tag.is(Class::Unlisted) || is_own_place(tag);
    // Our things go back to their places, whatever is said about those.
    let says_where = tags.first().is_some_and(|tag| tag.word == "where");
    let says_place = tags.iter().any(is_place)
        && tags.iter().all(|tag| is_place(tag) || tag.is_any(IN_PLACE) && tag.word != "from");
    says_where || says_place || tags.iter().all(|tag| tag.is_any(BESIDE))
}

/// An order from its verb on: "put it back" of "now I want you to put it back".
fn order<'t, 'a>(tags: &'t [Tag<'a>]) -> &'t [Tag<'a>] {
    const LEADS: &[Class] = classes![WeakYes Repair Plain];
    let tags = after_leads(tags);
    match tags {
        [i, want, you, to, rest @ ..]
            if i.is(Class::First)
                && want.is(Class::Want)
                && you.is(Class::Second)
                && to.is(Class::Destination) =>
        {
            rest
        }
        _ => after_leads(&tags[tags.iter().take_while(|tag| tag.is_any(LEADS)).count()..]),
    }
}

/// "wash the clear bowl", but not "wash it and bring it to me".
fn is_chore(tags: &[Tag<'_>], clauses: &[Clause]) -> bool {
    let fetches = |clause: &Clause| {
        !clause.chore && tags[clause.span.clone()].iter().any(|tag| tag.is(Class::Fetch))
    };
    clauses.iter().any(|clause| clause.chore)
        && !clauses.iter().any(fetches)
        && !fetches_it(tags, clauses)
}

/// "the clear bowl is in the cabinet": no wish about any of our things that are named.
pub(crate) fn is_remark(tags: &[Tag<'_>], fates: &Fates) -> bool {
    fates.are_neither() && !tags.iter().any(|tag| tag.is_any(classes![Fetch Want]))
}

/// "don't get me the clear bowl", "I don't want the white ones": nothing is requested.
fn refuses(tags: &[Tag<'_>], clauses: &[Clause]) -> bool {
    let is_denied = |clause: &Clause| {
        let tags = &tags[clause.span.clone()];
        let verb = tags.iter().position(|tag| tag.is_any(classes![Fetch Want]))?;
        Some(tags[..verb].iter().any(|tag| tag.is(Class::Not)))
    };
    let mut asking = clauses.iter().filter_map(is_denied).peekable();
    !fetches_it(tags, clauses) && asking.peek().is_some() && asking.all(|is_denied| is_denied)
}

/// Returns the tags after leading words without meaning.
fn after_leads<'t, 'a>(tags: &'t [Tag<'a>]) -> &'t [Tag<'a>] {
    const LEADS: &[Class] = classes![Filler Courtesy No And But Join Auxiliary Second];
    let leads = tags.iter().take_while(|tag| tag.is_any(LEADS) && tag.word != "do").count();
    &tags[leads..]
}

/// A greeting, a farewell or thanks, without any request.
fn courtesy(tags: &[Tag<'_>]) -> Option<Intent> {
    const BESIDE: &[Class] = classes![
        Courtesy Filler WeakYes Reply Plain Second It Be First Determiner Preposition Pointer Head
        And But When Possessive AskHelp
    ];
    const STRANGE_MAX: usize = 2;
    // "No, thanks", or "no thanks", which is one phrase.
    let no = |tag: &Tag<'_>| tag.is(Class::No) && tag.word == "no";
    let no_thanks = |tag: &Tag<'_>| no(tag) && matches!(tag.last, "thanks" | "you");
    let strange = tags.iter().filter(|tag| tag.is_unknown()).count();
    let beside = |tag: &Tag<'_>| tag.is_any(BESIDE) || tag.is_unknown() || no(tag);
    let said = |words: &[&str]| {
        tags.iter().any(|tag| tag.is(Class::Courtesy) && words.contains(&tag.word))
    };
    if strange > STRANGE_MAX || !tags.iter().all(beside) {
        None
    } else if said(&["thanks", "thank", "thx", "ty", "cheers", "many", "much", "ta"])
        || said(&["i", "that"])
        || tags.iter().any(no_thanks)
    {
        Some(Intent::Thank)
    } else if strange == 0 && said(&["goodbye", "bye", "see", "farewell"]) {
        Some(Intent::Leave)
    } else if strange == 0
        && said(&[
            "hello",
            "hi",
            "hey",
            "hiya",
            "howdy",
            "good",
            "greetings",
            "take",
            "welcome",
            "nice",
            "how",
        ])
    {
        Some(Intent::Greet)
    } else {
        None
    }
}

/// "not now", "later", "not yet", and nothing else.
fn puts_off(tags: &[Tag<'_>]) -> bool {
    let says = |tag: &&Tag<'_>| !tag.is_any(classes![Filler Courtesy No]);
    let said: Vec<&Tag<'_>> = tags.iter().filter(says).collect();
    match said[..] {
        [one] => one.word == "later" || (one.word, one.last) == ("not", "yet"),
        [not, now] => not.is(Class::Not) && now.last == "now",
        _ => false,
    }
}

/// "what", "sorry", "huh", and nothing else.
fn is_only_huh(tags: &[Tag<'_>]) -> bool {
    let huh = |tag: &Tag<'_>| {
        tag.is(Class::Huh)
            || tag.is(Class::Question) && tag.word == "what"
            || tag.is(Class::Repair) && matches!(tag.word, "sorry" | "pardon" | "excuse" | "i")
    };
    tags.iter().any(huh)
        && tags.iter().all(|tag| huh(tag) || tag.is_any(classes![Filler Courtesy It Be]))
}

/// Returns whether anything was said that is meant for the robot.
fn informs(tags: &[Tag<'_>], clauses: &[Clause], content: &Content<'_>) -> bool {
    const REPLIES: &[Class] = classes![
        Yes No Unsure Pondering Hedge Likely Indifferent Unsaid Reply
    ];
    !content.answers.is_empty()
        || clauses.iter().filter(|clause| clause.topic == Topic::On).any(|clause| {
            clause.requests || tags[clause.span.clone()].iter().any(|tag| tag.is_any(REPLIES))
        })
}

/// "no, I was talking to my wife", "yes I'll have it done by Friday": an answer, but not to the
/// robot.
pub(crate) fn is_side_talk(tags: &[Tag<'_>], clauses: &[Clause]) -> bool {
    let plans = |clause: &Clause| {
        let tags = &tags[clause.span.clone()];
        let speaker = tags.first().is_some_and(|tag| matches!(tag.word, "i" | "we"));
        let will = |tag: &Tag<'_>| tag.word == "will" || tag.is(Class::Want);
        speaker && tags.iter().any(will) && tags.iter().any(|tag| tag.is(Class::When))
    };
    let side_talk = tags.iter().any(|tag| tag.is(Class::SideTalk)) || clauses.iter().any(plans);
    side_talk && !clauses.iter().any(|clause| clause.requests)
}
