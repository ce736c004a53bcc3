//! Words for relations by place, order and size: a closed class of the language.

use std::collections::HashMap;
use std::sync::LazyLock;

use scene::{Measure, Relation};

use crate::morphology::comparatives;

/// Meanings, each with its words, separated by commas.
pub(crate) struct Words<T: 'static>(&'static [(T, &'static str)]);

impl<T: Copy> Words<T> {
    /// Returns the meaning of a word or phrase.
    pub(crate) fn of(&self, phrase: &str) -> Option<T> {
        let has = |(_, words): &&(T, &str)| words.split(", ").any(|word| word == phrase);
        self.0.iter().find(has).map(|(meaning, _)| *meaning)
    }
}

/// Qualities whose comparatives and superlatives compare objects.
pub(crate) const QUALITIES: Words<Measure> = Words(&[
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
]);
/// Other words for the first of an order.
pub(crate) const FIRSTS: Words<Measure> = Words(&[
    (Measure::Left, "leftmost"),
    (Measure::Right, "rightmost"),
    (Measure::High, "topmost, top, upper"),
    (Measure::Low, "bottom, lower"),
    (Measure::Front, "front, frontmost"),
    (Measure::Far, "farthest, furthest"),
]);
/// Relations to the object named after them.
pub(crate) const TO: Words<Relation> = Words(&[
    (Relation::Beside, "next to, beside, near, close to, closest to, nearest to, adjacent to"),
    (Relation::More(Measure::Back), "behind"),
    (Relation::More(Measure::Front), "in front of"),
    (Relation::More(Measure::Left), "left of, to the left of"),
    (Relation::More(Measure::Right), "right of, to the right of"),
    (Relation::More(Measure::High), "above"),
    (Relation::More(Measure::Low), "below, under, underneath, beneath"),
    (Relation::Between, "between"),
]);
/// Places in an order.
pub(crate) const ORDINALS: Words<u8> = Words(&[
    (1, "first, 1st, number one"),
    (2, "second, 2nd, number two"),
    (3, "third, 3rd, number three"),
    (4, "fourth, 4th, number four"),
    (5, "fifth, 5th, number five"),
]);
/// Sides that a phrase ends in, before [`ASIDE`].
const SIDES: Words<Measure> = Words(&[
    (Measure::Left, "left"),
    (Measure::Right, "right"),
    (Measure::Back, "back, rear"),
    (Measure::Front, "front"),
]);
/// Places of an object by one word.
pub(crate) const OF_OBJECT: Words<Relation> = Words(&[
    (Relation::Nth(Measure::Left, 1), "left"),
    (Relation::Middle(Measure::Left), "middle, center, centre"),
]);
/// The robot and the user, to whom an object is near.
pub(crate) const PERSONS: Words<Measure> =
    Words(&[(Measure::Near, "you"), (Measure::NearUser, "me, us")]);
/// Words that say nothing after a side.
const ASIDE: [&str; 3] = ["hand", "side", "one"];
/// Comparatives of no quality.
const FARTHER: [&str; 2] = ["farther", "further"];

/// Returns the relation of a comparative or superlative: "the smaller one", "the smallest one".
pub(crate) fn by_quality(word: &str) -> Option<Relation> {
    static COMPARED: LazyLock<HashMap<String, Relation>> = LazyLock::new(|| {
        let far = FARTHER.map(|it| (it.to_owned(), Relation::More(Measure::Far)));
        let of = |(measure, words): &(Measure, &'static str)| {
            let relations = [Relation::More(*measure), Relation::Nth(*measure, 1)];
            let forms = words.split(", ").filter_map(comparatives);
            forms.flat_map(move |forms| forms.into_iter().zip(relations))
        };
        QUALITIES.0.iter().flat_map(of).chain(far).collect()
    });
    COMPARED.get(word).copied()
}

/// Returns the side that a phrase ends in: "on the left", "at the back".
pub(crate) fn side(phrase: &str) -> Option<Measure> {
    SIDES.of(phrase.rsplit(' ').find(|word| !ASIDE.contains(word))?)
}
