//! The speaker's confidence as expressed by hedges such as "I think so" or "probably".
//!
//! | words | confidence | source |
//! |---|---|---|
//! | `almost`, `nearly`, `pretty`, `fairly`, `quite`, `very`, `highly`, `most`, `certain` | 0.9 | half the way from `likely` to certain, as "very" is: Mosteller and Youtz 1990 |
//! | `think`, `believe`, `say`, `imagine`, `expect`, what is remembered or looks so | 0.8 | judged: people say it of what they want or saw |
//! | `probably`, `likely`, `should`, `must`, `supposedly` | 0.75 | about 0.7 in Mosteller and Youtz 1990, of events; judged a little higher of one's own things |
//! | `guess`, `suppose`, `reckon`, `assume`, `sort of` | 0.7 | judged |
//! | `maybe`, `perhaps`, `possibly`, `might`, `could` | 0.6 | judged: the meaning of "possible" varies between people, and people say it to be polite |
//! | any other way of not knowing | 0.55 | judged: it says little, not nothing |
//!
//! The confidence is the share of statements with these words that are true. A scene word is
//! doubted by `1 − sure`; an answer or a scope by `2 (1 − sure)`, because half of the answers that
//! were not given are right by chance ([`scene::Doubt`]).
//!
//! F. Mosteller and C. Youtz, "Quantifying probabilistic expressions", Statistical Science 5(1),
//! 1990.

use scene::Role;
use words::Gap;

use crate::clauses::{Clause, Topic};
use crate::lexicon::Sense;
use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use std::collections::HashMap;
use std::sync::LazyLock;

/// Confidences and the words that express them; of a phrase the highest counts.
const SURENESS: &[(f64, &str)] = &[
    (0.9, "almost nearly pretty fairly quite very highly most certain"),
    (
        0.8,
        "think believe say imagine expect suspect bet seems seem looks feels sounds \
         smells appears memory recall remember checked looked saw heard mistaken positive \
         doubt doubtful unlikely hardly",
    ),
    (
        0.75,
        "probably probability likely likelihood should must ought presumably apparently \
         supposedly inclined leaning chances odds",
    ),
    (
        0.7,
        "guess guessing suppose reckon assume presume gather fancy kind sort kinda sorta \
         more basically mostly know knowledge",
    ),
    (
        0.6,
        "maybe perhaps possibly might may could conceivably perchance potentially \
         feasibly plausibly",
    ),
];
/// Sureness of a phrase without any of these words.
const SURE_LEAST: f64 = 0.55;

/// Returns the confidence that a phrase expresses, 1 for a phrase that is not a hedge.
pub(crate) fn sureness(class: Class, phrase: &str) -> f64 {
    static BY_WORD: LazyLock<HashMap<&str, f64>> = LazyLock::new(|| {
        let rows = SURENESS.iter();
        rows.flat_map(|(sure, words)| words.split_ascii_whitespace().map(|word| (word, *sure)))
            .collect()
    });
    let listed = || {
        let listed = phrase.split(' ').filter_map(|word| BY_WORD.get(word).copied());
        listed.reduce(f64::max)
    };
    match class {
        Class::Hedge | Class::Likely | Class::Unsure | Class::Pondering => {
            listed().unwrap_or(SURE_LEAST)
        }
        // "I think so", "I doubt it", but not "good guess" and "no doubt"
        Class::Yes if phrase.ends_with(" so") => listed().unwrap_or(1.0),
        Class::No
            if ["doubt", "not that i"].iter().any(|part| phrase.contains(part))
                || ["likely", " so"].iter().any(|end| phrase.ends_with(end)) =>
        {
            listed().unwrap_or(1.0)
        }
        _ => 1.0,
    }
}

/// "I don't think", where "think" is not a phrase of its own.
fn sureness_of(tag: &Tag<'_>) -> f64 {
    match tag.sense {
        Sense::Class(Class::Hedge | Class::Likely | Class::Unsure | Class::Pondering) => tag.sure,
        Sense::Class(Class::Plain) if matches!(tag.word, "think" | "believe") => {
            sureness(Class::Hedge, tag.word)
        }
        _ => 1.0,
    }
}

/// Applies each hedge to the content of its clause; one that stands alone, to the words before it
/// in the same sentence, or else to those after it: "the white one, I think".
pub(crate) fn hedge(tags: &mut [Tag<'_>], clauses: &[Clause]) {
    for (n, clause) in clauses.iter().enumerate().filter(|(_, clause)| clause.topic == Topic::On) {
        let said = &tags[clause.span.clone()];
        // "could you possibly bring me": the request is polite, its content is certain.
        let polite = said
            .iter()
            .position(|tag| tag.is(Class::Fetch))
            .filter(|&verb| said[..verb].iter().any(|tag| tag.is(Class::Second)));
        let hedging = &said[polite.unwrap_or(0)..];
        let sure = hedging.iter().map(sureness_of).fold(1.0, f64::min);
        if sure == 1.0 {
            continue;
        }
        let continues = |clause: &Clause| tags[clause.span.start].gap < Gap::Stop;
        let beside = match says_more(&tags[clause.span.clone()]) {
            true => None,
            false => n
                .checked_sub(1)
                .filter(|_| continues(clause))
                .or((n + 1 < clauses.len() && continues(&clauses[n + 1])).then_some(n + 1)),
        };
        let beside = beside.map_or(0..0, |n| clauses[n].span.clone());
        let place = beside.clone().rfind(|at| tags[*at].is_role(Role::Place));
        let beside = match place {
            // "the white one on the counter, I think": it is the place that is not certain.
            Some(at) if at < clause.span.start => at..at + 1,
            _ => beside,
        };
        for at in clause.span.clone().chain(beside) {
            tags[at].sure = tags[at].sure.min(sure);
        }
    }
}

/// Returns whether a clause has content that a hedge in it weakens.
fn says_more(clause: &[Tag<'_>]) -> bool {
    clause
        .iter()
        .any(|tag| tag.is_value() || tag.is_any(classes![Yes No WeakYes WeakNo Not Except Other]))
}

#[cfg(test)]
mod tests {
    use super::{Class, sureness};

    #[test]
    fn hedge_confidences_are_ordered() {
        let order = [
            (Class::Likely, "most likely"),
            (Class::Yes, "i think so"),
            (Class::Likely, "probably"),
            (Class::Yes, "i guess so"),
            (Class::Hedge, "maybe"),
            (Class::Unsure, "no idea"),
        ];
        let sure: Vec<f64> = order.iter().map(|(class, phrase)| sureness(*class, phrase)).collect();
        assert!(sure.windows(2).all(|pair| pair[0] > pair[1]), "{sure:?}");
        assert!(sure.iter().all(|sure| (0.5..1.0).contains(sure)));
    }

    #[test]
    fn hedge_confidence_of_a_plain_answer_is_1() {
        for (class, phrase) in [
            (Class::Yes, "yes"),
            (Class::Yes, "no doubt"),
            (Class::Yes, "good guess"),
            (Class::No, "guess again"),
            (Class::WeakYes, "you could say that"),
        ] {
            assert_eq!(sureness(class, phrase), 1.0, "{phrase}");
        }
    }
}
