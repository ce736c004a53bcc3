//! Words for relations by place, order and size: a closed class of the language.

use std::collections::HashMap;
use std::sync::LazyLock;

use scene::{Measure, Relation};

use crate::morphology::comparatives;

/// Qualities whose comparatives and superlatives compare objects.
const QUALITIES: &[(&str, Measure)] = &[
    ("big", Measure::Big),
    ("large", Measure::Big),
    ("huge", Measure::Big),
    ("small", Measure::Small),
    ("little", Measure::Small),
    ("tiny", Measure::Small),
    ("long", Measure::Long),
    ("wide", Measure::Long),
    ("broad", Measure::Long),
    ("short", Measure::Short),
    ("tall", Measure::Tall),
    ("flat", Measure::Flat),
    ("thick", Measure::Thick),
    ("thin", Measure::Thin),
    ("narrow", Measure::Thin),
    ("heavy", Measure::Heavy),
    ("light", Measure::Light),
    ("near", Measure::Near),
    ("close", Measure::Near),
];
/// Other words for the first of an order.
const FIRSTS: &[(&str, Measure)] = &[
    ("leftmost", Measure::Left),
    ("rightmost", Measure::Right),
    ("topmost", Measure::High),
    ("top", Measure::High),
    ("upper", Measure::High),
    ("bottom", Measure::Low),
    ("lower", Measure::Low),
    ("front", Measure::Front),
    ("frontmost", Measure::Front),
    ("farthest", Measure::Far),
    ("furthest", Measure::Far),
];
/// Relations to the object named after them.
const TO: &[(&str, Relation)] = &[
    ("next to", Relation::Beside),
    ("beside", Relation::Beside),
    ("near", Relation::Beside),
    ("close to", Relation::Beside),
    ("closest to", Relation::Beside),
    ("nearest to", Relation::Beside),
    ("adjacent to", Relation::Beside),
    ("behind", Relation::More(Measure::Back)),
    ("in front of", Relation::More(Measure::Front)),
    ("left of", Relation::More(Measure::Left)),
    ("to the left of", Relation::More(Measure::Left)),
    ("right of", Relation::More(Measure::Right)),
    ("to the right of", Relation::More(Measure::Right)),
    ("above", Relation::More(Measure::High)),
    ("below", Relation::More(Measure::Low)),
    ("under", Relation::More(Measure::Low)),
    ("underneath", Relation::More(Measure::Low)),
    ("beneath", Relation::More(Measure::Low)),
    ("between", Relation::Between),
];
/// Places in an order.
const ORDINALS: [&[&str]; 5] = [
    &["first", "1st", "number one"],
    &["second", "2nd", "number two"],
    &["third", "3rd", "number three"],
    &["fourth", "4th", "number four"],
    &["fifth", "5th", "number five"],
];

/// Returns the relation of a comparative or superlative: "the smaller one", "the smallest one".
pub(crate) fn by_quality(word: &str) -> Option<Relation> {
    static COMPARED: LazyLock<HashMap<String, Relation>> = LazyLock::new(|| {
        let far = ["farther", "further"].map(|it| (it.to_owned(), Relation::More(Measure::Far)));
        let of = |(quality, measure): &(&str, Measure)| {
            let relations = [Relation::More(*measure), Relation::Nth(*measure, 1)];
            comparatives(quality)
                .into_iter()
                .flat_map(move |words| words.into_iter().zip(relations))
        };
        QUALITIES.iter().flat_map(of).chain(far).collect()
    });
    COMPARED.get(word).copied()
}

/// Returns the measure of a word in its plain form: "big".
pub(crate) fn quality(word: &str) -> Option<Measure> {
    QUALITIES.iter().find(|(quality, _)| *quality == word).map(|(_, measure)| *measure)
}

/// Returns the order whose first a word names: "leftmost".
pub(crate) fn first(word: &str) -> Option<Measure> {
    FIRSTS.iter().find(|(first, _)| *first == word).map(|(_, measure)| *measure)
}

/// Returns the relation to the object named after a phrase.
pub(crate) fn relation_to(phrase: &str) -> Option<Relation> {
    TO.iter().find(|(known, _)| *known == phrase).map(|(_, relation)| *relation)
}

/// Returns the place in an order, from 1.
pub(crate) fn ordinal(phrase: &str) -> Option<u8> {
    (1..).zip(ORDINALS).find(|(_, names)| names.contains(&phrase)).map(|(n, _)| n)
}

/// Returns the side that a phrase ends in: "on the left", "at the back".
pub(crate) fn side(phrase: &str) -> Option<Measure> {
    let last = phrase.rsplit(' ').find(|word| !matches!(*word, "hand" | "side" | "one"))?;
    match last {
        "left" => Some(Measure::Left),
        "right" => Some(Measure::Right),
        "back" | "rear" => Some(Measure::Back),
        "front" => Some(Measure::Front),
        _ => None,
    }
}
