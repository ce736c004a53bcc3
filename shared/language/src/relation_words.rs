//! Words for relations by place, order and size: a closed class of the language.

use std::collections::HashMap;
use std::sync::LazyLock;

use scene::{Measure, Relation};

use crate::morphology::comparatives;

/// Words of one meaning: separated by commas.
type Words<T> = &'static [(T, &'static str)];

/// Qualities whose comparatives and superlatives compare objects.
const QUALITIES: Words<Measure> = &[
    (Measure::Big, "big, large, huge"),
    (Measure::Small, "small, little, tiny"),
    (Measure::Long, "long, wide, broad"),
    (Measure::Short, "short"),
    (Measure::Tall, "tall"),
    (Measure::Flat, "flat"),
    (Measure::Thick, "thick"),
    (Measure::Thin, "thin, narrow"),
    (Measure::Heavy, "heavy"),
    (Measure::Light, "light"),
    (Measure::Near, "near, close"),
];
/// Other words for the first of an order.
const FIRSTS: Words<Measure> = &[
    (Measure::Left, "leftmost"),
    (Measure::Right, "rightmost"),
    (Measure::High, "topmost, top, upper"),
    (Measure::Low, "bottom, lower"),
    (Measure::Front, "front, frontmost"),
    (Measure::Far, "farthest, furthest"),
];
/// Relations to the object named after them.
const TO: Words<Relation> = &[
    (Relation::Beside, "next to, beside, near, close to, closest to, nearest to, adjacent to"),
    (Relation::More(Measure::Back), "behind"),
    (Relation::More(Measure::Front), "in front of"),
    (Relation::More(Measure::Left), "left of, to the left of"),
    (Relation::More(Measure::Right), "right of, to the right of"),
    (Relation::More(Measure::High), "above"),
    (Relation::More(Measure::Low), "below, under, underneath, beneath"),
    (Relation::Between, "between"),
];
/// Places in an order.
const ORDINALS: Words<u8> = &[
    (1, "first, 1st, number one"),
    (2, "second, 2nd, number two"),
    (3, "third, 3rd, number three"),
    (4, "fourth, 4th, number four"),
    (5, "fifth, 5th, number five"),
];
/// Sides that a phrase ends in, before [`ASIDE`].
const SIDES: Words<Measure> = &[
    (Measure::Left, "left"),
    (Measure::Right, "right"),
    (Measure::Back, "back, rear"),
    (Measure::Front, "front"),
];
/// Words that say nothing after a side.
const ASIDE: [&str; 3] = ["hand", "side", "one"];
/// Comparatives of no quality.
const FARTHER: [&str; 2] = ["farther", "further"];

fn meaning<T: Copy>(table: Words<T>, phrase: &str) -> Option<T> {
    table.iter().find(|(_, words)| words.split(", ").any(|word| word == phrase)).map(|(it, _)| *it)
}

/// Returns the relation of a comparative or superlative: "the smaller one", "the smallest one".
pub(crate) fn by_quality(word: &str) -> Option<Relation> {
    static COMPARED: LazyLock<HashMap<String, Relation>> = LazyLock::new(|| {
        let far = FARTHER.map(|it| (it.to_owned(), Relation::More(Measure::Far)));
        let of = |(measure, words): &(Measure, &'static str)| {
            let relations = [Relation::More(*measure), Relation::Nth(*measure, 1)];
            let forms = words.split(", ").filter_map(comparatives);
            forms.flat_map(move |forms| forms.into_iter().zip(relations))
        };
        QUALITIES.iter().flat_map(of).chain(far).collect()
    });
    COMPARED.get(word).copied()
}

/// Returns the measure of a word in its plain form: "big".
pub(crate) fn quality(word: &str) -> Option<Measure> {
    meaning(QUALITIES, word)
}

/// Returns the order whose first a word names: "leftmost".
pub(crate) fn first(word: &str) -> Option<Measure> {
    meaning(FIRSTS, word)
}

/// Returns the relation to the object named after a phrase.
pub(crate) fn relation_to(phrase: &str) -> Option<Relation> {
    meaning(TO, phrase)
}

/// Returns the place in an order, from 1.
pub(crate) fn ordinal(phrase: &str) -> Option<u8> {
    meaning(ORDINALS, phrase)
}

/// Returns the side that a phrase ends in: "on the left", "at the back".
pub(crate) fn side(phrase: &str) -> Option<Measure> {
    meaning(SIDES, phrase.rsplit(' ').find(|word| !ASIDE.contains(word))?)
}
